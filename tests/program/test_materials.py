# SPDX-License-Identifier: BSD-3-Clause
"""Hencky elasticity and the void filter as a scene says them: errors, checkpoints, what is refused."""
import math
import unittest

import numpy as np
from vsb_program import SCENES, ProgramTest, last_fields, vsb

HENCKY = ("--set", "body[0].material.law=hencky")
# The cylinder with gaps between its rings, on the coarsest grid that shows them.
GAPS = ("--set", "grid.spacing=0.5", "--set", "body[0].lattice.concentric.rings=8", "--set",
        "body[0].lattice.concentric.per_ring=9")


class Refusals(ProgramTest):
    def refused(self, scene, *words, extra=()):
        out = self.folder / "results"
        done = vsb("run", SCENES / f"{scene}.toml", "--out", out, *extra)
        self.assertEqual(done.returncode, 2, done.stderr + done.stdout)
        for word in words:
            self.assertIn(word, done.stderr)
        self.assertFalse(out.exists())

    def test_an_unknown_law(self):
        self.refused("column", "body[0].material.law", "henky", "'linear_elastic', 'hencky'",
                     extra=("--set", "body[0].material.law=henky"))

    def test_an_initial_stress_that_no_deformation_gives(self):
        self.refused("column", "body[0].stress", "starts undeformed", extra=(*HENCKY, "--set", "body[0].stress=[1,0,0,0,0,0]"))
        self.run_scene("column", *HENCKY, "--set", "body[0].stress=[0,0,0,0,0,0]", "--set", "time.steps=1")

    def test_a_volume_that_is_not_that_of_the_deformation(self):
        self.refused("column", "method.volume_update", "J = det F", extra=(*HENCKY, "--set", "method.volume_update=exponential"))

    def test_a_filter_that_is_no_boolean(self):
        for value in ("1", "yes"):
            self.refused("column", "method.void_filter", extra=("--set", f"method.void_filter={value}"))

    def test_tractions_without_an_exact_solution(self):
        # sigma = M ln(l) / l has its largest value, M / e, at l = e.
        limit = 1e3 / math.e
        self.refused("column", "compare.traction", ">= -367.879", extra=(*HENCKY, "--set", f"compare.traction={-1.001 * limit}"))
        self.run_scene("column", *HENCKY, "--set", f"compare.traction={-0.999 * limit}", "--set", "time.steps=1")
        self.refused("column", "compare.traction", "must not be 0", extra=("--set", "compare.traction=0"))

    def test_the_resolved_scene_names_the_law_and_the_filter(self):
        done = vsb("check", SCENES / "column.toml", *HENCKY, "--set", "method.void_filter=true")
        self.assertIn("law = 'hencky'", done.stdout)
        self.assertIn("void_filter = true", done.stdout)


class LargeStrain(ProgramTest):
    def test_the_column_against_the_solution_of_its_law(self):
        # Half of E in compression: the rate form gives a stretch of exp(-0.5); Hencky's law l with E ln(l) / l = -E / 2.
        load = ("--set", "traction[0].pressure=500", "--set", "compare.traction=500")
        roots = {"linear_elastic": math.exp(-0.5), "hencky": 0.7034674224983917}  # the second: exp(-W(1/2))
        self.assertAlmostEqual(math.log(roots["hencky"]) / roots["hencky"], -0.5, delta=1e-12)
        for law, volume_update in (("linear_elastic", "exponential"), ("hencky", "determinant")):
            summary = self.run_scene("column-large-strain", *load, "--set", f"body[0].material.law={law}", "--set",
                                     f"method.volume_update={volume_update}", "--set", "time.steps=1")
            self.assertEqual(set(summary["errors"]), {"e_u_exact", "e_sigma"})  # (A1) is for small strain
            fields = last_fields(self.folder / "column-large-strain")
            start = fields["position"][:, 0] - fields["displacement"][:, 0]
            np.testing.assert_allclose(fields["exact_displacement"][:, 0], (roots[law] - 1) * start, rtol=1e-9)
            np.testing.assert_allclose(fields["exact_cauchy_stress"][:, 0], -500, rtol=1e-12)

    def test_the_patch_in_one_two_and_three_dimensions(self):
        for scene in ("column", "column-2d", "column-3d"):
            errors = self.run_scene(scene, *HENCKY)["errors"]
            self.assertNotIn("e_u", errors)  # (A1) is for the other law
            self.assertLess(errors["e_sigma"], 1e-13)
            self.assertLess(errors["e_u_exact"], 1e-10)

    def test_what_is_left_of_the_displacement_is_first_order_in_the_ramp(self):
        # Particles move with the velocity before the re-map, and strain with that after it.
        error = {}
        for n in (10000, 20000):
            error[n] = self.run_scene("column", *HENCKY, "--set", "traction[0].time={smooth_ramp_steps=%d}" % n, "--set",
                                      f"time.steps={n + 10000}")["errors"]["e_u_exact"]
        self.assertLess(error[10000], 1e-10)
        self.assertAlmostEqual(error[20000] / error[10000], 0.5, delta=0.05)


