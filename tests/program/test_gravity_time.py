# SPDX-License-Identifier: BSD-3-Clause
"""Gravity that varies in time (gravity_time): what bodies feel, where runs end, what goes on where it stopped."""
import math
import re
import unittest

import numpy as np
from vsb_program import ProgramTest, last_fields, vsb

ENGINES = ("cell_lanes", "particles")
GRAVITY = -9.81

FALL = """\
dimension = {dimension}
gravity = {gravity}
gravity_time = {{ {time} }}
grid = {{ lower = {lower}, upper = {upper}, spacing = 1.0 }}
time = {{ dt = 0.01, steps = 60 }}
method.engine = "{engine}"
[[body]]
shape = {{ box = {{ lower = {low}, upper = {high} }} }}
particles_per_cell = 2
density = 2000.0
material = {{ youngs_modulus = 1e6, poisson_ratio = 0.3 }}
"""

# A column of 4 m on smooth ground, which bears 100 kPa and weighs 78 kPa: at rest its top has sunk by rho g H^2 / 2 E.
COLUMN = f"""\
dimension = 2
gravity = [0.0, {GRAVITY}]
gravity_time = {{ smooth_ramp = 2.5 }}
grid = {{ lower = [0.0, 0.0], upper = [3.0, 5.0], spacing = 0.5 }}
faces = {{ x_min = "roller", y_min = "roller" }}
method = {{ damping = 0.1 }}
time = {{ kappa = 0.5, until_static = {{}} }}
[[body]]
shape = {{ box = {{ lower = [0.0, 0.0], upper = [2.0, 4.0] }} }}
particles_per_cell = 2
density = 2000.0
material = {{ law = "von_mises", yield_stress = 100e3, youngs_modulus = 1e7, poisson_ratio = 0.0 }}
"""
SUNK = 2000 * -GRAVITY * 4**2 / 2 / 1e7
ELASTIC = ("--set", "body[0].material={ youngs_modulus = 1e7, poisson_ratio = 0.0 }")
STEPS = ("--set", "time={ kappa = 0.5, steps = 60 }")


def smooth(s):
    return s**3 * (10 - 15 * s + 6 * s**2) if s < 1 else 1.0


# How gravity_time is written, and its factor at the time t.
SHAPES = {
    "ramp = 0.4": lambda t: min(t / 0.4, 1),
    "ramp_steps = 40": lambda t: min(t / 0.4, 1),
    "smooth_ramp = 0.4": lambda t: smooth(t / 0.4),
    "smooth_ramp_steps = 40": lambda t: smooth(t / 0.4),
    "step = 0.295": lambda t: float(t >= 0.295),
    "table = [[0.1, 0.5], [0.3, -1.0]]": lambda t: np.interp(t, [0.1, 0.3], [0.5, -1.0]),
    "sine = { period = 0.3, mean = 1.0, amplitude = 0.5 }": lambda t: 1 + 0.5 * math.sin(2 * math.pi * t / 0.3),
}


