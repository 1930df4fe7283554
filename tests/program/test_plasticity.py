# SPDX-License-Identifier: BSD-3-Clause
"""Plastic materials as a scene says them: bad values, the yielding cylinder, fields, checkpoints, engines, what is refused."""
import math
import unittest

import numpy as np
from vsb_program import SCENES, ProgramTest, last_fields, vsb

SPACING = 0.0625  # of the particles of yield-cylinder
# Loaded to the same pressure in a hundredth of the time: particles have yielded after 150 steps.
SUDDEN = ("--set", "traction[0].time={smooth_ramp=0.0005}", "--set", "time.until_static.max_steps=150", "--set",
          "method.damping=0")

BODY = """\
dimension = {dimension}
grid = {{ lower = {lower}, upper = {upper}, spacing = 1.0 }}
time = {{ kappa = 0.3, steps = {steps} }}
method.engine = "{engine}"
"""
BLOCK = """
[[body]]
shape = {{ box = {{ lower = [{0}.0], upper = [{1}.0] }} }}
particles_per_cell = 2
density = 1.0
velocity = {{ value = [0.0], dx = [0.03] }}
material = {{ youngs_modulus = 1.0, poisson_ratio = 0.2, {2} }}
"""
MOHR_COULOMB = 'law = "mohr_coulomb", cohesion = 0.002, friction_angle = 30.0, tensile_strength = 0.002'
LAWS = {
    "linear_elastic": 'law = "linear_elastic"',
    "mohr_coulomb": MOHR_COULOMB,
    "tresca": 'law = "tresca", cohesion = 0.002',
    "drucker_prager": 'law = "drucker_prager", cohesion = 0.002, friction_angle = 30.0, hardening_modulus = 0.1',
    "von_mises": 'law = "von_mises", yield_stress = 0.004, hardening_modulus = 0.1',
}


def scene_of(*materials, engine="auto", steps=20):
    head = BODY.format(dimension=1, lower="[-20.0]", upper="[20.0]", steps=steps, engine=engine)
    return head + "".join(BLOCK.format(3 * at, 3 * at + 2, m) for at, m in enumerate(materials, -1))


class Values(ProgramTest):
    def refused(self, material, *words):
        done = vsb("run", self.write(scene_of(material)), "--out", self.folder / "results")
        self.assertEqual(done.returncode, 2, done.stderr + done.stdout)
        for word in words:
            self.assertIn(word, done.stderr)
        self.assertFalse((self.folder / "results").exists())

    def test_ranges(self):
        rock = 'law = "mohr_coulomb", cohesion = {}, friction_angle = {}'
        self.refused(rock.format(-1.0, 30.0), "body[0].material.cohesion = -1", ">= 0")
        self.refused(rock.format(1.0, 90.0), "body[0].material.friction_angle = 90", ">= 0 and < 90")
        self.refused(rock.format(1.0, -3.0), "body[0].material.friction_angle = -3", ">= 0 and < 90")
        self.refused(rock.format(0.0, 0.0), "body[0].material.cohesion", "must not be 0 where friction_angle is")
        self.refused(rock.format(1.0, 30.0) + ", dilation_angle = 31.0", "dilation_angle = 31", ">= 0 and <= 30")
        self.refused(rock.format(1.0, 45.0) + ", tensile_strength = 1.1", "tensile_strength = 1.1", ">= 0 and <= 1")
        self.refused(rock.format(1.0, 30.0) + ", tensile_strength = -1", "tensile_strength = -1")
        self.refused('law = "tresca", cohesion = 0.0', "cohesion = 0", "> 0")
        self.refused('law = "tresca", cohesion = 1.0, tensile_strength = inf', "tensile_strength = inf")
        self.refused('law = "drucker_prager", cohesion = 1.0, friction_angle = 30.0, cone = "middle"', "cone", "middle",
                     "'outer', 'inner', 'plane_strain'")
        self.refused('law = "drucker_prager", cohesion = 1.0, friction_angle = 30.0, hardening_modulus = -1.0',
                     "hardening_modulus = -1", ">= 0")
        self.refused('law = "von_mises", yield_stress = 0.0', "yield_stress = 0", "> 0")
        self.refused('law = "von_mises", yield_stress = "high"', "yield_stress", "a string")

    def test_missing_and_foreign_keys(self):
        self.refused('law = "mohr_coulomb", cohesion = 1.0', "friction_angle is missing")
        self.refused('law = "von_mises"', "yield_stress is missing")
        self.refused('cohesion = 1.0', "body[0].material.cohesion", 'is not for law = "linear_elastic"',
                     "youngs_modulus and poisson_ratio alone")
        self.refused('law = "tresca", cohesion = 1.0, friction_angle = 3.0', 'is not for law = "tresca"',
                     "which takes cohesion, tensile_strength")
        self.refused('law = "von_mises", yield_stress = 1.0, cohesion = 3.0', 'is not for law = "von_mises"')
        self.refused('law = "tresca", cohesoin = 1.0', "unknown key 'cohesoin'", "did you mean 'cohesion'")

    def test_the_resolved_scene_reads_back_as_itself(self):
        for law, material in LAWS.items():
            first = vsb("check", self.write(scene_of(material)))
            self.assertEqual(first.returncode, 0, first.stderr)
            resolved = first.stdout[first.stdout.index("name ="):]
            again = vsb("check", self.write(resolved, "scene.toml"))
            self.assertEqual(again.stdout[again.stdout.index("name ="):], resolved)
            self.assertIn(f"law = '{law}'", resolved)

    def test_the_apex_is_the_default_cut_off(self):
        text = vsb("check", self.write(scene_of('law = "mohr_coulomb", cohesion = 0.5, friction_angle = 45.0'))).stdout
        value = [line.split("=")[1] for line in text.splitlines() if line.startswith("tensile_strength")]
        self.assertAlmostEqual(float(value[0].split("#")[0]), 0.5, delta=1e-12)

    def test_the_cylinder_to_compare_with(self):
        def refused(*words, settings=()):
            done = vsb("check", SCENES / "yield-cylinder.toml", *(part for s in settings for part in ("--set", s)))
            self.assertEqual(done.returncode, 2, done.stdout)
            for word in words:
                self.assertIn(word, done.stderr)
        refused("compare.solution", 'law = "mohr_coulomb" or "tresca"',
                settings=['body[0].material={ youngs_modulus = 1e10, poisson_ratio = 0.15 }'])
        # The collapse load c cot(phi) ((b / a)^beta - 1).
        sine = math.sin(math.radians(25))
        collapse = 5e6 / math.tan(math.radians(25)) * (5 ** (2 * sine / (1 + sine)) - 1)
        refused("compare.pressure", "> 0 and < ", settings=[f"compare.pressure={collapse * 1.0001}"])
        done = vsb("check", SCENES / "yield-cylinder.toml", "--set", f"compare.pressure={collapse * 0.9999}")
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_fields_of_bodies_that_do_not_yield(self):
        done = vsb("check", self.write(scene_of(LAWS["linear_elastic"])), "--set", 'output.fields=["plastic_strain"]')
        self.assertEqual(done.returncode, 2)
        self.assertIn("plastic_strain", done.stderr)

    def test_static_solutions_are_of_elastic_bodies(self):
        done = vsb("run", SCENES / "yield-cylinder.toml", "--static", "--out", self.folder / "results")
        self.assertEqual(done.returncode, 2)
        self.assertIn("body 'ring' may yield", done.stderr)
        self.assertFalse((self.folder / "results").exists())


