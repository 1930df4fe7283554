# SPDX-License-Identifier: BSD-3-Clause
"""Warnings, refusals and exit codes that tell a user what is wrong with a result: true where they are given, absent where
nothing is wrong."""
import json
import unittest

import numpy as np
from test_bad_scenes import GOOD
from vsb_program import SCENES, ProgramTest, last_fields, vsb

# A beam of 4 m under its own weight, fixed at its left end; {low} and {high}: its faces, m, {E}: its modulus.
BEAM = """
dimension = 2
gravity = [0.0, -10.0]
grid = {{ lower = [0.0, 0.0], upper = [{right}, 3.0], spacing = 0.25 }}
faces = {{ x_min = "fixed"{faces} }}
method = {{ damping = 0.1 }}
time = {{ kappa = 0.5, until_static = {{}} }}
[[body]]
shape = {{ box = {{ lower = [0.0, {low}], upper = [4.0, {high}] }} }}
particles_per_cell = 2
density = 2000.0
material = {{ youngs_modulus = {E}, poisson_ratio = 0.0 }}
"""


def beam(low, high, E=1e9, held=False):
    return BEAM.format(low=low, high=high, E=E, right=4.0 if held else 5.0, faces=', x_max = "fixed"' if held else "")


# A column of 9.6 m under a pressure at its end and 150 times its own weight over its height, which takes the end out of the region
# of the pressure.
COLUMN = """
dimension = 1
gravity = [-150.0]
grid = { lower = [0.0], upper = [12.0], spacing = 0.5 }
faces = { x_min = "fixed" }
method = { damping = 0.1 }
time = { kappa = 0.5, until_static = {} }
[[body]]
shape = { box = { lower = [0.0], upper = [9.6] } }
lattice.uniform = { spacing = 0.1 }
density = 1.0
material = { youngs_modulus = 1e4, poisson_ratio = 0.0 }
[[traction]]
pressure = 10.0
surface = { box = { lower = [9.2], upper = [12.0] } }
"""

# A column in the stress of its weight.
GEOSTATIC = """
dimension = 2
gravity = [0.0, -10.0]
grid = { lower = [0.0, 0.0], upper = [2.0, 5.0], spacing = 0.5 }
faces = { x_min = "roller", x_max = "roller", y_min = "fixed" }
method = { damping = 0.1 }
time = { kappa = 0.5, until_static = {} }
[[body]]
shape = { box = { lower = [0.0, 0.0], upper = [2.0, 4.0] } }
particles_per_cell = 2
density = 2000.0
material = { youngs_modulus = 1e7, poisson_ratio = 0.0 }
stress = { value = [0.0, -8e4, 0.0, 0.0, 0.0, 0.0], dy = [0.0, 2e4, 0.0, 0.0, 0.0, 0.0] }
"""


