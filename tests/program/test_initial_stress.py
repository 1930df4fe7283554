# SPDX-License-Identifier: BSD-3-Clause
"""Initial stresses beyond the yield surface of a body's material, which the first step would return to it without a word."""
import math
import unittest

from vsb_program import ProgramTest, vsb

BLOCK = """\
dimension = {dimension}
grid = {{ lower = {lower}, upper = {upper}, spacing = 1.0 }}
faces = {{ {faces} }}
time = {{ kappa = 0.3, steps = 1 }}
precision = "{precision}"
[[body]]
shape = {{ box = {{ lower = {lower}, upper = {upper} }} }}
particles_per_cell = 2
density = 2000.0
material = {{ youngs_modulus = 1e8, poisson_ratio = 0.3, {law} }}

stress = {stress}
"""
LINE = 12  # of the stress
FRICTION = math.radians(30.0)
UNIAXIAL = 2 * 20e3 * math.cos(FRICTION) / (1 - math.sin(FRICTION))  # strength of the Mohr-Coulomb body below
# How a law is written, and a stress on its yield surface.
ON_THE_SURFACE = [
    ('law = "mohr_coulomb", cohesion = 20e3, friction_angle = 30.0', [0, -UNIAXIAL, 0, 0, 0, 0]),
    ('law = "mohr_coulomb", cohesion = 20e3, friction_angle = 30.0, tensile_strength = 5e3', [5e3, 0, 0, 0, 0, 0]),
    ('law = "tresca", cohesion = 20e3', [-1e6, -1.04e6, -1.02e6, 0, 0, 0]),
    ('law = "tresca", cohesion = 20e3', [0, 0, 0, -20e3, 0, 0]),
    # The cone through the outer edges has the strength of Mohr-Coulomb in triaxial compression.
    ('law = "drucker_prager", cohesion = 20e3, friction_angle = 30.0', [0, -UNIAXIAL, 0, 0, 0, 0]),
    ('law = "von_mises", yield_stress = 60e3', [0, 0, 60e3, 0, 0, 0]),
    ('law = "von_mises", yield_stress = 60e3, hardening_modulus = 1e6', [-9e6, -9e6, -9e6 - 60e3, 0, 0, 0]),
]


class InitialStress(ProgramTest):
    def check(self, law, stress, *arguments, dimension=2, precision="double", command="check"):
        if not isinstance(stress, str):
            stress = "[" + ", ".join(repr(float(s)) for s in stress) + "]"
        vector = lambda x: "[" + ", ".join([str(x)] * dimension) + "]"
        faces = ", ".join(f'{axis}_{side} = "fixed"' for axis in "xyz"[:dimension] for side in ("min", "max"))
        scene = BLOCK.format(dimension=dimension, faces=faces, lower=vector(0.0), upper=vector(4.0), law=law, stress=stress, precision=precision)
        return vsb(command, self.write(scene), *arguments)

    def accept(self, *what, **how):
        done = self.check(*what, **how)
        self.assertEqual(done.returncode, 0, f"{done.stderr} {what}")

    def refuse(self, *what, words=(), **how):
        done = self.check(*what, **how)
        self.assertEqual(done.returncode, 2, f"{done.stdout[:200]} {what}")
        for word in ("body[0].stress = (", "beyond the yield surface", *words):
            self.assertIn(word, done.stderr)

    def test_on_the_surface_and_beyond_it(self):
        for law, stress in ON_THE_SURFACE:
            deviator = max(map(abs, stress)) < 1e5  # and not one that is small beside a pressure
            for dimension, precision in ((2, "double"), (2, "float"), (3, "double"), (1, "double")):
                if dimension == 1 and stress[3] != 0:
                    continue
                how = dict(dimension=dimension, precision=precision)
                self.accept(law, stress, **how)
                self.accept(law, [s * (1 + 1e-9) for s in stress], **how)
                if deviator:
                    self.accept(law, [s * (1 - 1e-3) for s in stress], **how)
                    self.refuse(law, [s * (1 + 1e-3) for s in stress], words=(f"scene.toml:{LINE}:",), **how)

    def test_what_may_have_any_stress(self):
        for law in ('law = "linear_elastic"', 'law = "von_mises", yield_stress = 1.0'):
            self.accept(law, [-1e7, -1e7, -1e7, 0, 0, 0])
        self.accept('law = "linear_elastic"', [-1e6, 0, 0, 5e5, 0, 0])
        # Components that a plane has not would be dropped without a word.
        for dimension, stress, beyond in ((2, [0, 0, 0, 0, 0, 1], "yz and xz"), (1, [0, 0, 0, 1, 0, 0], "xy, yz and xz")):
            done = self.check('law = "linear_elastic"', stress, dimension=dimension)
            self.assertEqual(done.returncode, 2)
            self.assertIn(f"in dimension {dimension} {beyond} must be 0", done.stderr)
        self.refuse('law = "von_mises", yield_stress = 1.0', [0, 0, 0, 0, 1e6, 1e6], dimension=3)

    def test_a_stress_that_varies_is_looked_at_where_the_particles_are(self):
        # 80 kPa at the lowest particles, 0.25 m above the base; 2 c = 80 kPa.
        law, field = 'law = "tresca", cohesion = 40e3', "{{ value = [0.0, {}, 0.0, 0.0, 0.0, 0.0], dy = [0.0, 20e3, 0.0, 0.0, 0.0, 0.0] }}"
        self.accept(law, field.format(-85e3))  # 80 kPa at the particles, 85 at the base
        self.refuse(law, field.format(-86e3), words=("0.25) m", "-81000", "s1 - s3 <= 2 cohesion", f"scene.toml:{LINE}:"))

    def test_nothing_is_done_before_it_is_refused(self):
        law, out = 'law = "tresca", cohesion = 1e3', self.folder / "out"
        self.refuse(law, [0, -100e3, 0, 0, 0, 0], "--out", out, command="run",
                    words=("(0, -100000, 0, 0, 0, 0) Pa", "s1 - s3 <= 2 cohesion"))
        self.assertFalse(out.exists())
        self.refuse(law, [0, 0, 0, 0, 0, 0], "--threads", 1, "--set", "body[0].stress=[0, -1e5, 0, 0, 0, 0]",
                    words=("--set body[0].stress",))


if __name__ == "__main__":
    unittest.main()
