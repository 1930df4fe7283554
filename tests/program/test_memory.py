# SPDX-License-Identifier: BSD-3-Clause
"""What a run needs beside its particles: the peak of the resident set that the program itself reports, per particle."""
import unittest

from vsb_program import ProgramTest

# A block on rollers, pressed from above: 24 x 24 x 24 cells, or one of them.
SCENE = """
dimension = 3
grid = {{ lower = [0.0, 0.0, 0.0], upper = [{cells}, {cells}, {top}], spacing = 1.0 }}
faces = {{ x_min = "roller", x_max = "roller", y_min = "roller", y_max = "roller", z_min = "roller" }}
time = {{ kappa = 0.3, steps = 5 }}
output = {{ every = 5 }}
precision = "{precision}"
[[body]]
shape = {{ box = {{ lower = [0.0, 0.0, 0.0], upper = [{cells}, {cells}, {cells}] }} }}
particles_per_cell = 2
density = 1.0
material = {{ youngs_modulus = 1e3, poisson_ratio = 0.2{law} }}
[[traction]]
pressure = 1.0
time = {{ ramp_steps = 10 }}
"""
PLASTIC = ', law = "mohr_coulomb", cohesion = 1e-4, friction_angle = 25.0'


class PeakMemory(ProgramTest):
    def bytes_per_particle(self, precision, law, *arguments):
        """The peak of a run of 110,592 particles less that of one of 8."""
        peak = {}
        for cells in (1, 24):
            scene = self.write(SCENE.format(cells=f"{cells}.0", top=f"{cells + 2}.0", precision=precision, law=law))
            summary = self.run_scene(scene, "--threads", 1, *arguments, out=f"{precision}{cells}")
            peak[cells] = summary["peak_bytes"]
            particles = summary["particles"]
        self.assertEqual(particles, 24**3 * 8)
        return (peak[24] - peak[1]) / particles

    # 14 numbers each in 3D, 20 with the plastic strain; in lanes an eighth more, and their nodes. They are packed where they
    # are. A second copy of them would take 110 bytes more. A frame that held all fields in double precision at once would take 80 to 150 bytes more.
    def test_elastic_in_double_precision(self):
        self.assertLess(self.bytes_per_particle("double", ""), 250)

    def test_plastic_in_single_precision(self):
        self.assertLess(self.bytes_per_particle("float", PLASTIC), 195)

    def test_on_particle_kernels(self):
        self.assertLess(self.bytes_per_particle("double", "", "--set", "method.engine=particles"), 290)


if __name__ == "__main__":
    unittest.main()
