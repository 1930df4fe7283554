# SPDX-License-Identifier: BSD-3-Clause
"""Resultants of tractions that end at supports, surfaces that move with the material, and loads that are lost."""
import json
import re
import unittest

import h5py
import numpy as np
from test_checkpoints import SEAL, seal
from vsb_program import SCENES, ProgramTest, last_fields, vsb

# Water 8 m deep against an inclined face (1 : 2) on a fixed base.
DAM = """
dimension = 2
grid = { lower = [0.0, 0.0], upper = [20.0, 12.0], spacing = 0.5 }
faces.y_min = "%s"
[[body]]
particles_per_cell = 2
density = 2400.0
material = { youngs_modulus = 2e10, poisson_ratio = 0.2 }
shape.intersection = [
  { box = { lower = [2.0, 0.0], upper = [18.0, 10.0] } },
  { half_space = { point = [2.0, 0.0], normal = [-1.0, 0.5] } },
  { half_space = { point = [12.0, 0.0], normal = [1.0, 0.3] } },
]
[[traction]]
hydrostatic = { unit_weight = 9810.0, level = 8.0 }
surface.half_space = { point = [8.0, 0.0], normal = [1.0, 0.0] }
[method]
damping = 0.3
[time]
kappa = 0.5
steps = 20
"""
WATER = 9810 * 64 / 2, -9810 * 64 / 4

# A column shortened by p = 0.3 E; its end leaves the region in which the load is declared at first.
COLUMN = """
dimension = 1
grid = { lower = [0.0], upper = [12.0], spacing = 0.5 }
faces.x_min = "fixed"
[[body]]
shape.box = { lower = [0.0], upper = [9.6] }
lattice.uniform = { spacing = 0.1 }
density = 1.0
material = { youngs_modulus = 1e3, poisson_ratio = 0.0 }
[[traction]]
name = "end"
pressure = 300.0
surface.box = { lower = [8.5], upper = [12.0] }
time = { smooth_ramp = 5.0 }
[method]
damping = 0.1
volume_update = "exponential"
[time]
kappa = 0.2
until_static = {}
"""
INITIAL = ("--set", 'traction[0].configuration="initial"')


def engine(name):
    return ("--set", f'method.engine="{name}"')


class Resultants(ProgramTest):
    def checked(self, scene, *more):
        """Resultant of the tractions and the one on the exact surface, as `vsb check` prints them."""
        done = vsb("check", scene, *more)
        self.assertEqual(done.returncode, 0, done.stderr)
        found = re.search(r"resultant of the tractions \((.*?)\) N, on the exact surface \((.*?)\) N", done.stdout)
        return [np.array([float(f) for f in part.split(",")]) for part in found.groups()]

    def test_a_face_that_ends_at_a_support(self):
        for face in ("fixed", "roller"):
            scene = self.write(DAM % face)
            for more, tolerance in (((), 1e-6), (("--set", 'traction[0].imposition="virtual_stress_original"'), 0.02),
                                    (("--set", 'traction[0].imposition="boundary_particles"'), 1e-3),
                                    (("--set", 'traction[0].imposition="material_points"'), 0.02),
                                    (("--set", 'method.basis="quadratic_bspline"'), 1e-3), (("--set", 'method.basis="ugimp"'), 0.02),
                                    (("--set", 'setting="accurate"'), 5e-4), (("--set", 'body[0].boundary="cut"'), 5e-4)):
                force, exact = self.checked(scene, *more)
                np.testing.assert_allclose(exact[:2], WATER, rtol=1e-3)
                np.testing.assert_allclose(force[:2], WATER, rtol=tolerance, err_msg=f"{face} {more}")

    def test_both_engines_in_a_run(self):
        scene = self.write(DAM % "fixed")
        accurate = ("--set", 'setting="accurate"')
        for name, more in (("cell_lanes", ()), ("particles", ()), ("cell_lanes", accurate), ("particles", accurate)):
            summary = self.run_scene(scene, *engine(name), *more, out=name)
            np.testing.assert_allclose(summary["net_force"][:2], WATER, rtol=1e-3, err_msg=f"{name} {more}")

    def test_quarter_models(self):
        for scene, more, tolerance in (("cylinder", (), 2e-3), ("cylinder-accurate", (), 2e-3), ("cylinder-polar", (), 1e-3),
                                       ("cylinder-polar", ("--set", "body[0].particles_per_cell=[4, 2]"), 2e-3),
                                       ("cylinder-polar", ("--set", "grid.polar.angular_cells=20"), 2e-4),
                                       ("cylinder", ("--set", 'method.basis="quadratic_bspline"'), 2e-3)):
            force, exact = self.checked(SCENES / f"{scene}.toml", *more)
            np.testing.assert_allclose(exact[:2], 1e5, rtol=1e-3)
            np.testing.assert_allclose(force[:2], 1e5, rtol=tolerance, err_msg=f"{scene} {more}")

    def test_particles_that_are_no_cubes(self):
        # Sectors of rings, thrice as long as wide at the hole. That they do not fill cells evenly makes 0.7 % of the force.
        force, _ = self.checked(SCENES / "cylinder-concentric.toml")
        np.testing.assert_allclose(force[:2], 1e5, rtol=1e-2)
        # Boxes that lie flat on a roller, and upright ones: of these the lowest row begins one column, 1/16 m, off the heel.
        for per_cell, missing in (("[2, 8]", 0), ("[8, 2]", 9810 * 8 / 16)):
            scene = self.write((DAM % "roller").replace("particles_per_cell = 2", f"particles_per_cell = {per_cell}"))
            force, _ = self.checked(scene)
            np.testing.assert_allclose(force[:2], (WATER[0], WATER[1] + missing), rtol=1e-6)

    def test_polar_grids_have_the_mass_that_was_drawn(self):
        self.run_scene("cylinder-polar", "--set", "time.until_static.max_steps=1")
        fields = last_fields(self.folder / "cylinder-polar")
        angle = np.pi / 20
        self.assertAlmostEqual(fields["mass"].sum() / (1000 * np.pi * 6), 1, delta=1e-12)
        self.assertAlmostEqual(fields["volume"].sum() / (np.pi * 6 * np.sin(angle) / angle), 1, delta=1e-9)  # after a step


