# SPDX-License-Identifier: BSD-3-Clause
"""Bodies that go out of the grid: told from divergence, kept as a frame, or let go."""
import json
import re
import unittest

import h5py
import numpy as np

from vsb_program import ProgramTest, frames, last_fields, vsb

BLOCK = """
    dimension = 2
    grid = { lower = [0.0, 0.0], upper = [4.0, 4.0], spacing = 0.5 }
    time = { dt = 0.001, steps = 2000 }
    output = { every = 600 }
    [[body]]
    shape.box = { lower = [1.0, 1.0], upper = [2.0, 2.0] }
    particles_per_cell = 2
    density = 1000.0
    velocity = [2.0, 0.0]
    material = { youngs_modulus = 1e6, poisson_ratio = 0.3 }
    """
OUTFLOW = BLOCK.replace("time =", 'faces = { x_max = "outflow" }\n    time =')
WAYS = [("cell_lanes", "linear"), ("particles", "linear"), ("cell_lanes", "quadratic_bspline"),
        ("particles", "quadratic_bspline"), ("particles", "ugimp")]
# A body that yields as it is squeezed between a fixed face and its own inertia, and flows out of two faces.
SQUEEZED = """
    dimension = 2
    gravity = [0.0, -10.0]
    grid = { lower = [0.0, 0.0], upper = [4.0, 3.0], spacing = 0.25 }
    faces = { y_min = "roller", x_min = "outflow", x_max = "outflow" }
    time = { kappa = 0.4, steps = 1000 }
    [[body]]
    shape.box = { lower = [0.5, 0.0], upper = [3.5, 2.0] }
    particles_per_cell = 2
    density = 1000.0
    material = { law = "von_mises", youngs_modulus = 1e6, poisson_ratio = 0.3, yield_stress = 2e3 }
    """


def method(engine, basis):
    return "--set", f"method.engine={engine}", "--set", f"method.basis={basis}"