class Static(ProgramTest):
    def static(self, text, *arguments, code=0):
        done = vsb("run", self.write(text), "--static", "--quiet", "--out", self.folder / "scene", *arguments)
        self.assertEqual(done.returncode, code, done.stderr)
        return done.stderr

    def test_slender_bodies_that_bend_are_no_matter_of_loose_particles(self):
        # Displaced by up to half a cell, at strains of 1e-3 and rotations of 0.01 to 0.04.
        for low, high in ((1.25, 1.75), (1.25, 1.5)):
            for setting in ("paper", "accurate"):
                more = ("--set", "body[0].particles_per_cell=3") if setting == "accurate" else ()
                self.assertEqual(self.static(beam(low, high), "--set", f'setting="{setting}"', *more), "")
        # q L^4 / (8 E I), within what cells across the depth make of it.
        self.static(beam(1.25, 1.75), "--set", 'setting="accurate"')
        deflection = -last_fields(self.folder / "scene")["displacement"][:, 1].min()
        self.assertAlmostEqual(deflection / (2000 * 10 * 0.5 * 4**4 / (8 * 1e9 * 0.5**3 / 12)), 1, delta=0.1)

    def test_particles_that_no_strain_moves_are_told_of_at_any_load(self):
        for pressure in ("1e5", "1e2"):
            done = vsb("run", SCENES / "cylinder-voids.toml", "--static", "--quiet", "--out", self.folder / "voids",
                       "--set", f"traction[0].pressure={pressure}")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("against those around it, which no strain explains", done.stderr)
        for scene in ("cylinder", "cylinder-accurate", "cylinder-polar", "column-graded"):
            done = vsb("run", SCENES / f"{scene}.toml", "--static", "--quiet", "--out", self.folder / scene)
            self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_what_linear_theory_leaves_out(self):
        self.assertRegex(self.static(beam(1.25, 1.5, E=1e8)), r"rotations up to 0\.3\d rad.* 1\d %; an explicit run")
        # Held at both ends, a beam is stretched as it bends: here --static finds it a seventh too soft.
        held = "is held at both ends along x: the stretch that comes with it"
        fine = ("--set", "grid.spacing=0.125", "--set", 'method.basis="quadratic_bspline"')
        self.assertIn(held, self.static(beam(1.25, 1.5, E=2e7, held=True), *fine))
        self.assertNotIn(held, self.static(beam(1.25, 1.5, E=1e9, held=True), *fine))
        self.assertNotIn(held, self.static(beam(1.25, 1.5, E=2e8), *fine))

    def test_a_body_one_cell_thick_bends_without_strain_under_b_splines(self):
        thin, accurate = beam(1.25, 1.5), ("--set", 'setting="accurate"')
        told = "body 'body 1' is one cell thick along y, with 2 rows of particles"
        stderr = self.static(thin, *accurate, code=7)
        self.assertIn(told, stderr)
        self.assertRegex(stderr, r"no static state: some motion strains no particle.* grown to \S+ by iteration \d{1,4}\)")
        self.assertNotIn("max_iterations", stderr)
        self.assertIn(told, vsb("check", self.write(thin), *accurate).stderr)
        # Three rows, two cells, the middle on a line of the grid, linear functions: none of them does.
        for text, more in ((thin, ("--set", "body[0].particles_per_cell=3")), (beam(1.25, 1.75), ()), (beam(1.125, 1.375), ()),
                           (thin, ("--set", 'method.basis="linear"'))):
            self.assertEqual(self.static(text, *accurate, *more), "")

    def test_without_a_load_of_the_scene(self):
        beside = ("--set", "traction[0].surface.box={lower=[11.0],upper=[12.0]}")
        self.assertIn("finds no boundary node", self.static(COLUMN, *beside, code=2))


class Rest(ProgramTest):
    def test_a_rest_that_has_lost_its_load_is_not_static(self):
        scene, out = self.write(COLUMN), self.folder / "out"
        done = vsb("run", scene, "--quiet", "--out", out)
        self.assertEqual(done.returncode, 7, done.stderr)
        self.assertIn("at rest without its load: nothing acts of traction 'traction 1'", done.stderr)
        self.assertTrue(json.loads((out / "summary.json").read_text())["static"])
        # Where the surface moves with the material, the load is there, and so it is where it ends at 0.
        for change in ('traction[0].configuration="initial"', "traction[0].time.table=[[0.0, 1.0], [0.5, 0.0]]"):
            done = vsb("run", scene, "--quiet", "--out", out, "--set", change)
            self.assertEqual(done.returncode, 0, done.stderr)

    def test_cutting_is_offered_where_it_cuts(self):
        for low, offered in ((1.25, False), (1.27, True)):
            done = vsb("run", self.write(beam(low, 1.75)), "--quiet", "--out", self.folder / "out", "--set",
                       'method.basis="quadratic_bspline"', "--set", "time.until_static.max_steps=20000")
            self.assertEqual(done.returncode, 7, done.stderr)
            self.assertIn("the force ratio stands at", done.stderr)
            self.assertEqual('body.boundary = "cut"' in done.stderr, offered, done.stderr)