class Surfaces(ProgramTest):
    # With linear functions particles that cross cells at such strains keep the stress from being right (study
    # large-strain); with B-splines it is.
    SPLINES = ("--set", 'method.basis="quadratic_bspline"')

    def test_a_load_that_leaves_its_region_is_told(self):
        for name in ("cell_lanes", "particles"):
            done = vsb("run", self.write(COLUMN), "--out", self.folder / name, *engine(name))
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("its 'surface' is fixed in space", done.stderr)  # before it begins
            at, time, told = re.search(r"warning: at step (\d+), time ([\d.]+) s: traction 'end' (.*)", done.stderr).groups()
            self.assertEqual(done.stderr.count("at step"), 1)
            self.assertIn('configuration = "initial"', told)
            self.assertIn("lost load: at step", done.stdout)
            summary = self.summary(name)["tractions"]
            self.assertEqual([t["name"] for t in summary], ["end"])
            self.assertEqual(summary[0]["lost_at_step"], int(at))
            self.assertLess(abs(summary[0]["full_force"][0]), 0.9 * abs(summary[0]["full_force_at_start"][0]))
            # The end has passed node 8.5 by then, where the region ends, or is in the cell beyond.
            self.assertGreater(float(time), 1)

    def summary(self, out):
        return json.loads((self.folder / out / "summary.json").read_text())

    def test_a_resumed_run_knows_what_was_lost(self):
        scene = self.write(COLUMN.replace("until_static = {}", "steps = 3000"))
        steps = lambda n: ("--set", f"time.steps={n}")
        self.run_scene(scene, out="whole")
        whole = self.summary("whole")["tractions"]
        self.assertLess(abs(whole[0]["full_force"][0]), 200)
        at = whole[0]["lost_at_step"]
        for first in (at - 150, at + 450):
            out = f"parts-{first}"
            self.run_scene(scene, *steps(first), out=out)
            earlier = self.summary(out)["tractions"]
            self.assertEqual("lost_at_step" in earlier[0], first > at)
            done = vsb("run", scene, "--out", self.folder / out, *steps(first), "--resume")  # no step to be done
            self.assertEqual((done.returncode, self.summary(out)["tractions"]), (0, earlier), done.stderr)
            self.assertEqual(done.stdout.count("lost load"), first > at)
            done = vsb("run", scene, "--out", self.folder / out, "--resume")
            self.assertEqual((done.returncode, self.summary(out)["tractions"]), (0, whole), done.stderr)
            self.assertEqual(done.stderr.count("warning: at step"), first < at)
            self.assertIn(f"lost load: at step {at},", done.stdout)

    def test_what_a_checkpoint_says_of_tractions_is_checked(self):
        scene, checkpoint = self.write(COLUMN.replace("until_static = {}", "steps = 100")), self.folder / "c" / "scene.checkpoint"
        self.run_scene(scene, out="c")
        good = checkpoint.read_bytes()
        for pattern, other in (("tractions = .*", "tractions = []}"), ("tractions = .*", "tractions = 1}"), ("{ tractions", "{ traction"),
                               ("traction = 0", "traction = 1"), ("lost_at = -1", "lost_at = 101"), ("lost_at = -1", "lost_at = 50"),
                               ("part_cells = 0", "part_cells = -1"), ("part_cells = 0", "part_cells = 3000000000"),
                               (r"force = \[[^]]*\]", "force = [1.0, 2.0]"), (r"load = [^,]*", "load = 'much'"), (r"load = ", "")):
            checkpoint.write_bytes(good[:-SEAL])
            with h5py.File(checkpoint, "r+") as file:
                text = file["checkpoint/watched"][0].decode()
                changed = re.sub(pattern, other, text, count=1)
                self.assertNotEqual(changed, text, pattern)
                del file["checkpoint/watched"]
                file["checkpoint/watched"] = np.array([changed.encode()])
            seal(checkpoint)
            done = vsb("run", scene, "--out", self.folder / "c", "--resume")
            self.assertEqual(done.returncode, 2, changed + done.stdout + done.stderr)
            self.assertIn("the checkpoint is damaged: what it says of the tractions does not fit this scene", done.stderr)

    def test_a_surface_moves_with_the_material(self):
        for name in ("cell_lanes", "particles"):
            done = vsb("run", self.write(COLUMN), "--out", self.folder / name, *engine(name), *INITIAL, *self.SPLINES)
            self.assertEqual(done.returncode, 0, name + done.stderr)
            self.assertNotIn("traction 'end'", done.stderr)
            fields = last_fields(self.folder / name)
            x, stress = fields["position"][:, 0], fields["cauchy_stress"][:, 0]
            np.testing.assert_allclose(x.max() + fields["volume"][x.argmax()] / 2, 9.6 * np.exp(-0.3), rtol=2e-3)
            np.testing.assert_allclose(stress, -300, rtol=0.015)
            told = self.summary(name)["tractions"][0]
            self.assertNotIn("lost_at_step", told)
            self.assertAlmostEqual(told["full_force"][0] / -300, 1, delta=0.01)

    def test_both_engines_carry_it_to_the_same_nodes(self):
        more = ("--set", "time.until_static.max_steps=900")
        ends = []
        for name in ("cell_lanes", "particles"):
            told = self.run_scene(self.write(COLUMN), *engine(name), *INITIAL, *more, out=name)["tractions"][0]
            self.assertNotIn("lost_at_step", told)
            ends.append(last_fields(self.folder / name)["position"][:, 0])
        np.testing.assert_allclose(*ends, rtol=1e-9)
        self.assertLess(ends[0].max(), 9)  # nearly two cells away from where it began

    def test_resumed_runs_have_the_same_bits(self):
        scene = self.write(COLUMN)
        for name in ("cell_lanes", "particles"):
            self.resume(str(scene.with_suffix("")), *engine(name), *INITIAL, "--set",
                        "time.until_static.max_steps=20000", pause=0.3)

    def test_where_it_does_not_belong(self):
        scene = self.write(COLUMN)
        for more, words in ((("--set", 'traction[0].configuration="first"'), 'one of'),
                            (("--set", 'traction[0].imposition="boundary_particles"', "--set", 'traction[0].configuration="current"'),
                             "configuration"),
                            ((*INITIAL, "--set", "traction[0].surface.box.lower=[9.7]"), "no particle lies in its 'surface'")):
            done = vsb("check", scene, *more)
            self.assertEqual(done.returncode, 2, more)
            self.assertIn(words, done.stderr)


