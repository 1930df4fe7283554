# SPDX-License-Identifier: BSD-3-Clause
"""Removal of failed particles in stages (Algorithm 2): the wellbore of Section 4.4 as a slice."""
import json
import re
import signal
import subprocess
import time
import tomllib
import unittest

import h5py
import numpy as np
from vsb_program import PROGRAM, SCENES, ProgramTest, frames, last_fields, vsb

SLICE = SCENES / "wellbore-slice.toml"
A, B, ROW = 0.0127, 0.0762, 0.0015


def lattice():
    """Positions of the slice's particles, by hand: (k + 1/2) 1.5 mm in the quarter ring, x first."""
    k = (np.arange(60) + 0.5) * ROW
    x, y = np.meshgrid(k, k)
    r = np.hypot(x, y)
    inside = (r > A) & (r < B)
    return np.column_stack([x[inside], y[inside]])


class Slice(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        import tempfile
        import pathlib
        cls.shared = tempfile.TemporaryDirectory(prefix="vsb-test-")
        cls.addClassCleanup(cls.shared.cleanup)
        cls.out = pathlib.Path(cls.shared.name) / "slice"
        cls.done = vsb("run", SLICE, "--out", cls.out)
        assert cls.done.returncode == 0, cls.done.stderr
        cls.summary = json.loads((cls.out / "summary.json").read_text())
        cls.removal = cls.summary["removal"]

    def frame(self, step):
        with h5py.File(self.out / f"wellbore-slice_{step:06d}.hdf") as file:
            fields = {name: data[()] for name, data in file["VTKHDF/PointData"].items()}
            fields["start"] = file["VTKHDF/Points"][()] - fields["displacement"]
        return fields

    def test_the_stages_are_the_papers(self):
        stages = self.removal["stage"]
        self.assertEqual(len(stages), 4)
        self.assertEqual(self.removal["outcome"], "collapse")
        self.assertEqual(stages[0]["particles"], 1974)  # a quarter of 805,392 / 102 layers
        # An independent prototype: 136, 264 and 1080 of a full layer, within 5 %.
        for stage, full in zip(stages, (136, 264, 1080)):
            self.assertTrue(stage["removed"] and stage["at_rest"])
            self.assertAlmostEqual(4 * stage["failed"] / full, 1, delta=0.05, msg=str(stage))
        # The paper: 1 to 2 rows, 6 to 7, nearly 20. Seen from the mean depth and the farthest particle.
        for stage, mean, farthest in zip(stages, (1, 5, 14), (3, 7.5, 20)):
            self.assertGreater(stage["rows_mean"], mean)
            self.assertLess(stage["rows"], farthest)
            self.assertEqual(stage["asymmetry"], 0)
        self.assertAlmostEqual(stages[2]["rows"] / 19.8, 1, delta=0.05)
        # The wall is cut through, with the ring's outer face among the failed.
        self.assertFalse(stages[3]["removed"] or stages[3]["at_rest"])
        self.assertRegex(self.removal["reason"], r"the body is cut through: failed cells join the hole and the outside \(\d")
        self.assertGreater(stages[3]["rows"], (B - A) / ROW - 2)

    def test_what_is_left_keeps_ids_and_positions(self):
        position = lattice()
        self.assertEqual(len(position), 1974)
        present = np.ones(len(position), dtype=bool)
        for stage in self.removal["stage"]:
            fields = self.frame(stage["last_step"])
            np.testing.assert_array_equal(fields["id"], np.flatnonzero(present))
            np.testing.assert_allclose(fields["start"][:, :2], position[present], atol=1e-12)
            self.assertEqual(stage["particles"], present.sum())
            np.testing.assert_allclose(fields["mass"], 2500 * ROW**2, rtol=1e-12)
            if not stage["removed"]:
                break
            following = self.removal["stage"][self.removal["stage"].index(stage) + 1]
            left = self.frame(following["last_step"])["id"]
            self.assertEqual(len(left), present.sum() - stage["failed"])
            gone = np.setdiff1d(np.flatnonzero(present), left)
            rows = (np.hypot(*position[gone].T) - A) / ROW
            self.assertAlmostEqual(stage["rows"], rows.max(), delta=1e-9)
            present[gone] = False

    def test_the_measure_is_smoothed_and_the_threshold_divides(self):
        """Particles to nodes and back by hand: exactly those beyond 0.003 are gone in the next stage."""
        first, second = self.removal["stage"][:2]
        before, after = self.frame(first["last_step"]), self.frame(second["last_step"])["id"]
        e = before["plastic_strain"]
        mean = e[:, :3].mean(axis=1)
        q = np.sqrt(2 / 3 * (((e[:, :3] - mean[:, None])**2).sum(axis=1) + 2 * (e[:, 3:]**2).sum(axis=1)))
        np.testing.assert_allclose(before["equivalent_plastic_strain"], q, rtol=1e-12, atol=1e-18)
        x = (before["start"] + before["displacement"])[:, :2] / 0.003
        nodes, weights = [], []
        for a in (0, 1):
            for b in (0, 1):
                cell = np.floor(x).astype(int)
                xi = x - cell
                nodes.append((cell[:, 0] + a) + 100 * (cell[:, 1] + b))
                weights.append((xi[:, 0] if a else 1 - xi[:, 0]) * (xi[:, 1] if b else 1 - xi[:, 1]))
        m, mq = np.zeros(10000), np.zeros(10000)
        for node, weight in zip(nodes, weights):
            np.add.at(m, node, weight * before["mass"])
            np.add.at(mq, node, weight * before["mass"] * q)
        smooth = sum(w * mq[n] / m[n] for n, w in zip(nodes, weights))
        np.testing.assert_array_equal(np.setdiff1d(before["id"], after), before["id"][smooth > 0.003])
        self.assertAlmostEqual(first["largest"] / smooth.max(), 1, delta=1e-10)
        self.assertNotEqual((q > 0.003).sum(), first["failed"])  # the smoothing matters here
        self.assertAlmostEqual(first["yielded"] / before["volume"][q > 0].sum(), 1, delta=1e-12)

    def test_the_screen_tells_of_every_stage(self):
        for number, stage in enumerate(self.removal["stage"], 1):
            self.assertIn(f"stage {number}: {stage['failed']} of {stage['particles']} particles beyond the threshold, depth "
                          f"{stage['rows']:.2f} rows", self.done.stdout)
        self.assertIn("\ncollapse: " + self.removal["reason"], self.done.stdout)
        self.assertRegex(self.done.stdout, r"peak memory [\d.]+ MB")
        self.assertEqual([round(t / self.summary["dt"]) for _, t in frames(self.out)],
                         [0] + [s["last_step"] for s in self.removal["stage"]])


class Ways(ProgramTest):
    def run_slice(self, *arguments, out="w"):
        return self.run_scene(SLICE, *arguments, out=out)["removal"]

    def test_below_the_first_yield_nothing_fails(self):
        removal = self.run_slice("--set", "traction[0].pressure=3e6")  # the first yield is at 4.354 MPa
        self.assertEqual((removal["outcome"], len(removal["stage"])), ("steady", 1))
        self.assertEqual((removal["stage"][0]["failed"], removal["stage"][0]["yielded"]), (0, 0))

    def test_both_engines_remove_the_same_particles(self):
        left = []
        for engine in ("cell_lanes", "particles"):
            removal = self.run_slice("--set", f"method.engine={engine}", "--set", "removal.max_stages=2", out=engine)
            self.assertEqual(removal["outcome"], "max_stages")
            self.assertFalse(removal["stage"][1]["removed"])
            left.append(last_fields(self.folder / engine)["id"])
        np.testing.assert_array_equal(*left)
        self.assertLess(len(left[0]), 1974)

    def resume_after_stage_1(self, *arguments):
        command = [PROGRAM, "run", str(SLICE), "--out", str(self.folder / "parts"), "--set", "removal.max_stages=3", *arguments]
        run = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        for line in run.stdout:
            if line.startswith("stage 1:"):
                time.sleep(0.02)  # into the stage, though it need not be far; on a busy machine into the next one
                run.send_signal(signal.SIGINT)
                break
        output, _ = run.communicate(timeout=60)
        interrupted = re.search(r"interrupted at step (\d+)", output)
        self.assertIsNotNone(interrupted, output)
        parts = self.run_scene(SLICE, *command[5:], "--resume", out="parts")
        whole = self.run_scene(SLICE, *command[5:], out="whole")
        self.assertGreaterEqual(int(interrupted[1]), whole["removal"]["stage"][0]["last_step"])
        self.assertLess(int(interrupted[1]), whole["removal"]["stage"][-1]["last_step"])
        self.assertEqual(parts["state_hash"], whole["state_hash"])
        timeless = lambda s: [{k: v for k, v in stage.items() if k != "seconds"} for stage in s["removal"]["stage"]]
        self.assertEqual(timeless(parts), timeless(whole))
        a, b = last_fields(self.folder / "parts"), last_fields(self.folder / "whole")
        for name in a:
            np.testing.assert_array_equal(a[name], b[name], err_msg=name)

    def test_a_run_resumed_after_its_first_stage_has_the_same_bits(self):
        self.resume_after_stage_1()

    def test_so_has_one_that_goes_on_from_the_state_before(self):
        self.resume_after_stage_1("--set", "removal.next=continue", "--set", "method.engine=particles")

    def test_one_that_is_interrupted_again_and_again_has_them_too(self):
        """Also while it counts the steps without another failure."""
        arguments = ["--set", "removal.max_stages=1", "--set", "time.until_static.force_ratio=1e-12", "--set",
                     "method.engine=particles"]
        command = [PROGRAM, "run", str(SLICE), "--out", str(self.folder / "parts"), *arguments]
        interrupts = 0
        while True:
            run = subprocess.Popen([*command, *(["--resume"] if interrupts else [])], stdout=subprocess.PIPE, text=True)
            run.stdout.readline()  # the head line: the run has begun
            time.sleep(0.2)
            run.send_signal(signal.SIGINT)
            output, _ = run.communicate(timeout=60)
            if run.returncode == 0:
                break
            self.assertEqual(run.returncode, 5, output)
            interrupts += 1
        self.assertGreater(interrupts, 0)
        parts = json.loads((self.folder / "parts" / "summary.json").read_text())
        whole = self.run_scene(SLICE, *arguments, out="whole")
        self.assertEqual((parts["steps"], parts["state_hash"]), (whole["steps"], whole["state_hash"]))

    def test_going_on_keeps_stress_and_load(self):
        once = self.run_slice("--set", "removal.max_stages=2", "--set", "removal.next=continue")["stage"]
        anew = self.run_slice("--set", "removal.max_stages=2")["stage"]
        self.assertEqual(once[0]["failed"], anew[0]["failed"])
        # No second ramp; and what has yielded stays so.
        self.assertLess(once[1]["last_step"] - once[1]["first_step"], anew[1]["last_step"] - anew[1]["first_step"])
        self.assertGreater(once[1]["failed"], once[0]["failed"])

    def test_a_stage_that_finds_no_rest_says_so(self):
        done = vsb("run", SLICE, "--out", self.folder / "n", "--set", "time.until_static.max_steps=2500", "--set",
                   "time.until_static.force_ratio=1e-12", "--set", "removal.settled=0")
        self.assertEqual(done.returncode, 0, done.stderr)
        removal = json.loads((self.folder / "n" / "summary.json").read_text())["removal"]
        self.assertEqual(removal["outcome"], "collapse")
        self.assertRegex(removal["reason"], r"stage 1 found no rest within max_steps = 2500 \(force ratio .*; \d.* % of the particles")

    def test_a_share_of_failed_particles_ends_a_stage(self):
        removal = self.run_slice("--set", "removal.collapse=0.02")
        self.assertEqual((removal["outcome"], len(removal["stage"])), ("collapse", 2))
        last = removal["stage"][-1]
        self.assertTrue(0.02 <= last["failed"] / last["particles"] < 0.03)  # found on the way, not at rest
        self.assertFalse(last["at_rest"])
        self.assertRegex(removal["reason"], r"^2\.\d+ % of the particles that were left are beyond the threshold$")

    def test_divergence_of_a_body_that_has_not_failed_is_no_collapse(self):
        done = vsb("run", SLICE, "--out", self.folder / "d", "--set", "time.kappa=1.9", "--set", "traction[0].time.smooth_ramp_steps=20",
                   "--set", "removal.threshold=1e6")
        self.assertEqual(done.returncode, 3, done.stdout + done.stderr)
        self.assertRegex(done.stderr, r"diverged at step \d+")

    def test_the_resolved_scene_reads_back_to_itself(self):
        for arguments in ((), ("--set", "removal.next=continue"), ("--set", "removal.damping=0.3", "--set", "removal.next=continue")):
            first = vsb("check", SLICE, *arguments)
            self.assertEqual(first.returncode, 0, first.stderr)
            resolved = "\n".join(line for line in first.stdout.splitlines() if not line.startswith("# "))
            again = vsb("check", self.write(resolved, "wellbore-slice.toml"))
            self.assertEqual(again.returncode, 0, again.stderr)
            self.assertEqual(tomllib.loads(again.stdout), tomllib.loads(first.stdout))
            self.assertEqual(tomllib.loads(first.stdout)["removal"]["hole"]["row"], ROW)


class Refusals(ProgramTest):
    def refuse(self, *words, overrides):
        sets = [part for override in overrides for part in ("--set", override)]
        done = vsb("check", SLICE, *sets)
        self.assertEqual(done.returncode, 2, done.stdout)
        for word in words:
            self.assertIn(word, done.stderr)

    def test_values(self):
        for override, *words in (
                ("removal.threshold=0", "removal.threshold = 0", "> 0"),
                ("removal.threshold=nan", "removal.threshold = nan"),
                ("removal.measure=stress", "removal.measure", "equivalent_plastic_strain"),
                ("removal.remap=1", "removal.remap", "true or false"),
                ("removal.next=stop", "removal.next", "reset", "continue"),
                ("removal.damping=0.5", "removal.damping", 'next = "continue"'),
                ("removal.max_stages=0", "removal.max_stages = 0", "from 1 to 1000"),
                ("removal.settled=-1", "removal.settled = -1", "from 0 to"),
                ("removal.collapse=1.5", "removal.collapse = 1.5", "> 0 and <= 1"),
                ("removal.tresh=1", "unknown key 'tresh' in removal"),
                ("removal.hole.radius=-1", "removal.hole.radius = -1", "> 0"),
                ("removal.hole.row=0", "removal.hole.row = 0", "> 0"),
                ("removal.hole.center=[0.0]", "removal.hole.center", "2"),
                ("removal.hole.axis=z", "unknown key 'axis' in removal.hole"),
                ("removal={}", "removal.threshold is missing", "> 0"),
                ("removal={threshold=0.1,hole={radius=1.0}}", "removal.hole.center is missing")):
            self.refuse(*words, overrides=[override])
        self.refuse("removal.damping = 1.5", overrides=["removal.next=continue", "removal.damping=1.5"])

    def test_scenes_that_cannot(self):
        self.refuse("removal", "needs time.until_static", overrides=["time={kappa=0.5,steps=10}"])
        self.refuse("removal", "plastic material", overrides=["body[0].material={youngs_modulus=1e9,poisson_ratio=0.2}"])
        self.refuse("removal", "void_filter", overrides=["method.void_filter=true"])
        for imposition in ("boundary_particles", "material_points", "nodal"):
            self.refuse("removal", "'pressure in the hole'", overrides=[f"traction[0].imposition={imposition}"])


if __name__ == "__main__":
    unittest.main()
