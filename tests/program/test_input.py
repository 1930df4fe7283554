# SPDX-License-Identifier: BSD-3-Clause
"""Input that is odd but right, and input that is wrong in a way that only shows when it is worked out: sizes, magnitudes, tables
without a key; and the words on the screen about both."""
import json
import re
import resource
import subprocess
import time
import unittest

import numpy as np
from test_bad_scenes import GOOD
from vsb_program import PROGRAM, SCENES, ProgramTest, last_fields, vsb


# A bar of 8 m on a roller, pressed by a twentieth of its modulus: its end moves 0.8 of a cell.
BAR = """
dimension = 1
grid = { lower = [0.0], upper = [10.0], spacing = 0.5 }
faces = { x_min = "roller" }
method = { damping = 0.05 }
time = { kappa = 0.5, until_static = { force_ratio = 1e-4 } }
[[body]]
shape = { box = { lower = [0.0], upper = [8.0] } }
particles_per_cell = 2
density = 1000.0
material = { youngs_modulus = 1e6, poisson_ratio = 0.0 }
[[traction]]
pressure = 5e4
nodes = "all"
time = { ramp = 1.0 }
"""


class Input(ProgramTest):
    def changed(self, old, new, text=GOOD):
        self.assertEqual(text.count(old), 1, old)
        return text.replace(old, new)

    def refuse(self, text, *words, name="scene.toml", extra=(), limit=None):
        """Refused within seconds, with exit code 2 and all the words; `limit`: bytes of address space."""
        begun = time.monotonic()
        set_limit = (lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit))) if limit else None
        done = subprocess.run([PROGRAM, "check", str(self.write(text, name)), *extra], capture_output=True, text=True, timeout=60,
                              preexec_fn=set_limit)
        self.assertLess(time.monotonic() - begun, 30)  # a hang guard, not a timing
        self.assertEqual(done.returncode, 2, f"{done.stderr}{done.stdout[:500]}\n{text}")
        for word in words:
            self.assertIn(word, done.stderr)
        return done.stderr

    def check(self, text, *arguments, name="scene.toml"):
        done = vsb("check", self.write(text, name), *arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done

    def test_a_file_with_a_blank_in_its_name(self):
        for file, name in (("my scene.toml", "my-scene"), (".toml", "toml"), ("a b\tc.toml", "a-b-c")):
            self.run_scene(self.write(GOOD, file), out="blank")
            self.assertTrue((self.folder / "blank" / f"{name}_000010.hdf").is_file(), name)
        # A name that the scene gives is not changed in secret.
        self.refuse('name = "my scene"\n' + GOOD, 'scene.toml:1:', 'name = "my scene"'.replace('"', "'"), "no space")

    def test_comparisons_with_numbers_beyond_computing(self):
        for solution, key, value, words in (
                ("cylinder", "pressure", "1e308", "compare = {...}: the square of the pressure is inf"),
                ("cylinder", "pressure", "1e-200", "compare = {...}: the square of the pressure is 0"),
                ("cylinder", "outer_radius", "1e200", "the square of the outer radius is inf"),
                ("cylinder", "moved", "[1e200, 0.0]", "the square of a coordinate is inf"),
                ("column", "traction", "-1e-170", "the square of the traction is 0"),
                ("column", "length", "1e170", "the square of the length is inf"),
                ("ellipse", "far_stress", "1e300", "the square of the far stress is inf"),
                ("ellipse", "far_ratio", "1e300", "the square of the far stress is inf")):
            done = vsb("check", SCENES / f"{solution}.toml", "--set", f"compare.{key}={value}")
            self.assertEqual(done.returncode, 2, key + done.stderr)
            self.assertIn(words.replace("compare = {...}: ", ""), done.stderr)
            self.assertRegex(done.stderr, r"\S+\.toml:\d+:\d+: compare")

    def test_a_figure_that_is_not_finite_is_named_and_left_out(self):
        # Its von Mises stress takes a square of 1e190 Pa.
        text = self.changed("density", "stress = [1e190, 0.0, 0.0, 0.0, 0.0, 0.0]\ndensity")
        text = re.sub(r"youngs_modulus = [^,]*", "youngs_modulus = 1e200", text)
        done = vsb("run", self.write(text), "--out", self.folder / "o", "--set", "time={kappa=0.1,steps=1}")
        self.assertEqual(done.returncode, 0, done.stderr)
        summary = (self.folder / "o" / "summary.json").read_text()
        found = json.loads(summary)
        self.assertIn("largest_von_mises", found["not_finite"])
        for name in found["not_finite"]:
            self.assertNotIn(name, found)
        self.assertIn("vsb: warning: not finite, and left out of summary.json: " + ", ".join(found["not_finite"]), done.stderr)
        self.assertNotRegex(summary.replace("not_finite", ""), r"(?i)\b(-?inf|infinity|nan)\b")
        self.assertNotIn("not_finite", self.run_scene(self.write(GOOD), out="good"))

    def test_an_empty_directory_is_refused(self):
        for arguments in (("run", SCENES / "column.toml"), ("study", "column")):
            for out in (("--out", ""), ("--out=",)):
                done = vsb(*arguments, *out)
                self.assertEqual(done.returncode, 2, done.stderr)
                self.assertRegex(done.stderr, r"--out: (is empty|1 required TEXT missing)")

    def test_tables_without_a_key(self):
        for old, new, words in (("density", "velocity = {}\ndensity", "body[0].velocity = {}: must be a table with value"),
                                ("density", "stress = {}\ndensity", "body[0].stress = {}: must be a table with value"),
                                ("pressure = 1e3", "affine = {}", "traction[0].affine = {}: must be a table with value"),
                                ("pressure = 1e3", "pressure = 1e3\ntime = {}", "traction[0].time = {}: must be a table with one of ramp"),
                                ("steps = 10", "steps = 10\n[removal]", "removal"),
                                ("steps = 10", "steps = 10\n[compare]", "compare.solution is missing"),
                                ("particles_per_cell = 2", "lattice = {}", "lattice")):
            message = self.refuse(self.changed(old, new), words)
            self.assertRegex(message, r"scene\.toml:\d+:\d+: ")
        # What has a default for every key and means something without one.
        for table in ("method", "output", "faces", "static"):
            self.check(GOOD + f"[{table}]\n")
        self.check(self.changed("steps = 10", "until_static = {}"))

    def test_numbers_that_are_too_small_to_compute_with(self):
        polar = "polar = { radii = [1.0, 2.0], radial_cells = 4, angles = [0.0, %s], angular_cells = 4 }"
        ring = self.changed("lower = [0.0, 0.0], upper = [4.0, 4.0], spacing = 0.5", polar % "5e-324")
        self.refuse(ring, "scene.toml:2:", "grid.polar.angles[1] = 5e-324", "too small to compute with")
        self.refuse(ring.replace("[0.0, 5e-324]", "[90.0, 90.00000000000003]"), "scene.toml:2:", "angles", "too close together for 4 cells")
        for old, new in (("density = 1000.0", "density = 1e-320"), ("upper = [3.0, 3.0]", "upper = [3.0, 4e-310]"),
                         ("kappa = 0.5", "kappa = 5e-324"), ("pressure = 1e3", "pressure = -5e-324")):
            self.refuse(self.changed(old, new), "too small to compute with: must be 0 or at least 2.2e-308 in size")
        self.check(self.changed("pressure = 1e3", "pressure = 0.0"))

    def test_numbers_that_overflow_together(self):
        for old, new, words in (("youngs_modulus = 1e6", "youngs_modulus = 1.7e308", "body[0]: the modulus in uniaxial strain is inf"),
                                ("density = 1000.0", "density = 1e-307", "body[0]: the mass of a particle is 6.25e-309")):
            self.refuse(self.changed(old, new), words, "scene.toml:", 'precision = "double"')
        single = 'precision = "float"\n' + GOOD
        for old, new in (("density = 1000.0", "density = 1e40"), ("youngs_modulus = 1e6", "youngs_modulus = 1e39"),
                         ("density = 1000.0", "density = 1e-40"), ("pressure = 1e3", "pressure = 1e39"),
                         ("density", "velocity = [1e39, 0.0]\ndensity"), ("density", "stress = [1e39, 0, 0, 0, 0, 0]\ndensity")):
            self.refuse(self.changed(old, new, single), "float")

    def test_grids_and_lattices_beyond_the_machine(self):
        giga = 10**9
        huge = GOOD.replace("upper = [4.0, 4.0], spacing = 0.5", "upper = [25e3, 25e3], spacing = 1.0")
        message = self.refuse(huge, "6.25e+08 nodes", "need at least 55 GB", "and there are 3 GB", "grid.spacing", limit=3 * giga)
        self.assertIn("scene.toml", message)
        # Particles alone: 2 m x 2 m of 64 x 64 in cells of 25 mm.
        fine = GOOD.replace("spacing = 0.5", "spacing = 0.02").replace("particles_per_cell = 2", "particles_per_cell = 64")
        self.refuse(fine, "particles or more need at least", "and there are 3 GB", limit=3 * giga)
        self.refuse(GOOD.replace("spacing = 0.5", "spacing = 0.00125").replace("particles_per_cell = 2", "particles_per_cell = 64"),
                    "body 'block' has", "can be numbered")
        rings = "lattice.concentric = { center = [2.0, 2.0], radii = [0.1, 1.0], rings = 1000000, per_ring = 10000000 }"
        self.refuse(self.changed("particles_per_cell = 2", rings), "the lattice of body 'block' has 1e+13 points")
        self.refuse(self.changed("lower = [0.0, 0.0], upper = [4.0, 4.0], spacing = 0.5",
                                 "x = [%s], y = [0.0, 1.0, 4.0]" % ", ".join(str(k / 250) for k in range(1001)))
                    .replace("particles_per_cell = 2", "particles_per_cell = 64").replace("y = [0.0, 1.0, 4.0]",
                             "y = [%s]" % ", ".join(str(k / 250) for k in range(1001))), "the lattice of body 'block' has 4.1e+09 points")
        self.refuse(self.changed("upper = [4.0, 4.0]", "upper = [1e6, 1e6]"), "<= 1e9 nodes", "spacing")

    def test_free_fall_is_no_matter_of_units(self):
        fall = GOOD.replace("[[traction]]\npressure = 1e3\n", "").replace("youngs_modulus = 1e6", "youngs_modulus = 1e4")
        fall = "gravity = [0.0, -9.81]\n" + fall  # weight over modulus: 2 for 2 m, were it held
        self.assertNotIn("units", vsb("check", self.write(fall)).stderr)
        fixed = fall + '[faces]\ny_min = "fixed"\n'
        self.assertIn("1.96e+04 Pa / 1e+04 Pa = 2: check the units".replace("1.96e+04 Pa", "").strip(), vsb("check", self.write(fixed)).stderr)
        # The height that counts is that of the body, not that of the grid above it.
        tall = fixed.replace("youngs_modulus = 1e4", "youngs_modulus = 1e6").replace("upper = [4.0, 4.0]", "upper = [4.0, 64.0]")
        self.assertNotIn("units", vsb("check", self.write(tall)).stderr)

    def test_overrides_that_remove_keys(self):
        done = self.check(GOOD, "--set", "body[0].name=", "--set", "time.steps=", "--set", "time.until_static={ max_steps = 7 }")
        self.assertIn("name = 'body 1'", done.stdout)
        self.assertIn("max_steps = 7", done.stdout)
        scene = SCENES / "column.toml"
        self.assertIn("is missing", self.refuse(GOOD, "time.kappa is missing", extra=("--set", "time.kappa=")))
        self.refuse(GOOD, "--set time.kapa=", "no 'kapa' to remove", "did you mean 'kappa'", extra=("--set", "time.kapa="))
        self.refuse(GOOD, "--set method.damping=", "no 'method' to remove", extra=("--set", "method.damping="))
        self.refuse(GOOD, "no element 1", extra=("--set", "traction[1]="))
        bare = vsb("check", scene, "--set", "traction[0]=", "--set", "published=", "--set", "compare=")
        self.assertEqual(bare.returncode, 0, bare.stderr)
        self.assertNotIn("[[traction]]", bare.stdout)
        # An empty string is still to be had.
        self.assertIn("title = ''", self.check('title = "t"\n' + GOOD, "--set", 'title=""').stdout)

    def test_an_inclined_cylinder(self):
        """The mass of a cylinder of radius 0.8 and length 2 along (1, 0, 1), cut along its surface."""
        text = GOOD.replace("dimension = 2", "dimension = 3").replace("lower = [0.0, 0.0], upper = [4.0, 4.0]", "lower = [0.0, 0.0, 0.0], upper = [4.0, 4.0, 4.0]")
        text = text.replace("spacing = 0.5", "spacing = 0.25").replace('name = "block"', 'boundary = "cut"')
        shape = "{ box = { lower = [1.0, 1.0], upper = [3.0, 3.0] } }"
        cylinder = "{ cylinder = { axis = [1.0, 0.0, 1.0], center = [2.0, 2.0, 2.0], radius = 0.8, lower = %r, upper = %r } }"
        middle = 4 / np.sqrt(2)  # of the centre along the axis
        good = text.replace(shape, cylinder % (middle - 1, middle + 1))
        self.run_scene(self.write(good), "--set", "time.steps=1", "--set", "traction=", out="inclined")
        fields = last_fields(self.folder / "inclined")
        self.assertAlmostEqual(fields["mass"].sum() / (1000 * np.pi * 0.64 * 2), 1, delta=2e-3)
        x = fields["position"] - 2
        along, across = (x[:, 0] + x[:, 2]) / np.sqrt(2), np.hypot((x[:, 0] - x[:, 2]) / np.sqrt(2), x[:, 1])
        self.assertLess(np.abs(along).max(), 1)
        self.assertLess(across.max(), 0.8)
        self.refuse(good.replace("axis = [1.0, 0.0, 1.0]", "axis = [0.0, 0.0, 0.0]"), "the axis must not be zero")
        self.refuse(good.replace("axis = [1.0, 0.0, 1.0]", "axis = [1.0, 0.0]"), "axis", "an array of 3")

    def test_particles_that_cross_cells_on_linear_functions(self):
        warned = lambda done: done.stderr.count("cross cells")
        self.assertEqual(warned(self.check(BAR)), 1)
        done = vsb("run", self.write(BAR), "--quiet", "--out", self.folder / "bar")
        self.assertEqual((done.returncode, warned(done)), (0, 2), done.stderr)
        self.assertRegex(done.stderr, r"came to rest up to 0\.[78]\d* cells from where they began")
        for quiet in (("--set", "traction[0].pressure=2e4"), ("--set", 'method.basis="quadratic_bspline"')):
            self.assertEqual(warned(self.check(BAR, *quiet)), 0)
        gently = vsb("run", self.write(BAR), "--quiet", "--out", self.folder / "gently", "--set", "traction[0].pressure=2e4")
        self.assertEqual((gently.returncode, warned(gently)), (0, 0), gently.stderr)

    def test_a_body_that_does_not_quite_reach_its_support(self):
        def warned(lower, *arguments):
            return "the face acts across that gap" in self.check(BAR.replace("lower = [0.0], upper = [8.0]", f"lower = [{lower}], upper = [8.0]"), *arguments).stderr
        splines = ("--set", 'method.basis="quadratic_bspline"')
        self.assertTrue(warned(0.2))
        self.assertFalse(warned(0.0))
        self.assertFalse(warned(0.6))
        self.assertTrue(warned(0.6, *splines))
        one_cell = lambda top: BAR.replace("lower = [0.0], upper = [10.0]", "lower = [-0.5], upper = [10.0]").replace("upper = [8.0]", f"upper = [{top}]")
        for top in (1.0, 3.75, 8.0):  # whatever the body's height
            self.assertIn("begins 1 cells from the face x_min", self.check(one_cell(top), *splines).stderr)
            self.assertNotIn("across that gap", self.check(one_cell(top)).stderr)
        self.assertFalse(warned(0.2, "--set", 'faces.x_min="open"', "--set", "time.until_static=", "--set", "time.steps=1"))

    def test_two_bodies(self):
        """Bodies that share nodes hold on to each other; the strain of B-splines does not jump between two materials."""
        pair = lambda start, modulus: BAR + f"""
[[body]]
shape = {{ box = {{ lower = [{start}], upper = [9.0] }} }}
particles_per_cell = 2
density = 1000.0
material = {{ youngs_modulus = {modulus}, poisson_ratio = 0.0 }}
"""
        splines = ("--set", 'method.basis="quadratic_bspline"')
        bar = lambda text: text.replace("lower = [0.0], upper = [8.0]", "lower = [0.0], upper = [4.0]")
        for start, basis, told in ((4.0, (), False), (4.9, (), True), (5.0, (), False), (5.0, splines, True), (5.5, splines, False)):
            self.assertEqual("cells apart" in self.check(bar(pair(start, 1e6)), *basis).stderr, told, start)
        for modulus, basis, told in ((1e6, splines, False), (1e7, splines, True), (1e7, (), False)):
            self.assertEqual("differ 10 times in stiffness" in self.check(bar(pair(4.0, modulus)), *basis).stderr, told)
        between_lines = bar(pair(4.0, 1e7)).replace("upper = [4.0]", "upper = [4.25]").replace("lower = [4.0]", "lower = [4.25]")
        self.assertIn("is not a line of the grid", self.check(between_lines).stderr)

    def test_sudden_weight_and_water_that_stands_askew(self):
        weight = ("--set", "gravity=[-10.0]", "--set", 'body[0].material={ law = "von_mises", youngs_modulus = 1e6, poisson_ratio = 0.0, yield_stress = 1e5 }')
        told = lambda *more: "gravity acts in full" in self.check(BAR, *weight, *more).stderr
        self.assertTrue(told())
        self.assertFalse(told("--set", "method.damping=0.8"))
        self.assertFalse(told("--set", "gravity=[0.0]"))
        water = GOOD.replace("pressure = 1e3", "hydrostatic = { unit_weight = 1e4, level = 2.0 }")
        for gravity, askew in (("[0.0, -0.1]", False), ("[0.0, 0.0]", False), ("[-0.1, 0.0]", True)):
            self.assertEqual("not against gravity" in self.check(water, "--set", f"gravity={gravity}").stderr, askew)

    def test_an_angle_of_friction_in_radians(self):
        soil = lambda angle: ("--set", f'body[0].material={{ law = "mohr_coulomb", youngs_modulus = 1e6, poisson_ratio = 0.2, cohesion = 1e4, friction_angle = {angle} }}')
        for angle, told in ((0.5236, True), (30.0, False), (0.0, False)):
            self.assertEqual("were radians meant, give 30" in self.check(GOOD, *soil(angle)).stderr, told)

    def test_rest_without_any_load(self):
        ends = ("--set", "traction[0].time={ table = [[0.0, 1.0], [1.0, 0.0]] }")
        self.refuse(BAR, "time.until_static", "every load ends at 0", "time.steps", extra=ends)
        for kept in (("--set", "gravity=[-1.0]"), ("--set", "body[0].stress=[1.0, 0.0, 0.0, 0.0, 0.0, 0.0]")):
            self.check(BAR, *ends, *kept)

    def test_a_scene_that_leaves_its_setting_open_is_told_of_the_accurate_one(self):
        advice = 'setting = "accurate"'
        says = lambda text, *arguments: advice in vsb("check", self.write(text), *arguments).stdout.replace("setting = 'paper'", "")
        self.assertTrue(says(GOOD))
        run = lambda *more: vsb("run", self.write(GOOD), "--out", self.folder / "out", *more).stdout
        self.assertEqual(run().count(advice), 1)
        self.assertEqual(run("--quiet"), "")
        chosen = ('setting = "paper"\n' + GOOD, GOOD + '[method]\nbasis = "linear"\n', GOOD.replace("density", 'boundary = "keep"\ndensity'))
        impossible = ('precision = "float"\n' + GOOD, GOOD.replace("pressure = 1e3", 'pressure = 1e3\nimposition = "virtual_stress_original"'),
                      GOOD.replace("lower = [0.0, 0.0], upper = [4.0, 4.0], spacing = 0.5", "x = [0.0, 1.0, 2.0, 3.0, 4.0], y = [0.0, 1.0, 2.0, 3.0, 4.0]"),
                      GOOD.replace("particles_per_cell = 2", "lattice.uniform = { spacing = 0.21 }\njitter = 0.1"),
                      GOOD + '[output]\nfields = ["recovered_stress"]\n')
        for text in chosen + impossible:
            self.assertFalse(says(text), text)
        self.assertFalse(says(GOOD, "--set", "setting=paper"))


if __name__ == "__main__":
    unittest.main()