class Cylinder(ProgramTest):
    """a = 1 m, b = 5 m, c = 5 MPa, phi = 25 degrees, p = 8 MPa, in closed form here too."""
    A, B, C, PHI, P = 1.0, 5.0, 5e6, math.radians(25), 8e6

    def plastic_radius(self):
        apex, beta = self.C / math.tan(self.PHI), 2 * math.sin(self.PHI) / (1 + math.sin(self.PHI))
        low, high = self.A, self.B
        for _ in range(60):
            rho = (low + high) / 2
            inside = (self.P + apex) * (self.A / rho) ** beta - apex
            B2 = (self.B / rho) ** 2
            outside = self.C * math.cos(self.PHI) * (B2 - 1) / (B2 + math.sin(self.PHI))
            low, high = (rho, high) if inside > outside else (low, rho)
        return low

    def test_plastic_radius_and_stresses(self):
        summary = self.run_scene("yield-cylinder")
        self.assertLess(summary["errors"]["e_rr"], 0.03)
        self.assertLess(summary["errors"]["e_tt"], 0.03)
        compared, rho = summary["compared"], self.plastic_radius()
        self.assertAlmostEqual(compared["exact_radius"], rho, delta=1e-12)
        self.assertAlmostEqual(compared["plastic_radius"], rho, delta=SPACING)
        self.assertAlmostEqual(compared["largest_plastic_radius"], rho, delta=SPACING)

        fields = last_fields(self.folder / "yield-cylinder")
        x, s, e = fields["position"], fields["cauchy_stress"], fields["plastic_strain"]
        r = np.hypot(x[:, 0], x[:, 1])
        middle, half = (s[:, 0] + s[:, 1]) / 2, np.hypot((s[:, 0] - s[:, 1]) / 2, s[:, 3])
        principal = np.sort(np.stack([middle + half, middle - half, s[:, 2]]), axis=0)
        f = (principal[2] - principal[0] + (principal[2] + principal[0]) * math.sin(self.PHI)
             - 2 * self.C * math.cos(self.PHI))
        self.assertLess(f.max(), 1e-9 * self.C)
        yielded = np.any(e != 0, axis=1)
        self.assertTrue(np.all(yielded[r < rho - 2 * SPACING]))
        # Plane flow without dilation: no plastic volume, nothing along z; (34) by hand.
        self.assertLess(np.abs(e[:, 2]).max(), 1e-3 * np.abs(e).max())
        self.assertLess(np.abs(e[:, 0] + e[:, 1] + e[:, 2]).max(), 1e-12 * np.abs(e).max() + 1e-15)
        measure = np.sqrt(2 / 3 * (e[:, 0] ** 2 + e[:, 1] ** 2 + e[:, 2] ** 2 + 2 * e[:, 3] ** 2))
        np.testing.assert_allclose(fields["equivalent_plastic_strain"], measure, rtol=1e-9, atol=1e-15)

    def test_both_engines_and_any_number_of_threads(self):
        results, hashes = {}, set()
        for engine, threads in (("cell_lanes", 1), ("cell_lanes", 3), ("particles", 1)):
            out = f"{engine}-{threads}"
            summary = self.run_scene("yield-cylinder", *SUDDEN, "--set", f"method.engine={engine}", out=out,
                                     environment={"OMP_NUM_THREADS": str(threads)})
            results[engine] = last_fields(self.folder / out)
            if engine == "cell_lanes":
                hashes.add(summary["state_hash"])
        self.assertEqual(len(hashes), 1)
        lanes, particles = results["cell_lanes"], results["particles"]
        yielded = np.any(particles["plastic_strain"] != 0, axis=1)
        self.assertGreater(yielded.sum(), 30)
        np.testing.assert_array_equal(yielded, np.any(lanes["plastic_strain"] != 0, axis=1))
        for name in ("position", "cauchy_stress", "plastic_strain", "equivalent_plastic_strain"):
            scale = np.abs(particles[name]).max()
            np.testing.assert_allclose(lanes[name], particles[name], rtol=0, atol=1e-11 * scale, err_msg=name)

    def test_the_plastic_strain_is_part_of_the_checkpoint(self):
        for engine in ("cell_lanes", "particles"):
            steps = 20000 if engine == "cell_lanes" else 1500
            self.resume("yield-cylinder", "--set", f"method.engine={engine}", "--set", "traction[0].time={smooth_ramp=0.0005}",
                        "--set", f"time.until_static.max_steps={steps}", "--set", "time.until_static.energy_ratio=1e-30")
            fields = last_fields(self.folder / "whole")
            self.assertGreater(np.abs(fields["plastic_strain"]).max(), 0)


