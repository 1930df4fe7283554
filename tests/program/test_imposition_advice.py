# SPDX-License-Identifier: BSD-3-Clause
"""What check and run say of impositions whose surface is not that of the body, and that it is true."""
import re
import unittest

import numpy as np
from vsb_program import SCENES, ProgramTest, last_fields, vsb

LOAD = -1e5  # Pa
BAR = """\
dimension = {dimension}
grid = {{ lower = {lower}, upper = {upper}, spacing = 1.0 }}
faces = {{ {faces} }}
static = {{ residual = 1e-10 }}
time = {{ kappa = 0.5, until_static = {{}} }}
[[body]]
shape = {{ box = {{ lower = {lower}, upper = {top} }} }}
particles_per_cell = {particles}
density = 1000.0
material = {{ youngs_modulus = 1e9, poisson_ratio = 0.0 }}
[[traction]]
imposition = "{by}"
stress = [{load}, 0.0, 0.0, 0.0, 0.0, 0.0]
surface = {{ half_space = {{ point = {point}, normal = {normal} }} }}
"""


class ImpositionAdvice(ProgramTest):
    def bar(self, by, length, particles=2, dimension=1):
        """A bar along x between rollers, pressed at its end."""
        vector = lambda x, others: "[" + ", ".join([str(x)] + [str(others)] * (dimension - 1)) + "]"
        faces = ['x_min = "roller"'] + [f'{axis}_{side} = "roller"' for axis in "yz"[:dimension - 1] for side in ("min", "max")]
        return self.write(BAR.format(dimension=dimension, lower=vector(0.0, 0.0), upper=vector(8.0, 2.0), top=vector(length, 2.0),
                                     faces=", ".join(faces), particles=particles, by=by, load=LOAD, point=vector(4.0, 0.0),
                                     normal=vector(-1.0, 0.0)))

    def told(self, path, *arguments):
        done = vsb("check", path, "--threads", 1, *arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        return "\n".join(line for line in done.stderr.splitlines() if "has imposition" in line)

    def last_stress(self, path):
        """Of the last cells, as a multiple of the load."""
        self.run_scene(path, "--static", "--threads", 1, out="bar")
        fields = last_fields(self.folder / "bar")
        cell = np.floor(fields["position"][:, 0])
        return fields["cauchy_stress"][cell == cell.max(), 0].mean() / LOAD

    def test_nodal_loads_between_lines_of_the_grid(self):
        for dimension in (1, 2, 3):
            for length, particles, gap in ((6.5, 2, 0.5), (6.25, 4, 0.75), (6.75, 4, 0.25)):
                path = self.bar("nodal", length, particles, dimension)
                text = self.told(path)
                self.assertIn(f"lies up to {gap:g} of a cell within them", text)
                times = float(re.search(r"about ([\d.]+) times as large as the load", text)[1])
                self.assertAlmostEqual(self.last_stress(path), times, delta=0.05 * times)
            path = self.bar("nodal", 6.0, dimension=dimension)
            self.assertEqual(self.told(path), "")
            self.assertAlmostEqual(self.last_stress(path), 1, delta=1e-6)

    def test_material_points_below_the_surface(self):
        for dimension in (1, 2, 3):
            for length, particles, depth in ((6.0, 2, 0.25), (6.5, 2, 0.25), (6.5, 4, 0.125), (6.0, 4, 0.125)):
                path = self.bar("material_points", length, particles, dimension)
                text = self.told(path)
                self.assertIn(f"they lie {depth:.2g} of a cell below it", text)
                less = float(re.search(r"about ([\d.]+) % smaller", text)[1])
                self.assertAlmostEqual(self.last_stress(path), 1 - less / 100, delta=0.01, msg=f"{length} {particles} {dimension}")
        self.assertEqual(self.told(self.bar("material_points", 6.0, 16)), "")

    def test_run_tells_it_too(self):
        for by in ("nodal", "material_points"):
            done = vsb("run", self.bar(by, 6.5), "--threads", 1, "--out", self.folder / "out", "--set", "time={ kappa = 0.5, steps = 2 }")
            self.assertIn(f'vsb: warning: traction \'traction 1\' has imposition = "{by}"', done.stderr)

    def test_other_impositions_and_exact_ones_are_silent(self):
        for by in ("virtual_stress", "virtual_stress_original", "boundary_particles"):
            self.assertEqual(self.told(self.bar(by, 6.5)), "")
        for scene in sorted(SCENES.glob("*.toml")):
            if "wellbore" in scene.stem or scene.stem == "column-large-strain":
                continue
            self.assertEqual(self.told(scene), "", scene.stem)

    def test_a_polar_grid_follows_the_arcs(self):
        polar = lambda inner: ("--set", 'traction[0].imposition="nodal"', "--set", f"body[0].shape.difference[1].disc.radius={inner}")
        self.assertEqual(self.told(SCENES / "cylinder-polar.toml", *polar(1.0)), "")


if __name__ == "__main__":
    unittest.main()
