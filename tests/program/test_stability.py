# SPDX-License-Identifier: BSD-3-Clause
"""Bodies under a virtual pressure at finite strain stay at rest; a run tells how fast a disturbance would grow; a share of PIC."""
import unittest

from vsb_program import SCENES, ProgramTest, vsb

E_TENTH = ("--set", "traction[0].radial_blend.inner.pressure=1e5", "--set", "compare.pressure=1e5")
# The body of the prototype that the rate of the paper's step is from: whole squares.
GROWTH = ("--set", "body[0].boundary=keep", "--set", "body[0].particles_per_cell=3", "--set", "time.kappa=0.8", "--set", "time.steps=1500", "--set", "method.damping=0.8", "--set", "growth.time=1.0")


class Stability(ProgramTest):
    def run_tube(self, *arguments, out="tube"):
        return self.run_scene("tube", *arguments, out=out)

    def test_tube_at_rest(self):
        summary = self.run_tube(*E_TENTH, "--set", "method.damping=0.1")
        self.assertAlmostEqual(summary["compared"]["hole_ratio"], 1, delta=0.01)
        self.assertLess(summary["energy_ratio"], 1e-5)
        self.assertAlmostEqual(summary["net_force"][0] / 129235.5, 1, delta=0.005)  # p times the hole as it is

    def test_growth_by_the_paper_step_alone(self):
        paper = self.run_tube(*E_TENTH, *GROWTH, "--set", "method.position_velocity=grid")
        self.assertGreater(paper["growth_rate"], 8)  # 16.7 by an independent prototype
        self.assertLess(paper["growth_rate"], 20)
        for engine in ("cell_lanes", "particles"):
            ours = self.run_tube(*E_TENTH, *GROWTH, "--set", f"method.engine={engine}", out=engine)
            self.assertLess(abs(ours["growth_rate"]), 0.2)

    def test_setting_paper_takes_the_paper_step(self):
        text = (SCENES / "tube.toml").read_text()
        for setting, velocity in (("", "strain"), ('setting = "paper"\n', "grid"), ('setting = "accurate"\n', "strain")):
            resolved = vsb("check", self.write(setting + text)).stdout
            self.assertIn(f"position_velocity = '{velocity}'", resolved)

    def test_the_paper_step_is_told(self):
        told = "feeds energy"
        for arguments, expected in (((), False), (("--set", "method.position_velocity=grid"), True),
                                    (("--set", "method.position_velocity=grid", "--set", "method.damping=0.2"), False),
                                    (("--set", "method.position_velocity=grid", "--set", "time.steps=100"), False)):
            with self.subTest(arguments=arguments):
                done = vsb("check", SCENES / "tube.toml", *arguments)
                self.assertEqual(told in done.stderr, expected, done.stderr)

    def test_pic_takes_the_particles_own_vibrations(self):
        flip, mixed = (self.run_tube("--set", "time.steps=6000", "--set", f"method.pic={pic}", out=f"pic{pic}")
                       for pic in (0, 0.004))
        self.assertLess(mixed["kinetic_energy"], 0.1 * flip["kinetic_energy"])
        self.assertAlmostEqual(mixed["compared"]["hole_ratio"] / flip["compared"]["hole_ratio"], 1, delta=0.01)

    def test_mistakes(self):
        for setting, words in (
                (("method.pic=0.01", "method.position_velocity=grid"), "method.pic"),
                (("method.pic=1",), "method.pic = 1"),
                (("growth.time=0",), "growth.time = 0"),
                (("growth.time=0.01",), "growth.time = 0.01"),
                (("growth.time=1e30",), "growth.time = 1e+30"),
                (("growth.time=1", "faces.x_max=outflow"), "growth"),
                (("growth.time=1", "precision=float", "method.basis=linear"), "growth"),
                (("compare.pressure=1e6",), "compare.pressure"),
                (('body[0].material.law="linear_elastic"',), "compare.solution")):
            with self.subTest(setting=setting):
                arguments = [word for s in setting for word in ("--set", s)]
                done = vsb("check", SCENES / "tube.toml", *arguments)
                self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
                self.assertIn(words, done.stderr)


    def test_growth_is_of_steps(self):
        done = vsb("run", SCENES / "tube.toml", "--static", "--set", "growth.time=1.0", "--out", self.folder / "s")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("[growth]", done.stderr)


if __name__ == "__main__":
    unittest.main()
