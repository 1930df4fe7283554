# SPDX-License-Identifier: BSD-3-Clause
"""Tractions that particles carry: at large strain by each basis, and where particles are removed; warnings of lost loads."""
import json
import re
import unittest

import numpy as np
from test_tractions import COLUMN, INITIAL, engine
from vsb_program import SCENES, ProgramTest, last_fields, vsb

PRESSURE, LENGTH, MODULUS, CELL = 300.0, 9.6, 1e3, 0.5
END = LENGTH * np.exp(-PRESSURE / MODULUS)

# The column at nearly the same strains without a traction, by its weight. Exact: the stress of the material at X is
# -rho g (L - X), its stretch the exponential of that over E.
WEIGHT = 62.5
HEAVY = COLUMN[:COLUMN.index("[[traction]]")].replace("dimension = 1", f"dimension = 1\ngravity = [{-WEIGHT}]") + """
[method]
damping = 0.4
volume_update = "exponential"
[time]
kappa = 0.2
until_static = { max_steps = 20000 }
"""


class LargeStrain(ProgramTest):
    def column(self, *more):
        """Position of the end, stresses, and fields of the column at rest; its summary."""
        summary = self.run_scene(self.write(COLUMN), "--set", "time.until_static.max_steps=20000", *more, out="column")
        self.assertTrue(summary["static"])
        fields = last_fields(self.folder / "column")
        x = fields["position"][:, 0]
        return x.max() + fields["volume"][x.argmax()] / 2, fields["cauchy_stress"][:, 0], fields, summary

    def test_smooth_bases_carry_it_anywhere(self):
        for basis in ("quadratic_bspline", "ugimp"):
            end, stress, _, summary = self.column("--set", f'method.basis="{basis}"', *INITIAL)
            self.assertAlmostEqual(end / END, 1, delta=2e-3)
            np.testing.assert_allclose(stress, -PRESSURE, rtol=0.03)
            self.assertAlmostEqual(summary["net_force"][0] / -PRESSURE, 1, delta=0.005)

    def test_at_all_nodes_linear_functions_are_right_as_well(self):
        end, stress, _, summary = self.column("--set", 'traction[0].nodes="all"', "--set", "traction[0].surface=")
        self.assertAlmostEqual(end / END, 1, delta=1e-3)
        np.testing.assert_allclose(stress, -PRESSURE, rtol=0.015)
        self.assertAlmostEqual(summary["net_force"][0] / -PRESSURE, 1, delta=1e-3)

    def test_at_the_boundary_nodes_linear_functions_give_the_mean(self):
        """chi falls from 1 to 0 across the last cell but one. The force is the sum of V sbar . grad chi there: the
        pressure times how far the particles in that cell fill it, which changes with each one that crosses a node. All
        cells below pass that force on. In compression the paper's step damps, and comes to rest; with one velocity
        particles go to and fro over a node of the end."""
        _, stress, fields, summary = self.column(*INITIAL, "--set", "method.damping=0.4",
                                                 "--set", "method.position_velocity=grid")
        cell = np.floor(fields["position"][:, 0] / CELL).astype(int)
        force = np.bincount(cell, weights=fields["volume"] * stress) / CELL
        filled = np.bincount(cell, weights=fields["volume"]) / CELL
        last = cell.max()
        self.assertAlmostEqual(summary["net_force"][0] / (-PRESSURE * filled[last - 1]), 1, delta=1e-9)
        np.testing.assert_allclose(force[1:last], summary["net_force"][0], rtol=1e-4)
        np.testing.assert_allclose(force[last - 1:] / filled[last - 1:], -PRESSURE, rtol=1e-4)
        self.assertAlmostEqual((stress * fields["volume"]).sum() / fields["volume"].sum() / -PRESSURE, 1, delta=0.05)

    def test_what_is_left_is_the_bases_own(self):
        """Without a virtual stress linear functions err as much, once particles have crossed cells."""
        error, end = {}, {}
        for basis in ("linear", "quadratic_bspline"):
            self.run_scene(self.write(HEAVY), "--set", f'method.basis="{basis}"', out=basis)
            fields = last_fields(self.folder / basis)
            x = fields["position"][:, 0]
            start = x - fields["displacement"][:, 0]
            exact = -WEIGHT * (LENGTH - start)
            error[basis] = np.sqrt(np.mean((fields["cauchy_stress"][:, 0] - exact) ** 2)) / (WEIGHT * LENGTH)
            end[basis] = x.max() + fields["volume"][x.argmax()] / 2
        exact_end = MODULUS / WEIGHT * (1 - np.exp(-WEIGHT * LENGTH / MODULUS))
        self.assertLess(error["quadratic_bspline"], 0.01)
        self.assertGreater(error["linear"], 0.05)
        self.assertAlmostEqual(end["quadratic_bspline"] / exact_end, 1, delta=2e-3)
        self.assertGreater(abs(end["linear"] / exact_end - 1), 0.01)