class GravityTime(ProgramTest):
    def check(self, *arguments, text=COLUMN):
        return vsb("check", self.write(text), "--threads", 1, *arguments)

    def sunk(self, *arguments, **how):
        summary = self.run_scene(self.write(how.pop("text", COLUMN)), "--threads", 1, *arguments, **how)
        return -last_fields(self.folder / how.get("out", "scene"))["displacement"][:, 1].min(), summary

    def test_a_body_falls_as_fast_as_gravity_says(self):
        for time, factor in SHAPES.items():
            for dimension in (1, 2, 3) if time.startswith("smooth_ramp =") else (1,):
                for engine in ENGINES:
                    vector = lambda x: "[" + ", ".join([str(x)] * dimension) + "]"
                    self.run_scene(self.write(FALL.format(dimension=dimension, gravity=vector(GRAVITY), time=time, engine=engine,
                                                          lower=vector(-4.0), upper=vector(4.0), low=vector(0.0), high=vector(2.0))),
                                   "--threads", 1)
                    velocity = last_fields(self.folder / "scene")["velocity"][:, :dimension]
                    expected = GRAVITY * 0.01 * sum(factor(0.01 * n) for n in range(1, 61))
                    np.testing.assert_allclose(velocity, expected, rtol=1e-11, err_msg=f"{time} {dimension} {engine}")

    def test_a_plastic_column_does_not_yield_under_weight_that_grows(self):
        for engine in ENGINES:
            slow, summary = self.sunk("--set", f"method.engine={engine}")
            self.assertTrue(summary["static"])
            self.assertGreaterEqual(summary["time"], 2.5)
            # Its particles' mean over a cell is the exact mean; the top particle lies h / 4 below the top.
            self.assertAlmostEqual(slow / SUNK, 1, delta=0.01, msg=engine)
            self.assertEqual(last_fields(self.folder / "scene")["equivalent_plastic_strain"].max(), 0)
            sudden, summary = self.sunk("--set", f"method.engine={engine}", "--set", "gravity_time=")
            self.assertGreater(sudden, 1.2 * SUNK)

    def test_both_engines_make_the_same_steps(self):
        for basis in ("linear", "quadratic_bspline"):
            fields = []
            for engine in ENGINES:
                self.sunk(*STEPS, "--set", f"method.engine={engine}", "--set", f"method.basis={basis}", "--set", "method.damping=0",
                          "--set", "gravity_time={ ramp = 0.3 }")
                fields.append(last_fields(self.folder / "scene"))
            for name in ("velocity", "cauchy_stress", "displacement"):
                largest = np.abs(fields[0][name]).max()
                self.assertGreater(largest, 0)
                np.testing.assert_allclose(fields[0][name], fields[1][name], rtol=0, atol=1e-10 * largest, err_msg=f"{basis} {name}")

    def test_half_way_it_goes_on_with_the_same_bits(self):
        for engine in ENGINES:
            of_engine = ("--set", f"method.engine={engine}", "--set", "gravity_time={ ramp_steps = 100 }")
            steps = lambda n: ("--set", f"time={{ kappa = 0.5, steps = {n} }}")
            whole = self.sunk(*of_engine, *steps(120), out=f"whole-{engine}")[1]
            self.sunk(*of_engine, *steps(47), out=f"parts-{engine}")
            parts = self.sunk(*of_engine, *steps(120), "--resume", out=f"parts-{engine}")[1]
            self.assertEqual((parts["state_hash"], parts["steps"]), (whole["state_hash"], 120), engine)
            self.assertNotEqual(parts["state_hash"], self.sunk(*of_engine, *steps(120), "--set", "gravity_time=")[1]["state_hash"])
            done = vsb("run", self.folder / "scene.toml", *of_engine, *steps(130), "--resume", "--out", self.folder / f"parts-{engine}",
                       "--set", "gravity_time={ ramp_steps = 101 }")
            self.assertEqual(done.returncode, 4)
            self.assertIn("gravity_time.ramp_steps", done.stderr)

    def test_a_static_solution_is_that_of_the_final_value(self):
        full = self.sunk(*ELASTIC, "--static", "--set", "gravity_time=")
        for time, share in (("{ smooth_ramp = 7.0 }", 1), ("{ table = [[0.0, 1.0], [1.0, 0.5]] }", 0.5)):
            sunk, summary = self.sunk(*ELASTIC, "--static", "--set", f"gravity_time={time}")
            self.assertAlmostEqual(sunk / full[0], share, delta=1e-9)
        self.assertAlmostEqual(full[0] / SUNK, 1, delta=0.01)

    def test_a_run_until_static_waits_for_it(self):
        late = ("--set", "gravity_time={ table = [[0.0, 0.0], [1.0, 0.0], [1.2, 1.0]] }")
        for engine in ENGINES:
            sunk, summary = self.sunk(*ELASTIC, *late, "--set", f"method.engine={engine}")
            self.assertTrue(summary["static"] and summary["time"] > 1.2)
            self.assertAlmostEqual(sunk / SUNK, 1, delta=0.01)
        self.assertIn("loads constant from 1.2 s on", self.check(*late).stdout)

    def test_what_holds_a_body_is_asked_under_its_final_weight(self):
        told = "no support takes up a force"
        self.assertNotIn(told, self.check().stderr)
        self.assertIn(told, self.check("--set", "faces={}").stderr)
        self.assertIn(told, self.check("--set", "faces={}", "--set", "gravity_time={ step = 5.0 }").stderr)

    def test_sudden_weight_is_told_with_the_key_that_helps(self):
        warning = self.check("--set", "gravity_time=").stderr
        self.assertIn("gravity acts in full from the first step on, which loads body 'body 1'", warning)
        slow = re.search(r"gravity_time\.smooth_ramp = ([\d.e+-]+) s", warning)[1]
        told = lambda time: "which loads body" in self.check("--set", f"gravity_time={time}").stderr
        self.assertFalse(told(f"{{ smooth_ramp = {slow} }}"))
        self.assertFalse(told("{ table = [[0.0, 0.0], [3.0, 1.0]] }"))
        for sudden in ("{ ramp = 0.5 }", "{ step = 1.0 }", "{ ramp_steps = 10 }", "{ table = [[0.0, 0.5], [9.0, 1.0]] }",
                       "{ table = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]] }", "{ ramp = 0.0 }"):
            self.assertTrue(told(sudden), sudden)

    def test_bad_input(self):
        for time, words in (("{}", ("gravity_time = {}", "one of ramp")), ("{ ramp = -1 }", ("gravity_time.ramp = -1", ">= 0")),
                            ("{ rampe = 1 }", ("unknown key 'rampe' in gravity_time", "did you mean 'ramp'?")),
                            ("{ ramp = 1, step = 1 }", ("gravity_time.", "give one of ramp")),
                            ("{ sine = { period = 0.0 } }", ("gravity_time.sine.period = 0", "> 0")),
                            ("{ sine = { period = 1.0 } }", ("time.until_static", "gravity is a sine, which never settles")),
                            ("{ table = [[0.0, 1.0], [1.0, 0.0]] }", ())):
            done = self.check("--set", f"gravity_time={time}")
            self.assertEqual(done.returncode, 2 if words else 0, time)  # plastic bodies may stay under stress
            for word in words:
                self.assertIn(word, done.stderr)
        still = self.check("--set", "gravity=[0.0, 0.0]")
        self.assertEqual(still.returncode, 2)
        self.assertIn("scene.toml:3:", still.stderr)
        self.assertIn("varies a gravity of 0", still.stderr)
        ends = self.check(*ELASTIC, "--set", "gravity_time={ table = [[0.0, 1.0], [1.0, 0.0]] }")
        self.assertEqual(ends.returncode, 2)
        self.assertIn("every load ends at 0", ends.stderr)
        static = vsb("run", self.write(COLUMN), *ELASTIC, *STEPS, "--static", "--set", "gravity_time={ sine = { period = 1.0 } }",
                     "--out", self.folder / "none")
        self.assertEqual(static.returncode, 2)
        self.assertIn("--static: gravity is a sine", static.stderr)
        short = self.check(*STEPS)
        self.assertRegex(short.stderr, r"gravity is at [\d.e-]+ % of its final value at the last possible step: .* gravity_time is "
                                       "constant from 2.5 s on")


if __name__ == "__main__":
    unittest.main()