class Check(ProgramTest):
    def test_trial_steps_that_end(self):
        flying = GOOD.replace("steps = 10\n", "steps = 10000\n").replace("density", "velocity = [2000.0, 0.0]\ndensity")
        for scene, words, end in (
                (flying, "left the grid at the open face x_max", "the run ends there, with exit code 8"),
                ('faces = { x_max = "outflow" }\n' + flying, "the last particles left the grid", "without a particle")):
            done = vsb("check", self.write(scene))
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn(words, done.stderr)
            self.assertIn(end, done.stderr)
            self.assertIn("# the run ends early: at step", done.stdout)
            self.assertIn("density = 1000.0", done.stdout)  # the resolved scene

    def test_a_stress_that_varies_is_at_rest_under_b_splines_with_three_particles_per_cell(self):
        # The stress of its weight in a column of 4 m, which the sums over 2 particles per cell do not keep at its ends.
        weight, h = 2000 * 10.0, 0.5
        scene = self.write(GEOSTATIC)
        for basis, n, told, settles in (("linear", 2, False, 0), ("quadratic_bspline", 2, True, 1 / 8),
                                        ("quadratic_bspline", 3, False, 0), ("quadratic_bspline", 4, True, 1 / 25)):
            set_ = ("--set", f'method.basis="{basis}"', "--set", f"body[0].particles_per_cell={n}")
            done = vsb("run", scene, "--static", "--quiet", "--out", self.folder / "out", *set_)
            self.assertEqual(done.returncode, 0, done.stderr)
            fields = last_fields(self.folder / "out")
            exact = -weight * (4 - (fields["position"] - fields["displacement"])[:, 1])
            off = np.abs(fields["cauchy_stress"][:, 1] - exact).max() / (weight * h)
            self.assertAlmostEqual(off, settles, delta=1e-3, msg=(basis, n))
            self.assertEqual("it is not quite at rest, and settles by up to" in vsb("check", scene, *set_).stderr, told)
        # Steps find the same rest.
        done = vsb("run", scene, "--quiet", "--out", self.folder / "steps", "--set", 'method.basis="quadratic_bspline"', "--set",
                   "body[0].particles_per_cell=3")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertLess(np.abs(last_fields(self.folder / "steps")["displacement"]).max(), 1e-12)

    def test_what_keeps_a_scene_from_the_accurate_setting(self):
        graded = GOOD.replace("lower = [0.0, 0.0], upper = [4.0, 4.0], spacing = 0.5",
                              "x = [0.0, 1.0, 2.0, 3.0, 4.0], y = [0.0, 1.0, 2.0, 3.0, 4.0]")
        imposed = lambda how: GOOD.replace("pressure = 1e3", f'pressure = 1e3\nimposition = "{how}"')
        for text, why in ((graded, "grid.x"), ('precision = "float"\n' + GOOD, 'the scene has "float"'),
                          (imposed("nodal"), 'traction[0].imposition = "nodal"'),
                          (imposed("virtual_stress_original"), 'traction[0].imposition = "virtual_stress_original"')):
            accurate = self.write('setting = "accurate"\n' + text)
            done = vsb("check", accurate)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(':1:', done.stderr)
            for word in ('stands for method.basis = "quadratic_bspline"', why,
                         'give method.basis = "linear" beside the setting'):
                self.assertIn(word, done.stderr)
            self.assertEqual(vsb("check", accurate, "--set", 'method.basis="linear"').returncode, 0)
        for more in ('[output]\nfields = ["recovered_stress"]\n', "[method]\nmoment_fit = true\n"):
            done = vsb("check", self.write('setting = "accurate"\n' + GOOD + more))
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn('unless method.basis = "linear" is given beside it', done.stderr)


if __name__ == "__main__":
    unittest.main()
