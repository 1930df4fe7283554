# SPDX-License-Identifier: BSD-3-Clause
"""Near incompressibility: errors with the mean divergence are those at a Poisson ratio of 0.2, and who gets it."""
import unittest

import numpy as np

from vsb_program import SCENES, ProgramTest, last_fields, vsb

RATIO = "body[0].material.poisson_ratio={}"
ACCURATE = ('setting="accurate"', 'method.basis="quadratic_bspline"', 'body[0].boundary="cut2x2"',
            "body[0].particles_per_cell=2")


def given(*pairs):
    return [argument for pair in pairs for argument in ("--set", pair)]


class Locking(ProgramTest):
    def errors(self, scene, ratio, *pairs):
        return self.run_scene(scene, "--static", *given(RATIO.format(ratio), *pairs))["errors"]

    def test_cylinder(self):
        """Its mean stress is the same everywhere, so that any mean will do."""
        for scene, e_rr, e_tt in (("cylinder", 0.018, 0.021), ("cylinder-accurate", 0.0025, 0.0033)):
            errors = self.errors(scene, 0.499)
            self.assertLess(errors["e_rr"], e_rr)
            self.assertLess(errors["e_tt"], e_tt)

    def test_ellipse(self):
        """Its mean stress varies: means over whole cells would be many times too inaccurate for B-splines."""
        plate = ("grid.spacing=1.0", "traction[1].exact_ellipse.far_ratio=2.0", "compare.far_ratio=2.0")
        for setting in ((), ACCURATE):
            soft, stiff = (self.errors("ellipse-exact", ratio, *plate, *setting) for ratio in (0.2, 0.499))
            for name, error in stiff.items():
                self.assertLess(error, 1.5 * soft[name], (name, setting))

    def test_steps_go_where_the_static_solution_is(self):
        few = given(RATIO.format(0.49), "grid.spacing=0.5", "body[0].particles_per_cell=2", "method.damping=0.4",
                    "time.kappa=0.8")
        for scene, digits in (("cylinder", 3e-3), ("cylinder-accurate", 2e-2)):
            steps, static = self.run_scene(scene, *few), self.run_scene(scene, "--static", *few, out="static")
            for name in ("e_rr", "e_tt"):
                self.assertAlmostEqual(steps["errors"][name], static["errors"][name], delta=digits * static["errors"][name])

    def test_bodies_that_share_cells(self):
        """Two rings of one material, one in the other, that meet within cells: one mean, on both engines."""
        text = (SCENES / "cylinder.toml").read_text()
        inner = text[text.index("[[body]]"):text.index("[[traction]]")]
        outer = inner.replace('"ring"', '"outer ring"').replace("radius = 1.0", "radius = 3.1")
        scene = self.folder / "rings.toml"
        scene.write_text(text.replace(inner, inner.replace("radius = 5.0", "radius = 3.1") + outer))
        stiff = given(RATIO.format(0.49), "body[1].material.poisson_ratio=0.49", "method.damping=0", "time.until_static.max_steps=100")
        fields = {}
        for engine in ("cell_lanes", "particles"):
            out = self.folder / engine
            done = vsb("run", scene, *stiff, "--set", f"method.engine={engine}", "--out", out)
            self.assertIn(done.returncode, (0, 7), done.stderr)
            fields[engine] = last_fields(out)
        for name in ("position", "velocity", "cauchy_stress", "volume"):
            lanes, particles = (fields[engine][name] for engine in ("cell_lanes", "particles"))
            self.assertGreater(len(particles), 1000)
            np.testing.assert_allclose(lanes, particles, rtol=0, atol=1e-12 * np.abs(particles).max(), err_msg=name)

    def test_round_off_does_not_choose(self):
        """Along a straight surface functions of little volume have neighbours that are equal but for round-off."""
        text = """
            dimension = 2
            grid = {{ lower = [{0}, 0.0], upper = [{1}, 1.0], spacing = 0.1 }}
            faces = {{ x_min = "fixed", x_max = "roller", y_min = "roller" }}
            method.basis = "quadratic_bspline"
            time = {{ kappa = 0.4, steps = 1 }}
            [[body]]
            particles_per_cell = 4
            density = 1000.0
            velocity = [1.0, 0.0]
            shape.box = {{ lower = [{0}, 0.0], upper = [{1}, 0.575] }}
            material = {{ youngs_modulus = 1e6, poisson_ratio = 0.49 }}
            """
        stress = []
        for lower in (0.0, -0.7):
            for engine in ("cell_lanes", "particles"):
                out = self.folder / f"{engine}{lower}"
                scene = self.write(text.format(lower, lower + 1))
                done = vsb("run", scene, "--set", f"method.engine={engine}", "--out", out)
                self.assertEqual(done.returncode, 0, done.stderr)
                stress.append(last_fields(out)["cauchy_stress"])
        largest = np.abs(stress[0]).max()
        for other in stress[1:]:
            np.testing.assert_allclose(other, stress[0], rtol=0, atol=1e-11 * largest)
        self.assertGreater(largest, 1e4)

    def said(self, *pairs):
        done = vsb("check", SCENES / "cylinder.toml", *given("grid.spacing=0.5", *pairs))
        self.assertEqual(done.returncode, 0, done.stderr)
        return done

    def test_who_averages(self):
        for ratio, choice in ((0.39, "full"), (0.4, "averaged")):
            done = self.said(RATIO.format(ratio))
            self.assertIn(f"volumetric = '{choice}'", done.stdout)
            self.assertNotIn("lock", done.stderr)
        self.assertIn("body 'ring' has poisson_ratio = 0.45 and method.volumetric = \"full\"",
                      self.said(RATIO.format(0.45), 'method.volumetric="full"').stderr)
        self.assertNotIn("lock", self.said('method.volumetric="full"').stderr)
        ugimp = self.said(RATIO.format(0.45), 'method.basis="ugimp"')
        self.assertIn("volumetric = 'full'", ugimp.stdout)
        self.assertIn("lock", ugimp.stderr)

    def test_where_nothing_is_averaged(self):
        for scene, pairs, why in (("column", (), "in 1D nothing locks"),
                                  ("cylinder", ('method.basis="ugimp"',), "is for basis =")):
            done = vsb("run", SCENES / f"{scene}.toml", "--out", self.folder / "refused",
                       *given('method.volumetric="averaged"', *pairs))
            self.assertEqual(done.returncode, 2)
            self.assertIn("method.volumetric", done.stderr)
            self.assertIn(why, done.stderr)


if __name__ == "__main__":
    unittest.main()