class Bodies(ProgramTest):
    def test_only_plastic_bodies_have_plastic_strain(self):
        def run(*materials):
            self.run_scene(self.write(scene_of(*materials, engine="particles")))
            return last_fields(self.folder / "scene")
        names = list(LAWS)
        alone = {name: run(*[LAWS[name]] * 3) for name in names}
        self.assertNotIn("plastic_strain", alone["linear_elastic"])
        self.assertNotIn("equivalent_plastic_strain", alone["linear_elastic"])
        for first, second in zip(names, names[1:] + names[:1]):
            mixed = run(LAWS[first], LAWS["linear_elastic"], LAWS[second])
            for name, at in ((first, slice(0, 4)), (second, slice(8, 12))):
                np.testing.assert_array_equal(mixed["cauchy_stress"][at], alone[name]["cauchy_stress"][at])
                if name == "linear_elastic":
                    continue
                np.testing.assert_array_equal(mixed["plastic_strain"][at], alone[name]["plastic_strain"][at])
                self.assertGreater(np.abs(mixed["plastic_strain"][at]).max(), 1e-3, name)
            self.assertEqual(np.abs(mixed["plastic_strain"][4:8]).max(), 0)

    def test_bodies_that_differ_in_strength_take_the_particle_kernels(self):
        done = vsb("check", self.write(scene_of(MOHR_COULOMB, MOHR_COULOMB.replace("30.0", "29.0"))))
        self.assertIn("its bodies differ in their material", done.stdout)
        self.assertIn("steps on cell lanes", vsb("check", self.write(scene_of(MOHR_COULOMB, MOHR_COULOMB))).stdout)


# A vertical cut of N = gamma H / c = 5, 1.3 times the critical 3.83.
CUT = """
dimension = 2
gravity = [0.0, -10.0]
grid = { lower = [0.0, 0.0], upper = [8.0, 5.0], spacing = 0.25 }
faces = { x_min = "roller", y_min = "fixed" }
[[body]]
particles_per_cell = 2
density = 2000.0
shape.box = { lower = [0.0, 0.0], upper = [5.0, 3.0] }
material = { law = "tresca", cohesion = 12e3, youngs_modulus = 2e7, poisson_ratio = 0.3 }
[method]
damping = 0.5
[time]
kappa = 0.5
until_static = { max_steps = 8000 }
"""


class Locking(ProgramTest):
    def test_a_cut_above_its_critical_height_fails_unless_cells_lock(self):
        moved = {}
        for volumetric, more in (("full", ("--set", "method.volumetric=full")), ("averaged", ())):
            summary = self.run_scene(self.write(CUT), *more, "--set", "time.until_static.max_steps=8000", out=volumetric)
            self.assertEqual(summary["static"], volumetric == "full")
            moved[volumetric] = summary["largest_displacement"]
        self.assertGreater(moved["averaged"], 4 * moved["full"])


if __name__ == "__main__":
    unittest.main()