class Bodies(ProgramTest):
    def test_only_bodies_with_a_state_have_one(self):
        # Three bodies far apart, the middle one of each law in turn: what each does must not depend on the others.
        body = """
            [[body]]
            shape = {{ box = {{ lower = [{0}.0], upper = [{1}.0] }} }}
            particles_per_cell = 2
            density = 1.0
            velocity = {{ value = [0.0], dx = [0.05] }}
            material = {{ youngs_modulus = 1.0, poisson_ratio = 0.0, law = "{2}" }}
            """
        def run(*laws):
            scene = self.write("dimension = 1\ngrid = { lower = [-20.0], upper = [20.0], spacing = 1.0 }\n"
                               "time = { kappa = 0.3, steps = 50 }\nmethod.engine = \"particles\"\n" +
                               "".join(body.format(3 * at, 3 * at + 2, law) for at, law in enumerate(laws, -1)))
            summary = self.run_scene(scene)
            return last_fields(self.folder / "scene")["cauchy_stress"][:, 0], summary["state_bytes"]
        linear, small = run("linear_elastic", "linear_elastic", "linear_elastic")
        hencky, large = run("hencky", "hencky", "hencky")
        mixed, middle = run("hencky", "linear_elastic", "hencky")
        self.assertFalse(np.array_equal(linear[:4], hencky[:4]))
        np.testing.assert_array_equal(mixed, np.concatenate([hencky[:4], linear[4:8], hencky[8:]]))
        self.assertEqual((small < middle, middle <= large), (True, True))


class VoidFilter(ProgramTest):
    def test_false_voids_are_not_loaded(self):
        on = self.run_scene("cylinder-voids", *GAPS, out="on")
        off = self.run_scene("cylinder-voids", *GAPS, "--set", "method.void_filter=false", out="off")
        self.assertGreater(on["void_filter"]["false_voids"], 5)
        self.assertNotIn("void_filter", off)
        self.assertEqual(on["boundary_nodes"] + on["void_filter"]["dropped_nodes"], off["boundary_nodes"])
        # A traction at all nodes has no boundary for voids to be kept from.
        everywhere = self.run_scene("cylinder", "--set", "method.void_filter=true", "--set",
                                    'traction=[{pressure=1e5,nodes="all"}]', "--set", "time.until_static.max_steps=1", out="all")
        self.assertEqual(everywhere["void_filter"], {"false_voids": 0, "dropped_nodes": 0})
        for error in ("e_rr", "e_tt"):
            self.assertLess(on["errors"][error] / off["errors"][error], 0.7)

    def test_the_effect_is_printed(self):
        done = vsb("run", SCENES / "cylinder-voids.toml", "--out", self.folder / "c", *GAPS, "--set",
                   "time.until_static.energy_ratio=0.9")
        self.assertRegex(done.stdout, r"void filter: \d+ false voids inside the bodies, \d+ boundary nodes dropped, \d+ left")

    def test_a_body_without_voids_has_the_same_bits(self):
        hashes = set()
        for value in ("true", "false"):
            self.run_scene("cylinder", "--set", f"method.void_filter={value}", "--set", "method.engine=particles",
                           "--set", "time.until_static.max_steps=300")
            fields = last_fields(self.folder / "cylinder")
            hashes.add((fields["position"].tobytes(), fields["cauchy_stress"].tobytes()))
        self.assertEqual(len(hashes), 1)


class Resuming(ProgramTest):
    def test_the_deformation_gradient_is_part_of_the_checkpoint(self):
        self.resume("column", *HENCKY, "--set", "time.steps=600000")

    def test_the_outside_is_part_of_the_checkpoint(self):
        # The ring is pushed over the grid, so that the voids of the start say nothing of those at the end.
        _, whole = self.resume("cylinder-voids", *GAPS, "--set", "faces.x_min=open", "--set", "faces.y_min=open", "--set",
                               "grid.upper=[12.0,12.0]", "--set", "grid.lower=[-2.0,-2.0]", "--set", "body[0].velocity=[0.4,0.3]",
                               "--set", "method.damping=0", "--set", "time.until_static.max_steps=12000",
                               "--set", "time.until_static.energy_ratio=1e-30", pause=0.08)
        self.assertGreater(whole["void_filter"]["false_voids"], 0)


if __name__ == "__main__":
    unittest.main()