class LeavesTheGrid(ProgramTest):
    def test_a_healthy_leave_is_told_and_kept(self):
        scene = self.write(BLOCK)
        for engine, basis in WAYS:
            with self.subTest(engine=engine, basis=basis):
                out = self.folder / f"{engine}-{basis}"
                done = vsb("run", scene, "--out", out, *method(engine, basis))
                self.assertEqual(done.returncode, 8, done.stdout + done.stderr)
                # The foremost particles, at 1.875 m, have 2.125 m to go at 2 m/s.
                self.assertRegex(done.stderr, r"vsb: at step 106[23], time 1\.06[23] s: particle \d+ left the grid at the open face x_max, "
                                              r"at \(4(\.00\d+)?, 1\.\d+\) m, moving at 2 m/s, and 3 others in this step; make the grid larger, "
                                              r'or let such particles go: faces\.x_max = "outflow"; the last frame is the state of this step')
                step = int(re.search(r"at step (\d+)", done.stderr)[1])
                with h5py.File(frames(out)[-1][0]) as file:
                    self.assertAlmostEqual(frames(out)[-1][1], step * 0.001)
                    points = file["VTKHDF/Points"][()]
                    fields = {name: data[()] for name, data in file["VTKHDF/PointData"].items()}
                self.assertEqual(len(points), 16)
                self.assertEqual((points[:, 0] >= 4).sum(), 4)
                np.testing.assert_allclose(points[:, 0].max(), 1.875 + 2 * step * 0.001, rtol=1e-12)
                np.testing.assert_allclose(fields["displacement"][:, 0], 2 * step * 0.001, rtol=1e-12)
                np.testing.assert_allclose(fields["velocity"][:, 0], 2, rtol=1e-12)
                summary = json.loads((out / "summary.json").read_text())
                self.assertEqual((summary["steps"], summary["particles"]), (step, 16))
                self.assertIn("left the grid at the open face x_max", summary["left_grid"])

    def test_in_single_precision_far_away_in_one_and_three_dimensions(self):
        line = BLOCK.replace("dimension = 2", "dimension = 1").replace("[0.0, 0.0]", "[0.0]").replace("[4.0, 4.0]", "[4.0]") \
            .replace("[1.0, 1.0]", "[1.0]").replace("[2.0, 2.0]", "[2.0]").replace("[2.0, 0.0]", "[2.0]")
        space = BLOCK.replace("dimension = 2", "dimension = 3").replace(", 0.0]", ", 0.0, 0.0]").replace(", 4.0]", ", 4.0, 4.0]") \
            .replace(", 1.0]", ", 1.0, 1.0]").replace(", 2.0]", ", 2.0, 2.0]")
        far = BLOCK.replace("[0.0, 0.0], upper = [4.0, 4.0]", "[500000.0, 4200000.0], upper = [500004.0, 4200004.0]") \
            .replace("[1.0, 1.0]", "[500001.0, 4200001.0]").replace("[2.0, 2.0]", "[500002.0, 4200002.0]")
        for name, text, position in (("line", line, r"4(\.00\d+)?"), ("space", space, r"4(\.00\d+)?, 1\.\d+, 1\.\d+"),
                                  ("far", far, r"500004(\.00\d*)?, 4200001\.\d+")):
            for engine in ("cell_lanes", "particles"):
                done = vsb("run", self.write(text), "--out", self.folder / f"{name}-{engine}", "--set", "precision=float",
                           "--set", f"method.engine={engine}")
                self.assertEqual(done.returncode, 8, done.stderr)
                self.assertRegex(done.stderr, rf"at step 106[1-4], .* left the grid at the open face x_max, at \({position}\) m")

    def test_from_a_polar_grid(self):
        polar = BLOCK.replace("lower = [0.0, 0.0], upper = [4.0, 4.0], spacing = 0.5",
                              "polar = { radii = [0.5, 4.0], radial_cells = 8, angles = [0, 90], angular_cells = 8 }")
        done = vsb("run", self.write(polar), "--out", self.folder / "polar", "--set", "output.grid=true")
        self.assertEqual(done.returncode, 8, done.stderr)
        self.assertRegex(done.stderr, r"left the grid at the open face r_max, at \(3\.\d+, 1\.\d+\) m")
        summary = self.run_scene(self.write(polar.replace("time =", 'faces.r_max = "outflow"\n    time ='), "out.toml"))
        out = summary["outflow"]
        self.assertGreater(out["particles"], 10)
        self.assertEqual((summary["particles"], out["faces"]), (0, {"r_max": out["particles"]}))

    def test_unstable_steps_are_a_divergence(self):
        """Whichever way a particle is thrown out of the grid: exit code 3, and no summary."""
        for kappa in (1.6, 1.8, 2.0):
            for engine in ("cell_lanes", "particles"):
                out = self.folder / f"{kappa}-{engine}"
                done = vsb("run", self.write(BLOCK.replace("dt = 0.001", f"kappa = {kappa}")), "--out", out, "--set",
                           "body[0].velocity={ value = [0.0, 0.0], dx = [1.0, 0.5], dy = [0.3, -1.0] }",
                           "--set", f"method.engine={engine}")
                self.assertEqual(done.returncode, 3, f"kappa {kappa}, {engine}: {done.stderr}")
                self.assertIn("diverged at step", done.stderr)
                self.assertFalse((out / "summary.json").exists())

    def test_large_strain_is_no_divergence(self):
        """A block let go from a pressure of a fifth of its modulus, at the speed of its waves, 36.7 m/s: healthy. In steps of
        1.6 times the critical one, with volumes that stay positive, it is not."""
        healthy = ("body[0].stress=[-269230.0,-269230.0,-269230.0,0.0,0.0,0.0]", "body[0].velocity=[36.69,0.0]", "time.kappa=0.2")
        unstable = ("body[0].velocity={ value = [0.0, 0.0], dx = [1.0, 0.5], dy = [0.3, -1.0] }", "time.kappa=1.6",
                    "method.volume_update=exponential")
        for more, code in ((healthy, 8), (unstable, 3)):
            sets = [part for key in ("time.dt=", "grid.spacing=0.25", *more) for part in ("--set", key)]
            done = vsb("run", self.write(BLOCK), "--out", self.folder / f"{code}", *sets)
            self.assertEqual(done.returncode, code, done.stderr)

    def test_faster_than_its_waves_is_no_divergence(self):
        done = vsb("run", self.write(BLOCK), "--out", self.folder / "fast", "--set", "body[0].velocity=[200.0,0.0]")
        self.assertEqual(done.returncode, 8, done.stderr)
        self.assertIn("moving at 200 m/s", done.stderr)

    def test_studies_tell_it_as_a_failure_of_the_case(self):
        self.write(BLOCK, "block.toml")
        study = self.write("""
            title = "A block that leaves"
            axis = { name = "spacing", unit = "m" }
            [[series]]
            name = "leaves"
            scene = "block.toml"
            [[series.case]]
            axis = 0.5
            expect_failure = "left the grid at the open face x_max"
            """, "study.toml")
        done = vsb("study", study, "--out", self.folder / "study")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)


