# SPDX-License-Identifier: BSD-3-Clause
"""Studies of scenes without an exact solution: figures that are drawn and judged, rates and extrapolated values."""
import csv
import json
import math
import unittest

from study_test import StudyTest
from vsb_program import last_fields, vsb

# The pressurised cylinder as a scene that nobody has a solution of.
STUDY = """\
title = "A cylinder without its solution"
scene = "SCENES/cylinder.toml"
set = ["compare=", "published=", "setting=accurate"]
static = true
axis = { name = "h", unit = "m", log = true }
[[series]]
name = "accurate"
sweep = "grid.spacing"
case = [{ axis = 0.5 }, { axis = 0.25 }, { axis = 0.125 }]
"""
FIGURES = ["largest_displacement", "strain_energy", "largest_von_mises"]


class Convergence(StudyTest):
    def test_a_study_over_the_spacing(self):
        done, table = self.study(STUDY)
        self.assertEqual([row["figure"] for row in table], 3 * FIGURES)
        for figure in FIGURES:
            coarse, middle, fine = (self.line(table, h, figure) for h in ("0.5", "0.25", "0.125"))
            f = [float(row["value"]) for row in (coarse, middle, fine)]
            self.assertEqual((coarse["difference"], coarse["rate"], middle["rate"], middle["extrapolated"]), ("", "", "", ""))
            self.assertEqual(float(middle["difference"]), f[1] - f[0])
            self.assertEqual(float(fine["difference"]), f[2] - f[1])
            ratio = (f[1] - f[0]) / (f[2] - f[1])
            if ratio > 1:
                self.assertAlmostEqual(float(fine["rate"]), math.log2(ratio), delta=1e-6)
                self.assertAlmostEqual(float(fine["extrapolated"]), f[2] + (f[2] - f[1]) / (ratio - 1), delta=1e-6 * abs(f[2]))
            else:
                self.assertEqual(fine["rate"] + fine["extrapolated"], "")
                self.assertIn("no rate", fine["note"])
        # The work of the pressure is twice the strain energy: p u(a) a pi / 4 / 2 for the quarter, by hand.
        E, nu, a, b, p = 1e9, 0.2, 1.0, 5.0, 1e5
        fine = self.line(table, "0.125", "strain_energy")
        u = (1 + nu) * p * a**2 / (E * (b**2 - a**2)) * ((1 - 2 * nu) * a + b**2 / a)
        self.assertAlmostEqual(float(fine["value"]) / (p * u * a * math.pi / 4), 1, delta=5e-3)
        self.assertRegex(done.stdout, r"strain_energy +\S+ .*difference +\S+")
        about = json.loads((self.folder / "out" / "mine.json").read_text())
        self.assertEqual((about["errors"], about["chart"]["figures"], about["chart"]["log"]), ([], FIGURES, False))
        self.assertGreater((self.folder / "out" / "mine_figures.png").stat().st_size, 10_000)
        self.assertFalse((self.folder / "out" / "mine_errors.png").exists())

    def test_figures_of_the_summary(self):
        """Against the frame: the largest displacement and the extreme stresses; of a body at speed, its kinetic energy."""
        scene = self.write("""
            dimension = 2
            setting = "paper"
            grid = { lower = [0.0, 0.0], upper = [4.0, 4.0], spacing = 0.5 }
            time = { kappa = 0.5, steps = 30 }
            [[body]]
            shape = { box = { lower = [1.0, 1.0], upper = [2.0, 2.0] } }
            particles_per_cell = 2
            density = 1000.0
            velocity = [0.3, 0.4]
            stress = [1e3, -2e3, 500.0, 700.0, 0.0, 0.0]
            material = { youngs_modulus = 1e6, poisson_ratio = 0.3 }
            [[body]]
            shape = { box = { lower = [2.5, 2.5], upper = [3.0, 3.0] } }
            particles_per_cell = 2
            density = 500.0
            material = { youngs_modulus = 2e6, poisson_ratio = 0.1 }
            """)
        start = self.run_scene(scene, "--set", "time.steps=1", "--set", "time.kappa=1e-9", out="start")
        self.assertAlmostEqual(start["kinetic_energy"], 0.5 * 1000 * 0.25, delta=1e-6)
        # s : C^-1 : s / 2 of the first body alone, by hand.
        squares, trace = 1e6 + 4e6 + 0.25e6 + 2 * 0.49e6, -500.0
        self.assertAlmostEqual(start["strain_energy"], 0.5 / 1e6 * (1.3 * squares - 0.3 * trace**2), delta=1e-6)
        middle, radius = -500.0, math.hypot(1500, 700)
        self.assertAlmostEqual(start["largest_principal_stress"], middle + radius, delta=1e-3)
        self.assertAlmostEqual(start["smallest_principal_stress"], middle - radius, delta=1e-3)
        self.assertAlmostEqual(start["largest_von_mises"], math.sqrt(1.5 * (squares - trace**2 / 3)), delta=1e-3)
        end = self.run_scene(scene, out="end")
        moved = last_fields(self.folder / "end")["displacement"]
        self.assertAlmostEqual(end["largest_displacement"] / max(math.hypot(*u) for u in moved), 1, delta=1e-12)
        screen = vsb("run", scene, "--out", self.folder / "x").stdout
        self.assertIn(f"of the particles: largest displacement {end['largest_displacement']:.4g} m", screen)
        self.assertRegex(screen, r"of the nodes: force ratio \S+, energy ratio \(kinetic to strain energy\) \S+\n")
        self.assertRegex(screen, r"kinetic energy \S+ J\n")

    def test_kinetic_energy_that_the_nodes_do_not_have_is_told(self):
        scene = self.write("""
            dimension = 1
            grid = { lower = [0.0], upper = [6.0], spacing = 1.0 }
            faces.x_min = "fixed"
            time = { kappa = 0.5, until_static = {} }
            method.damping = 0.3
            [[body]]
            shape = { box = { lower = [0.0], upper = [4.0] } }
            particles_per_cell = 4
            density = 1000.0
            velocity = { value = [0.0], dx = [1.0] }
            material = { youngs_modulus = 1e6, poisson_ratio = 0.3 }
            [[traction]]
            pressure = 1e3
            surface.box = { lower = [3.0], upper = [6.0] }
            """)
        done = vsb("run", scene, "--out", self.folder / "s")
        self.assertEqual(done.returncode, 0, done.stderr)
        summary = json.loads((self.folder / "s" / "summary.json").read_text())
        self.assertLess(summary["energy_ratio"], 1e-9)
        self.assertGreater(summary["kinetic_energy"], 1e-6 * summary["strain_energy"])
        self.assertRegex(done.stdout, r"kinetic energy \S+ J, in velocities that cancel at the nodes and move nothing\n")

    def test_plastic_strain_is_a_figure_of_bodies_that_yield(self):
        text = STUDY[:STUDY.index("case")].replace("static = true", "expect_static = false").replace("cylinder.toml", "yield-cylinder.toml")
        text = text.replace('"published=", ', "").replace("setting=accurate", "time.until_static.max_steps=200")
        _, table = self.study(text + "case = [{ axis = 0.5, expect = { largest_equivalent_plastic_strain = { lowest = 0 } } }]\n", out="plastic")
        self.assertEqual(self.line(table, "0.5", "largest_equivalent_plastic_strain")["verdict"], "pass")
        self.refuse(STUDY.replace("{ axis = 0.5 }", "{ axis = 0.5, expect = { largest_equivalent_plastic_strain = { lowest = 0 } } }"),
                    "no such figure")

    def test_figures_can_be_chosen_and_judged(self):
        chart = '[chart]\nfigures = ["net_force_x", "smallest_principal_stress", "largest_displacement"]\n'
        # About the origin the load has no torque, by symmetry; about the centre of mass it has that of its force, which acts
        # there. Shares of cut boxes are sampled, which puts the centre up to 1e-7 m off the diagonal: 0.01 N m of 1e5 N.
        judged = STUDY.replace("{ axis = 0.25 }", "{ axis = 0.25, expect = { net_torque_z = { lowest = -0.01, highest = 0.01 } } }")
        judged = judged.replace(", { axis = 0.125 }", "")
        done, table = self.study(judged + chart)
        line = self.line(table, "0.25", "net_torque_z")
        self.assertEqual(line["verdict"], "pass")
        summary = json.loads((self.folder / "out" / line["directory"] / "summary.json").read_text())
        (x, y, _), force = summary["torque_about"], summary["net_force"]
        self.assertLess(abs(x - y), 1e-7)
        self.assertAlmostEqual(float(line["value"]), y * force[0] - x * force[1], delta=1e-6)
        # Negative values do not show on the logarithmic scale that a chart has by default, and are drawn all the same.
        self.assertLess(float(self.line(table, "0.25", "smallest_principal_stress")["value"]), 0)
        self.assertIn("mine_figures.png", done.stdout)
        self.assertNotIn("no case has a figure to draw", done.stdout)

    def test_studies_that_could_have_no_figure_are_refused(self):
        self.refuse(STUDY + "[chart]\nfigures = []\n", "chart.figures = []", "must name a figure: one of", "largest_displacement")
        self.refuse(STUDY + "[chart]\nfigures = [\"e_rr\"]\n", "e_rr", line=11)
        self.refuse(STUDY + "[target]\nfigures = [\"e_rr\"]\nlevel = 0.1\n", "no scene of this study is compared with an exact solution")
        fine = STUDY.replace("0.5 }", "0.5, fine = true }").replace("0.25 }", "0.25, fine = true }").replace("0.125 }", "0.125, fine = true }")
        self.refuse(fine, "every case is marked fine; give --fine")
        # The only case that gives the figure is expected to fail.
        text = STUDY.replace("{ axis = 0.5 }", "{ axis = 0.5, static = false, balance = true, expect_failure = \"x\" }")
        self.refuse(text + "[chart]\nfigures = [\"net_force_share\"]\n", "chart.figures = [net_force_share]: no case that is run")
        self.refuse(STUDY.replace("{ axis = 0.5 }", "{ axis = 0.5, expect = {} }"), "expect = {}: must be a table of figures")


if __name__ == "__main__":
    unittest.main()