class Removal(ProgramTest):
    """The slice of the wellbore, in which the hole's surface goes with the particles that fail at it."""
    SLICE = SCENES / "wellbore-slice.toml"

    def run_slice(self, *more, out):
        done = vsb("run", self.SLICE, "--out", self.folder / out, "--set", "removal.max_stages=2", *more)
        self.assertEqual(done.returncode, 0, done.stderr)
        stages = [(int(a), int(b)) for a, b in re.findall(r"stage \d: (\d+) of (\d+) particles", done.stdout)]
        return stages, done

    def test_those_behind_carry_it_on(self):
        """What is left of 'surface' is loaded at the new hole, as a surface that is fixed in space is there."""
        left = {}
        for precision in ("double", "float"):
            for name, more in (("fixed", ()), ("lanes", INITIAL), ("particles", (*INITIAL, *engine("particles"))),
                               ("on", (*INITIAL, "--set", "removal.next=continue"))):
                if (precision, name) in (("float", "particles"), ("float", "on")):
                    continue
                stages, done = self.run_slice("--set", f"precision={precision}", *more, out=f"{precision}-{name}")
                self.assertNotIn("warning: at step", done.stderr)
                self.assertEqual((stages[0], stages[1][1]), ((34, 1974), 1940))
                left[precision, name] = stages
                if name != "fixed":
                    self.assertGreater(stages[1][0], 50)
        self.assertEqual(left["double", "lanes"], left["double", "fixed"])
        self.assertEqual(left["double", "particles"], left["double", "fixed"])
        self.assertEqual(left["float", "lanes"], left["float", "fixed"])
        ends = [last_fields(self.folder / f"double-{name}")["position"] for name in ("fixed", "lanes")]
        np.testing.assert_allclose(*ends, rtol=0, atol=1e-12)

    def test_a_load_whose_carriers_are_removed_is_told(self):
        for name, more in (("carried", INITIAL), ("fixed", ())):
            _, done = self.run_slice(*more, "--set", "traction[0].surface.disc.radius=0.015", out=name)
            told = re.findall(r"warning: at step \d+, .*traction 'pressure in the hole' has lost (\d+) % of its resultant", done.stderr)
            self.assertEqual(len(told), 1, done.stderr)
            self.assertGreater(int(told[0]), 50)
            self.assertIn("let its 'surface' reach as far into the body as particles may be removed", done.stderr)
            self.assertIn("lost load: at step", done.stdout)


class RightRuns(ProgramTest):
    def test_scenes_of_the_paper_lose_no_load(self):
        for scene, *more in (("ring",), ("ring-nodes",), ("cylinder-carried",), ("cylinder-accurate",), ("closed-body",),
                             ("column-large-strain", "--set", "time.steps=15000"),
                             ("ellipse", "--set", "time.until_static.max_steps=1000")):
            done = vsb("run", SCENES / f"{scene}.toml", "--out", self.folder / scene, *more)
            self.assertIn(done.returncode, (0, 7), done.stderr)
            self.assertNotIn("warning: at step", done.stderr, scene)
            self.assertNotIn("lost load", done.stdout, scene)


# A bar that is pulled with a tenth of its modulus: with linear functions it tears, and its end flies off with the load.
PULLED = """
dimension = 1
grid = { lower = [0.0], upper = [16.0], spacing = 0.25 }
faces = { x_min = "fixed" }
[[body]]
particles_per_cell = 2
density = 2000.0
material = { youngs_modulus = 1e7, poisson_ratio = 0.0, law = "hencky" }
shape.box = { lower = [0.0], upper = [10.0] }
[[traction]]
pressure = -1e6
surface = { box = { lower = [9.5], upper = [10.5] } }
configuration = "initial"
time = { ramp = 1.0 }
[method]
damping = 0.2
[time]
kappa = 0.5
until_static = { max_steps = 30000 }
"""


class MissedSurface(ProgramTest):
    def test_a_region_inside_the_hole_is_told(self):
        """The boundary nodes of B-splines reach farther than the surface, and where they have no weight load nothing."""
        done = vsb("check", SCENES / "cylinder-accurate.toml", "--set", "grid.spacing=0.125",
                   "--set", "traction[0].surface={disc={center=[0.0,0.0],radius=0.7}}")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("loads nothing", done.stderr)


class TornBody(ProgramTest):
    def test_a_load_that_tore_off_is_told(self):
        done = vsb("run", self.write(PULLED), "--quiet", "--out", self.folder / "pulled")
        self.assertEqual(done.returncode, 7, done.stdout + done.stderr)
        self.assertRegex(done.stderr, r"traction 'traction 1' has lost \d+ % of its resultant.*quadratic_bspline")
        summary = json.loads((self.folder / "pulled" / "summary.json").read_text())
        self.assertLess(abs(summary["net_force"][0]), 0.5e6)


if __name__ == "__main__":
    unittest.main()
