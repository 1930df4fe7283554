# SPDX-License-Identifier: BSD-3-Clause
"""A column of dry sand that collapses: it rises nowhere, keeps its volume, and runs out as far as in experiments."""
import unittest

import h5py
import numpy as np
from vsb_program import ProgramTest, frames

WIDTH = HEIGHT = 1.0
LINEAR = ("--set", 'method.basis="linear"')


class DrySand(ProgramTest):
    def collapse(self, *arguments, out="sand"):
        """Of every frame: positions, the volume over that at the start, and the gaps of particles that carry stress."""
        self.run_scene("dry-sand", *arguments, out=out)
        states = []
        for path, _ in frames(self.folder / out):
            with h5py.File(path) as file:
                data = file["VTKHDF/PointData"]
                stressed = np.abs(data["cauchy_stress"][()]).max(axis=1) > 1.0
                states.append((file["VTKHDF/Points"][()], data["volume"][()].sum() / (WIDTH * HEIGHT),
                               data["plastic_strain"][()][stressed, :3].sum(axis=1)))
        return states

    def check(self, states, volume_gained=0.01, round_off=1e-9):
        first_top = states[0][0][:, 1].max()
        for x, volume, gaps in states:
            self.assertLessEqual(x[:, 1].max(), first_top + 1e-6)
            self.assertGreater(volume, 0.99)
            self.assertLess(volume, 1 + volume_gained)
            self.assertGreater(len(gaps), 300)
            self.assertLess(np.abs(gaps).max(), round_off)  # without dilation plastic strain has no other volume
        x = states[-1][0]
        # Lube et al. (2005), Lajeunesse et al. (2005): (L - L0) / L0 = 1.2 H0 / L0 of columns that are not high.
        front = np.quantile(x[:, 0], 0.99)
        self.assertGreater((front - WIDTH) / HEIGHT, 0.9)
        self.assertLess((front - WIDTH) / HEIGHT, 1.5)

    def test_collapse(self):
        self.check(self.collapse())

    def test_collapse_in_single_precision(self):
        self.check(self.collapse("--set", 'precision="float"', *LINEAR), volume_gained=0.05, round_off=1e-3)

    def test_collapse_with_linear_functions(self):
        self.check(self.collapse(*LINEAR), volume_gained=0.05)

    def test_drucker_prager(self):
        self.check(self.collapse("--set", 'body[0].material={law="drucker_prager",youngs_modulus=1e7,poisson_ratio=0.3,'
                                 'cohesion=0.0,friction_angle=31.0,cone="plane_strain"}',
                                 # Pressed more by the wall: the cone has less room than Mohr and Coulomb's.
                                 "--set", "body[0].stress={value=[-12.36e3,-17.66e3,-12.36e3,0.0,0.0,0.0],"
                                          "dy=[12.36e3,17.66e3,12.36e3,0.0,0.0,0.0]}"))

    def test_the_same_bits_on_any_number_of_threads(self):
        hashes = {self.run_scene("dry-sand", "--set", "time.steps=1000", out=f"threads-{n}",
                                 environment={"OMP_NUM_THREADS": str(n)})["state_hash"] for n in (1, 3)}
        self.assertEqual(len(hashes), 1)


if __name__ == "__main__":
    unittest.main()
