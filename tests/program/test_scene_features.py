# SPDX-License-Identifier: BSD-3-Clause
"""What a scene can say: shapes, lattices, initial fields, faces, gravity, tractions in space and time."""
import math
import unittest

import numpy as np
from vsb_program import ProgramTest, last_fields

SCENE = """
name = "s"
dimension = {dimension}
gravity = {gravity}
grid = {{ lower = {lower}, upper = {upper}, spacing = {spacing} }}
{faces}
[[body]]
shape = {shape}
particles_per_cell = {ppc}
density = 1000.0
material = {{ youngs_modulus = 1e6, poisson_ratio = 0.3 }}
{body}
{more}
[time]
{time}
"""


class Features(ProgramTest):
    def fields(self, shape, dimension=2, gravity=None, lower=None, upper=None, spacing=0.5, faces="", ppc=2, body="", more="",
               time="kappa = 0.1\nsteps = 1", summary=False):
        vector = lambda x: [float(x)] * dimension
        path = self.write(SCENE.format(dimension=dimension, gravity=gravity or vector(0), lower=lower or vector(-4),
                                       upper=upper or vector(4), spacing=spacing, faces=faces, shape=shape, ppc=ppc, body=body,
                                       more=more, time=time))
        result = self.run_scene(path, out="s")
        return (last_fields(self.folder / "s"), result) if summary else last_fields(self.folder / "s")

    def volume(self, shape, dimension, ppc=4):
        return self.fields(shape, dimension, ppc=ppc)["volume"].sum()

    def test_shapes_have_their_volumes(self):
        box3 = "{ box = { lower = [-1.0, -1.0, -1.0], upper = [1.0, 2.0, 1.5] } }"
        ball3 = "{ ball = { center = [0.2, 0.1, 0.0], radius = 2.0 } }"
        for shape, dimension, expected, tolerance in (
                ("{ box = { lower = [-1.0], upper = [2.0] } }", 1, 3, 0),
                ("{ ball = { center = [0.0], radius = 1.5 } }", 1, 3, 0),
                ("{ half_space = { point = [1.0], normal = [1.0] } }", 1, 5, 0),
                ("{ disc = { center = [0.3, -0.2], radius = 2.0 } }", 2, 4 * math.pi, 0.01),
                ("{ ellipse = { center = [0.1, 0.0], semi_axes = [3.0, 1.5] } }", 2, 4.5 * math.pi, 0.01),
                ("{ half_space = { point = [0.0, 0.0], normal = [1.0, 1.0] } }", 2, 32, 0.02),
                (box3, 3, 2 * 3 * 2.5, 0),
                (ball3, 3, 32 / 3 * math.pi, 0.01),
                ("{ ellipsoid = { center = [0.0, 0.0, 0.0], semi_axes = [3.0, 2.0, 1.0] } }", 3, 8 * math.pi, 0.01),
                ("{ cylinder = { axis = 'y', center = [0.0, 0.0, 0.0], radius = 2.0 } }", 3, 32 * math.pi, 0.01),
                ("{ cylinder = { axis = 'x', center = [0.0, 0.0, 0.0], radius = 2.0, lower = -1, upper = 2.5 } }", 3,
                 14 * math.pi, 0.01),
                ("{ difference = [ %s, { box = { lower = [0.0, -1.0, -1.0], upper = [1.0, 2.0, 1.5] } } ] }" % box3, 3, 7.5, 0),
                ("{ intersection = [ %s, { half_space = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] } } ] }" % box3, 3,
                 6, 0),
                ("{ union = [ %s, { box = { lower = [1.0, -1.0, -1.0], upper = [2.0, 2.0, 1.5] } } ] }" % box3, 3, 22.5, 0)):
            volume = self.volume(shape, dimension)
            self.assertAlmostEqual(volume / expected, 1, delta=tolerance + 1e-6, msg=shape)

    def test_lattice_with_different_numbers_per_direction(self):
        fields = self.fields("{ box = { lower = [0.0, 0.0], upper = [1.0, 1.0] } }", ppc=[3, 1])
        self.assertEqual(len(fields["id"]), 2 * 3 * 2 * 1)
        np.testing.assert_allclose(fields["volume"], 0.5 / 3 * 0.5, rtol=1e-6)
        start = fields["position"] - fields["displacement"]
        np.testing.assert_allclose(np.unique(np.round(start[:, 0], 9)), (np.arange(6) + 0.5) / 6, atol=1e-8)

    def test_affine_initial_fields(self):
        # dsigma/dx is balanced by no force, so one tiny step shows the initial values to the order of the step.
        fields = self.fields("{ box = { lower = [0.0, 0.0], upper = [2.0, 2.0] } }", time="dt = 1e-12\nsteps = 1", body="""
            stress = { value = [1.0, 2.0, 3.0, 4.0, 0.0, 0.0], dx = [10.0, 0.0, 0.0, 0.0, 0.0, 0.0], dy = [0.0, 0.0, 0.0, 7.0, 0.0, 0.0] }
            velocity = { value = [0.1, 0.2], dx = [0.0, 0.5], dy = [-0.3, 0.0] }""")
        x, y, _ = fields["position"].T
        np.testing.assert_allclose(fields["cauchy_stress"].T, [1 + 10 * x, 2 + 0 * x, 3 + 0 * x, 4 + 7 * y, 0 * x, 0 * x],
                                   atol=1e-5)
        np.testing.assert_allclose(fields["velocity"].T, [0.1 - 0.3 * y, 0.2 + 0.5 * x, 0 * x], atol=1e-9)

    def test_gravity_is_free_fall(self):
        fields = self.fields("{ disc = { center = [0.0, 1.0], radius = 1.0 } }", gravity=[0.3, -2.0],
                             time="dt = 0.001\nsteps = 200")
        np.testing.assert_allclose(fields["velocity"], np.tile([0.06, -0.4, 0], (len(fields["id"]), 1)), rtol=0, atol=1e-10)
        # Symplectic Euler: x = g dt^2 n (n + 1) / 2.
        np.testing.assert_allclose(fields["displacement"][:, 1], -2 * 1e-6 * 200 * 201 / 2, rtol=1e-9)

    def test_two_bodies_of_different_density_and_stiffness(self):
        fields, summary = self.fields("{ box = { lower = [-3.0, 0.0], upper = [-1.0, 1.0] } }", summary=True, more="""
            [[body]]
            shape = { box = { lower = [1.0, 0.0], upper = [3.0, 1.0] } }
            particles_per_cell = 1
            density = 4000.0
            stress = [5.0, 0.0, 0.0, 0.0, 0.0, 0.0]
            material = { youngs_modulus = 1e9, poisson_ratio = 0.0 }""")
        right = fields["position"][:, 0] > 0
        self.assertEqual((right.sum(), (~right).sum()), (8, 32))
        np.testing.assert_allclose(fields["mass"][right].sum(), 8000, rtol=1e-9)
        np.testing.assert_allclose(fields["mass"][~right].sum(), 2000, rtol=1e-9)
        # Eq. (29) with the stiffer body: M = E for nu = 0.
        self.assertAlmostEqual(summary["dt"] / (0.1 * 0.5 / math.sqrt(1e9 / 4000)), 1, delta=1e-12)

    def test_faces_prescribe_their_components(self):
        shape = "{ box = { lower = [0.0, 0.0], upper = [2.0, 2.0] } }"
        for faces, still in (('faces = { x_min = "roller" }', [0]), ('faces = { x_min = "fixed" }', [0, 1]),
                             ('faces = { x_min = ["y"] }', [1])):
            fields = self.fields(shape, lower=[0.0, -1.0], upper=[4.0, 3.0], faces=faces, gravity=[-9.0, -5.0],
                                 time="kappa = 0.2\nsteps = 20", ppc=2, more="[output]\ngrid = true")
            import h5py
            with h5py.File(sorted((self.folder / "s").glob("s_grid_*.hdf"))[-1]) as file:
                points, velocity = file["VTKHDF/Points"][()], file["VTKHDF/PointData/velocity"][()]
                mass = file["VTKHDF/PointData/mass"][()]
            face = (points[:, 0] == 0) & (mass > 0)
            for component in (0, 1):
                moving = np.abs(velocity[face, component]).max() > 1e-6
                self.assertEqual(moving, component not in still, f"{faces} {component}")
            self.assertEqual(len(fields["id"]), 64)

    def net_force(self, traction, steps, more=""):
        _, summary = self.fields("{ box = { lower = [0.0, 0.0], upper = [2.0, 2.0] } }", lower=[0.0, -1.0], upper=[4.0, 3.0],
                                 faces='faces = { x_min = "fixed" }', summary=True, time=f"dt = 0.001\nsteps = {steps}",
                                 more=f"[[traction]]\n{traction}\n{more}")
        return summary["net_force"]

    def test_time_functions(self):
        pressure = "pressure = 100.0\n"
        full = self.net_force(pressure, 20)
        self.assertAlmostEqual(full[0] / (-100 * 2), 1, delta=1e-3)  # pressure times the height of the block
        self.assertAlmostEqual(full[1] / 200, 0, delta=1e-9)
        for time, steps, factor in (("{ ramp = 0.04 }", 10, 0.25), ("{ ramp = 0.04 }", 60, 1), ("{ ramp_steps = 50 }", 10, 0.2),
                                    ("{ step = 0.015 }", 14, 0), ("{ step = 0.0145 }", 15, 1),
                                    ("{ table = [[0.0, 1.0], [0.02, 3.0], [0.02, -1.0], [0.04, 0.0]] }", 10, 2),
                                    ("{ table = [[0.0, 1.0], [0.02, 3.0], [0.02, -1.0], [0.04, 0.0]] }", 30, -0.5),
                                    ("{ table = [[0.0, 1.0], [0.02, 3.0], [0.02, -1.0], [0.04, 0.0]] }", 70, 0)):
            force = self.net_force(pressure + f"time = {time}", steps)
            self.assertAlmostEqual(force[0] / (-100 * 2), factor, delta=2e-3, msg=time)

    def test_tractions_act_on_their_surfaces_and_add_up(self):
        right = "surface = { half_space = { point = [1.9, 0.0], normal = [-1.0, 0.0] } }\n"
        shear = self.net_force("stress = [0.0, 0.0, 0.0, 30.0, 0.0, 0.0]\n" + right, 5)
        self.assertAlmostEqual(shear[1] / (30 * 2), 1, delta=1e-3)  # t = sbar . n = (0, 30) on the right-hand face
        both = self.net_force("stress = [0.0, 0.0, 0.0, 30.0, 0.0, 0.0]\n" + right, 5,
                              "[[traction]]\nstress = [-50.0, 0.0, 0.0, 0.0, 0.0, 0.0]\n" + right)
        self.assertAlmostEqual(both[0] / (-50 * 2), 1, delta=1e-3)
        self.assertAlmostEqual(both[1] / (30 * 2), 1, delta=1e-3)

    def test_anisotropic_cells(self):
        fields = self.fields("{ box = { lower = [0.0, 0.0], upper = [2.0, 1.0] } }", spacing=[1.0, 0.25], ppc=2)
        self.assertEqual(len(fields["id"]), 4 * 8)
        np.testing.assert_allclose(fields["volume"], 0.5 * 0.125, rtol=1e-9)


if __name__ == "__main__":
    unittest.main()
