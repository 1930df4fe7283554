# SPDX-License-Identifier: BSD-3-Clause
"""Scenes far from the origin of their coordinates: the same as at the origin, in single precision too."""
import json
import re
import unittest

import numpy as np

from vsb_program import ProgramTest, last_fields, vsb

ENGINES = ("cell_lanes", "particles")
MAP = (500000.0, 4200000.0)


def column(at, precision, engine, steps=4000):
    """A column of 4 m x 4 m under its own weight, the grid's corner at `at`."""
    x, y = at
    return f"""
        dimension = 2
        precision = "{precision}"
        gravity = [0.0, -9.81]
        grid = {{ lower = [{x}, {y}], upper = [{x + 4}, {y + 6}], spacing = 0.25 }}
        faces = {{ x_min = "roller", x_max = "roller", y_min = "roller" }}
        method = {{ damping = 0.2, engine = "{engine}" }}
        time = {{ kappa = 0.4, steps = {steps} }}
        [[body]]
        particles_per_cell = 2
        density = 2000.0
        shape.box = {{ lower = [{x}, {y}], upper = [{x + 4}, {y + 4}] }}
        material = {{ youngs_modulus = 2e7, poisson_ratio = 0.3 }}
        """


def loaded(at, **method):
    """A block under loads whose fields know where they are; all numbers are exact in double precision."""
    x, y = at
    precision = method.pop("precision", "double")
    ends = f'lower = [{x}, {y}], upper = [{x + 8}, {y + 8}], spacing = 0.5'
    if method.pop("mapped", False):
        ends = ", ".join(f"{axis} = {[at[i] + 0.5 * n for n in range(17)]}" for i, axis in enumerate("xy"))
    keys = "\n".join(f"{key} = {json.dumps(value)}" for key, value in method.items())
    return f"""
        dimension = 2
        precision = "{precision}"
        gravity = [0.0, -8.0]
        grid = {{ {ends} }}
        faces = {{ x_min = "roller", y_min = "roller" }}
        time = {{ kappa = 0.25, steps = 300 }}
        [method]
        {keys}
        [[body]]
        particles_per_cell = 2
        density = 2048.0
        shape.box = {{ lower = [{x}, {y}], upper = [{x + 6}, {y + 6}] }}
        stress = {{ value = [0, {-16384.0 * (y + 6)}, 0, 0, 0, 0], dy = [0, 16384.0, 0, 0, 0, 0] }}
        velocity = {{ value = [{-0.25 * x}, 0], dx = [0.25, 0] }}
        material = {{ youngs_modulus = 1e7, poisson_ratio = 0.25 }}
        [[traction]]
        hydrostatic = {{ unit_weight = 8192.0, level = {y + 5} }}
        surface.box = {{ lower = [{x + 5}, {y}], upper = [{x + 8}, {y + 8}] }}
        [[traction]]
        affine = {{ value = [0, {-1024.0 * x - 8192.0}, 0, 0, 0, 0], dx = [0, 1024.0, 0, 0, 0, 0] }}
        surface.box = {{ lower = [{x}, {y + 5}], upper = [{x + 8}, {y + 8}] }}
        [[traction]]
        surface.box = {{ lower = [{x}, {y + 5}], upper = [{x + 8}, {y + 8}] }}
        [traction.radial_blend]
        center = [{x + 6}, {y + 6}]
        inner = {{ radius = 1.0, pressure = 4096.0 }}
        outer = {{ radius = 3.0, pressure = 0.0 }}
        [[traction]]
        surface.box = {{ lower = [{x + 5}, {y}], upper = [{x + 8}, {y + 8}] }}
        [traction.planar_blend]
        start = {{ point = [{x}, {y + 4}], pressure = 4096.0 }}
        end = {{ point = [{x}, {y + 6}], pressure = 0.0 }}
        """