class Outflow(ProgramTest):
    def test_a_block_leaves_column_by_column(self):
        scene = self.write(OUTFLOW)
        hashes = {}
        for engine, basis in WAYS:
            with self.subTest(engine=engine, basis=basis):
                out = self.folder / f"{engine}-{basis}"
                done = vsb("run", scene, "--out", out, *method(engine, basis), "--set", "time.steps=1400", "--set", "output.every=200")
                self.assertEqual(done.returncode, 0, done.stderr)
                summary = json.loads((out / "summary.json").read_text())
                left = summary["outflow"]
                # Columns at 1.875, 1.625, 1.375 m have gone after 1.0625, 1.1875, 1.3125 s.
                self.assertEqual((left["particles"], left["faces"], summary["particles"]), (12, {"x_max": 12}, 4))
                self.assertIn(left["first_step"], (1062, 1063))
                self.assertIn(left["last_step"], (1312, 1313))
                np.testing.assert_allclose([left["mass_at_start"], left["mass"], left["mass_in_grid"]], [1000, 750, 250], rtol=1e-12)
                self.assertRegex(done.stdout, r"left the grid: 12 particles, 750 kg, steps 106[23] to 131[23]: 12 at x_max; "
                                              r"mass 1000 kg at the start, 250 kg in the grid, 0\.00e\+00 of it unaccounted for")
                counts = []
                for path, _ in frames(out):
                    with h5py.File(path) as file:
                        counts.append(len(file["VTKHDF/Points"]))
                self.assertEqual(counts, [16] * 6 + [8, 4])
                fields = last_fields(out)
                np.testing.assert_array_equal(fields["id"] % 4, 0)  # the hindmost of each row
                np.testing.assert_allclose(fields["displacement"][:, 0], 2.8, rtol=1e-9)

    def test_the_last_particles(self):
        done = vsb("run", self.write(OUTFLOW), "--out", self.folder / "all")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, r"at step 143[78], time 1\.43[78] s: the last particles left the grid; the run ends here")
        summary = json.loads((self.folder / "all" / "summary.json").read_text())
        left = summary["outflow"]
        self.assertEqual((left["particles"], summary["particles"]), (16, 0))
        np.testing.assert_allclose([left["mass"], left["mass_in_grid"]], [1000, 0], atol=1e-9)
        self.assertEqual(len(last_fields(self.folder / "all")["id"]), 4)  # as they left
        self.assertIn("no particle is left in the grid", done.stdout)
        self.assertNotRegex(done.stdout, r"energy [\d(r]")
        self.assertFalse({"kinetic_energy", "largest_displacement", "not_finite"} & summary.keys())

    def test_other_faces_still_hold_the_run(self):
        done = vsb("run", self.write(OUTFLOW), "--out", self.folder / "up", "--set", "body[0].velocity=[0.0,2.0]")
        self.assertEqual(done.returncode, 8, done.stderr)
        self.assertIn("left the grid at the open face y_max", done.stderr)

    def test_engines_agree_on_a_body_that_yields_and_flows_out(self):
        fields, left = {}, {}
        for engine in ("cell_lanes", "particles"):
            summary = self.run_scene(self.write(SQUEEZED), "--set", f"method.engine={engine}", out=engine)
            fields[engine], left[engine] = last_fields(self.folder / engine), summary["outflow"]
            self.assertAlmostEqual(left[engine]["mass"] + left[engine]["mass_in_grid"], 6000, delta=1e-6)
        self.assertGreater(left["particles"]["particles"], 50)
        self.assertGreater(min(left["particles"]["faces"].values()), 20)
        self.assertEqual(left["cell_lanes"], {**left["particles"], "mass_in_grid": left["cell_lanes"]["mass_in_grid"]})
        np.testing.assert_array_equal(fields["cell_lanes"]["id"], fields["particles"]["id"])
        self.assertGreater(fields["particles"]["equivalent_plastic_strain"].max(), 0.5)
        for name in ("position", "velocity", "cauchy_stress", "plastic_strain", "volume", "mass"):
            ours, theirs = fields["cell_lanes"][name], fields["particles"][name]
            np.testing.assert_allclose(ours, theirs, rtol=0, atol=1e-7 * np.abs(theirs).max(), err_msg=name)

    def test_same_bits_after_a_resume_and_with_any_number_of_threads(self):
        scene = self.write(SQUEEZED)
        passive = {"OMP_WAIT_POLICY": "passive"}
        for engine in ("cell_lanes", "particles"):
            more = ("--set", f"method.engine={engine}")
            once = self.run_scene(scene, *more, "--threads", "1", out=f"once-{engine}")
            thrice = self.run_scene(scene, *more, "--threads", "3", out=f"thrice-{engine}", environment=passive)
            self.assertEqual(once["state_hash"], thrice["state_hash"])

    def test_resume(self):
        for engine in ("cell_lanes", "particles"):
            with self.subTest(engine=engine):
                whole, parts = self.resumed(engine)
                self.assertEqual(parts["state_hash"], whole["state_hash"])
                self.assertEqual(parts["outflow"], whole["outflow"])

    def resumed(self, engine):
        """Runs in one go, and interrupted after particles have left."""
        import signal
        import subprocess
        import time

        from vsb_program import PROGRAM
        scene = self.write(SQUEEZED)
        more = ("--set", f"method.engine={engine}", "--set", "time.steps=12000", "--set", "time.kappa=0.05")
        whole = self.run_scene(scene, *more, out=f"whole-{engine}")
        out = self.folder / f"parts-{engine}"
        run = subprocess.Popen([PROGRAM, "run", str(scene), "--out", str(out), *more], stdout=subprocess.PIPE, text=True)
        run.stdout.readline()
        time.sleep(0.8 * whole["seconds"])
        run.send_signal(signal.SIGINT)
        output, _ = run.communicate(timeout=60)
        self.assertEqual(run.returncode, 5, output)
        with h5py.File(out / "scene.checkpoint") as file:
            self.assertLess(file["staged/present"][()].sum(), file["staged/present"].shape[0])
        return whole, self.run_scene(scene, *more, "--resume", out=out)

    def test_what_outflow_is_not_for(self):
        loaded = OUTFLOW + """
            [[traction]]
            pressure = 1e3
            imposition = "boundary_particles"
            surface.box = { lower = [0.0, 0.0], upper = [4.0, 4.0] }
            """
        done = vsb("check", self.write(loaded))
        self.assertEqual(done.returncode, 2)
        self.assertRegex(done.stderr, r'scene\.toml:4:.*faces.*"outflow" is not for scenes with surface points')
        done = vsb("check", self.write(OUTFLOW), "--set", "faces.x_max=outlet")
        self.assertEqual(done.returncode, 2)
        self.assertRegex(done.stderr, r"faces\.x_max.*open.*outflow.*roller.*fixed")


if __name__ == "__main__":
    unittest.main()
