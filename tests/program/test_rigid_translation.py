# SPDX-License-Identifier: BSD-3-Clause
"""Bodies without load that move as a whole, in the program: no stress, in double and in single precision."""
import unittest

import numpy as np

from vsb_program import ProgramTest, last_fields, vsb

BAR = """dimension = 1
[grid]
lower = [0.0]
upper = [12.0]
spacing = 1.0
[[body]]
shape.box = { lower = [3.39], upper = [5.89] }
lattice.uniform = { spacing = 0.5, origin = [0.39] }
density = 1.0
velocity = [1.0]
material = { youngs_modulus = 1000.0, poisson_ratio = 0.3 }
[time]
dt = 0.005
steps = 1000
"""

ROCK = """dimension = 2
[grid]
lower = [0.0, 0.0]
upper = [3.0, 2.0]
spacing = 0.1
[[body]]
shape.box = { lower = [0.339, 0.337], upper = [0.839, 0.837] }
lattice.uniform = { spacing = 0.05, origin = [0.039, 0.037] }
density = 2500.0
velocity = [2.0, 0.0]
material = { youngs_modulus = 1e10, poisson_ratio = 0.25 }
[time]
dt = 1e-5
steps = 12000
"""


class RigidTranslation(ProgramTest):
    def stress_after(self, text, modulus, epsilon, *more):
        """The largest stress of the last frame, in round-off of the modulus a step."""
        scene = self.folder / "translating.toml"
        scene.write_text(text)
        done = vsb("run", scene, "--quiet", "--out", self.folder / "translating", "--set",
                   "method.allow_particles_on_grid_lines=true", *more)
        self.assertEqual(done.returncode, 0, done.stderr)
        fields = last_fields(self.folder / "translating")
        self.assertTrue(np.all(np.isfinite(fields["position"])))
        return np.abs(fields["cauchy_stress"]).max() / (modulus * epsilon)

    def test_a_bar_whose_particles_come_next_to_the_faces_of_their_cells(self):
        for engine in ("cell_lanes", "particles"):
            for shift in range(12):  # other positions of the particles in their cells, one of them on faces
                with self.subTest(engine=engine, shift=shift):
                    origin = 0.25 + 0.02 * shift
                    text = BAR.replace("3.39", str(3 + origin)).replace("5.89", str(5.5 + origin)).replace(
                        "[0.39]", f"[{origin}]")
                    self.assertLess(self.stress_after(text, 1000, 2.2e-16, "--set", f"method.engine={engine}"), 10)

    def test_a_block_of_rock(self):
        # Stress of a step's round-off: E v dt / h epsilon, 2e-4 of E epsilon.
        self.assertLess(self.stress_after(ROCK, 1e10, 2.2e-16), 1)
        self.assertLess(self.stress_after(ROCK, 1e10, 1.2e-7, "--set", 'precision="float"'), 1)


if __name__ == "__main__":
    unittest.main()