class Footing(ProgramTest):
    """A pressure on a part of a straight edge: nodes are loaded as a whole."""
    SOIL = """
        dimension = 2
        grid = { lower = [0.0, 0.0], upper = [4.0, 3.0], spacing = 0.25 }
        faces = { x_min = "roller", x_max = "roller", y_min = "roller" }
        time = { kappa = 0.5, steps = 1 }
        [[body]]
        particles_per_cell = 2
        density = 1800.0
        material = { youngs_modulus = 2e7, poisson_ratio = 0.3 }
        shape.box = { lower = [0.0, 0.0], upper = [4.0, 2.0] }
        [[traction]]
        name = "footing"
        pressure = 1e5
        surface.box = { lower = [0.0, 1.5], upper = [%g, 2.5] }
        """

    def test_half_a_cell_more_is_told(self):
        for width, told in ((1.0, True), (5.0, False)):
            done = vsb("check", self.write(self.SOIL % width))
            self.assertEqual(done.returncode, 0, done.stderr)
            sentence = re.search(r"'footing' has the resultant \((.*)\) N at full load, but \((.*)\) N", done.stderr)
            self.assertEqual(sentence is not None, told, done.stderr)
            if told:
                acting, exact = (float(sentence[n].split(",")[1]) for n in (1, 2))
                self.assertAlmostEqual(acting, -1e5 * (width + 0.125))
                self.assertAlmostEqual(exact, -1e5 * width)


if __name__ == "__main__":
    unittest.main()