class FarFromTheOrigin(ProgramTest):
    def results(self, text, name):
        summary = self.run_scene(self.write(text, name + ".toml"))
        return summary, last_fields(self.folder / name)

    def test_settlement_at_map_coordinates(self):
        exact = 2000 * 9.81 * 4**2 / (2 * 2e7 * 0.7 / (1.3 * 0.4))
        for engine in ENGINES:
            for precision in ("float", "double"):
                with self.subTest(engine=engine, precision=precision):
                    summary, fields = self.results(column(MAP, precision, engine), f"{engine}-{precision}")
                    self.assertAlmostEqual(-fields["displacement"][:, 1].min() / exact, 1, delta=0.01)  # 5.83 mm
                    stress = fields["cauchy_stress"][:, 1]
                    self.assertAlmostEqual(stress.min() / -78480, 1, delta=0.03)  # of the lowest particles
                    self.assertLess(stress.max(), 0)
                    heights = fields["position"][:, 1] - MAP[1]
                    self.assertTrue((heights > 0).all() and (heights < 4).all())
                    self.assertTrue((np.abs(fields["position"][:, 0] - MAP[0] - 2) < 2).all())

    def test_the_same_bits_as_at_the_origin(self):
        ways = [dict(engine=engine, precision=precision) for engine in ENGINES for precision in ("double", "float")]
        ways += [dict(engine=engine, basis="quadratic_bspline") for engine in ENGINES]
        ways += [dict(engine="particles", basis="ugimp"), dict(engine="particles", mapped=True)]
        for number, way in enumerate(ways):
            with self.subTest(way):
                near, near_fields = self.results(loaded((0.0, 0.0), **way), f"near-{number}")
                for far_away in ((524288.0, 4194304.0), (-4194304.0, 65536.0)):
                    far, fields = self.results(loaded(far_away, **way), f"far-{number}-{far_away[1]}")
                    self.assertEqual(far["state_hash"], near["state_hash"])
                    np.testing.assert_array_equal(fields["displacement"], near_fields["displacement"])
                    np.testing.assert_array_equal(fields["in_boundary"], near_fields["in_boundary"])
                    np.testing.assert_allclose(fields["position"][:, :2] - far_away, near_fields["position"][:, :2],
                                               rtol=0, atol=1e-9)
                    for name in ("net_force", "exact_force", "net_torque", "exact_torque"):
                        np.testing.assert_allclose(far[name], near[name], rtol=1e-6, atol=1e-2, err_msg=name)
                    np.testing.assert_allclose(np.subtract(far["torque_about"], near["torque_about"])[:2], far_away)

    def test_surface_points_and_removal_of_voids(self):
        """Loads that look for the surface of the bodies, and what asks for the body's cells."""
        for method in ({"imposition": "boundary_particles"}, {"imposition": "nodal"}, {"imposition": "virtual_stress_original"},
                       {"void_filter": True}):
            with self.subTest(method):
                fields = []
                for x, y in ((0.0, 0.0), MAP):
                    text = column((x, y), "double", "auto", steps=200)
                    filter_on = "void_filter = true," if "void_filter" in method else ""
                    text = text.replace("method = {", "method = { " + filter_on)
                    text += f"""
                        [[traction]]
                        pressure = 1e5
                        imposition = "{method.get('imposition', 'virtual_stress')}"
                        surface.box = {{ lower = [{x}, {y + 3.5}], upper = [{x + 4}, {y + 5}] }}
                        """
                    fields.append(self.results(text, f"at-{x:.0f}-{len(method)}-{list(method)[0]}")[1])
                near, far = fields
                scale = np.abs(near["displacement"]).max()
                self.assertGreater(scale, 1e-3)
                np.testing.assert_allclose(far["displacement"], near["displacement"], rtol=0, atol=1e-6 * scale)

    def test_torque_is_about_the_centre_of_mass(self):
        summary, _ = self.results(loaded((524288.0, 4194304.0)), "loaded")
        self.assertEqual(summary["torque_about"], [524288.0 + 3, 4194304.0 + 3, 0])
        # The water, over the height of the wall: a triangle of 5 m, whose resultant passes 5/3 m above the base.
        text = loaded((524288.0, 4194304.0))
        water = self.results(text[:text.index("[[traction]]\n        affine")], "water")[0]
        force = 8192.0 * 5**2 / 2
        np.testing.assert_allclose(water["exact_force"], [-force, 0, 0], rtol=1e-3)
        np.testing.assert_allclose(water["exact_torque"], [0, 0, force * (5 / 3 - 3)], rtol=1e-2)
        done = vsb("check", self.write(text))
        self.assertIn("torque about (524291, 4194307) m, the centre of mass at the start,", done.stdout)

    def test_messages_have_the_digits_of_the_position(self):
        text = column(MAP, "double", "auto").replace(f"upper = [{MAP[0] + 4}, {MAP[1] + 4}]", f"upper = [{MAP[0] + 4}, {MAP[1] + 8}]")
        done = vsb("check", self.write(text))
        self.assertEqual(done.returncode, 2)
        self.assertIn("at the open face y_max, to (500000.062, 4200006.062) m,", done.stderr)

    def test_at_the_limit_of_single_precision(self):
        """A column that hangs at the far end of a grid of 800 cells."""
        for engine in ENGINES:
            near, far = (self.results(column((0.0, 0.0), precision, engine).replace("[0.0, -9.81]", "[0.0, 9.81]")
                                      .replace("y_min", "y_max").replace("upper = [4.0, 6.0]", "upper = [4.0, 200.0]")
                                      .replace("lower = [0.0, 0.0], upper = [4.0, 4.0]", "lower = [0.0, 196.0], upper = [4.0, 200.0]"),
                                      f"{engine}-{precision}")[0] for precision in ("double", "float"))
            self.assertAlmostEqual(far["largest_displacement"] / near["largest_displacement"], 1, delta=0.03)
            self.assertAlmostEqual(far["smallest_principal_stress"] / near["smallest_principal_stress"], 1, delta=1e-4)

    def test_what_single_precision_does_not_resolve_is_refused(self):
        long_grid = column((0.0, 0.0), "float", "particles").replace("upper = [4.0, 6.0]", "upper = [4.0, 6000.0]")
        done = vsb("run", self.write(long_grid), "--out", self.folder / "long")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertRegex(done.stderr, r'precision = "float" does not resolve this grid: along y it goes up to 6000 m, 24000 cells')
        for key in ('precision = "double"', "grid.spacing", "grid.upper"):
            self.assertIn(key, done.stderr)
        self.assertFalse((self.folder / "long").exists())

    def test_small_displacements_in_single_precision(self):
        """At the origin, too: what a step adds to the position in a cell must be more than round-off."""
        for modulus, precision, told in (("2e7", "float", False), ("2e10", "float", True), ("2e10", "double", False)):
            done = vsb("check", self.write(column((0.0, 0.0), precision, "auto").replace("2e7", modulus)))
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual('which precision = "float" loses' in done.stderr, told, done.stderr)

    def test_coordinates_beyond_double_precision_are_refused(self):
        scene = self.write(column((0.0, 2.0**50), "double", "auto"))
        done = vsb("run", scene, "--out", self.folder / "beyond")
        self.assertEqual(done.returncode, 2)
        self.assertRegex(done.stderr, r"scene\.toml:5:\d+: .*grid\.lower.* the grid lies up to 1\.1259e\+15 m from the origin along y")
        self.assertFalse((self.folder / "beyond").exists())


if __name__ == "__main__":
    unittest.main()
