# SPDX-License-Identifier: BSD-3-Clause
"""Rectilinear and polar grids in scenes: where nodes and particles are, time steps, faces, what is refused."""
import math
import re
import unittest

import h5py
import numpy as np
from vsb_program import SCENES, ProgramTest, last_fields, vsb

COLUMN = (SCENES / "column.toml").read_text()
POLAR = (SCENES / "cylinder-polar.toml").read_text()
REGULAR = "lower = [0.0]\nupper = [12.0]\nspacing = 1.0\n"
RING = "polar = { radii = [0.5, 5.5], radial_cells = 10, angles = [0.0, 90.0], angular_cells = 10 }"


def replaced(text, *pairs):
    for old, new in pairs:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return text


class Rectilinear(ProgramTest):
    def column(self, nodes, name, *more):
        return self.write(replaced(COLUMN, (REGULAR, f"x = {nodes}\n"), *more), f"{name}.toml")

    def test_unit_cells_give_the_column_of_the_uniform_grid(self):
        uniform = self.run_scene("column")
        mapped = self.run_scene(self.column([float(i) for i in range(13)], "mapped"))
        for name in ("e_u", "e_sigma"):  # both of 1e-11, from 20,000 steps of different round-off
            self.assertAlmostEqual(mapped["errors"][name] / uniform["errors"][name], 1, delta=1e-3)
        self.assertEqual(mapped["boundary_nodes"], uniform["boundary_nodes"])
        np.testing.assert_allclose(last_fields(self.folder / "mapped")["cauchy_stress"],
                                   last_fields(self.folder / "column")["cauchy_stress"], rtol=0, atol=1e-12)

    def test_short_mesh(self):
        # Cells of 1 m have eight particles; the last one of half a metre has eight too, of half the size.
        nodes = [float(i) for i in range(10)] + [9.5, 10.5]
        summary = self.run_scene(self.column(nodes, "short"))
        fields = last_fields(self.folder / "short")
        start = np.sort(fields["position"][:, 0] - fields["displacement"][:, 0])
        expected = np.concatenate([(np.arange(72) + 0.5) / 8, 9 + (np.arange(8) + 0.5) / 16])
        np.testing.assert_allclose(start, expected, rtol=0, atol=1e-12)
        np.testing.assert_allclose(np.sort(fields["volume"])[[0, 7, 8, -1]], [1 / 16, 1 / 16, 1 / 8, 1 / 8], rtol=2e-3)
        self.assertLess(summary["errors"]["e_sigma"], 2e-11)
        self.assertLess(summary["errors"]["e_u"], 1e-10)

    def test_the_columns_origin_is_the_first_node(self):
        shifted = self.column([float(i) for i in range(-2, 11)], "shifted", ("lower = [0.0], upper = [9.5]",
                                                                           "lower = [-2.0], upper = [7.5]"))
        self.assertAlmostEqual(self.run_scene(shifted)["errors"]["e_u"] / 5.434e-11, 1, delta=0.05)

    def test_the_shortest_edge_sets_the_time_step(self):
        path = self.column([0.0, 1.0, 1.25, 2.0, 9.0, 10.0, 12.0], "graded", ("dt = 0.01", "kappa = 0.5"))
        done = vsb("check", path)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertAlmostEqual(float(re.search(r"dt = ([\d.e+-]+) s", done.stdout)[1]), 0.5 * 0.25 / math.sqrt(1e3), delta=1e-8)

    def test_a_box_in_space_is_filled(self):
        scene = """
dimension = 3
grid = { x = [-1.0, 0.0, 3.0], y = [0.0, 0.5, 1.0, 4.0], z = [2.0, 2.5] }
[faces]
z_min = "roller"
z_max = ["x", "z"]
[[body]]
shape = { box = { lower = [-1.0, 0.0, 2.0], upper = [3.0, 4.0, 2.5] } }
particles_per_cell = [3, 2, 1]
density = 2.0
material = { youngs_modulus = 1e6, poisson_ratio = 0.3 }
[time]
kappa = 0.1
steps = 1
[output]
grid = true
"""
        self.run_scene(self.write(scene))
        fields = last_fields(self.folder / "scene")
        self.assertEqual(len(fields["volume"]), 2 * 3 * 6)
        self.assertAlmostEqual(fields["volume"].sum(), 4 * 4 * 0.5, delta=1e-12)
        center = (fields["position"] * fields["volume"][:, None]).sum(0) / fields["volume"].sum()
        np.testing.assert_allclose(center, [1, 2, 2.25], rtol=0, atol=1e-12)
        with h5py.File(self.folder / "scene" / "scene_grid_000001.hdf") as file:
            points = file["VTKHDF/Points"][()]
        self.assertEqual(len(points), 3 * 4 * 2)
        np.testing.assert_array_equal(points[4], [0, 0.5, 2])  # nodes along x first
        np.testing.assert_array_equal(points[-1], [3, 4, 2.5])


class Polar(ProgramTest):
    def test_errors_of_the_isoparametric_cylinder(self):
        summary = self.run_scene("cylinder-polar")
        for name, expected in (("e_rr", 5.26e-2), ("e_tt", 1.33e-2), ("e_u", 4.02e-7)):
            self.assertAlmostEqual(summary["errors"][name] / expected, 1, delta=0.03, msg=name)
        self.assertTrue(summary["static"])
        for component in (0, 1):  # p a, on a staircase-free boundary
            self.assertAlmostEqual(summary["net_force"][component] / 1e5, 1, delta=0.01)

    def test_nodes_and_particles_of_a_polar_grid_in_space(self):
        scene = """
dimension = 3
[grid]
polar = { center = [1.0, -2.0], radii = [1.0, 3.0], radial_cells = 4, angles = [-45.0, 90.0], angular_cells = 6, z = [0.0, 1.0, 3.0] }
[faces]
r_min = "fixed"
theta_min = "fixed"
theta_max = "fixed"
[[body]]
shape = { cylinder = { axis = "z", center = [1.0, -2.0, 0.0], radius = 2.5 } }
particles_per_cell = [2, 3, 1]
density = 2.0
material = { youngs_modulus = 1e6, poisson_ratio = 0.3 }
[time]
kappa = 0.1
steps = 1
[output]
grid = true
"""
        self.run_scene(self.write(scene))
        fields = last_fields(self.folder / "scene")
        x, y, z = fields["position"].T
        self.assertEqual(len(x), 6 * 18 * 2)
        np.testing.assert_allclose(np.unique(np.hypot(x - 1, y + 2).round(9)), 1.125 + 0.25 * np.arange(6), rtol=0, atol=1e-9)
        angles = np.unique(np.degrees(np.arctan2(y + 2, x - 1)).round(6))
        np.testing.assert_allclose(angles, -45 + 7.5 * (np.arange(18) + 0.5), rtol=0, atol=1e-6)
        np.testing.assert_array_equal(np.unique(z), [0.5, 2])
        # Sectors between r = 1 and 2.5 over 135 degrees, 3 m high: their mass, and the volume of cells of 22.5 degrees
        # with chords for arcs.
        sectors, angle = 0.5 * (2.5**2 - 1) * math.radians(135) * 3, math.radians(22.5)
        self.assertAlmostEqual(fields["mass"].sum(), 2 * sectors, delta=1e-11)
        self.assertAlmostEqual(fields["volume"].sum(), sectors * math.sin(angle) / angle, delta=1e-12)
        with h5py.File(self.folder / "scene" / "scene_grid_000001.hdf") as file:
            points = file["VTKHDF/Points"][()]
        self.assertEqual(len(points), 5 * 7 * 3)
        np.testing.assert_allclose(points[0], [1 + math.sqrt(0.5), -2 - math.sqrt(0.5), 0], rtol=0, atol=1e-15)
        np.testing.assert_array_equal(points[5 * 7 - 1], [1, 1, 0])  # the axis itself, without round-off
        np.testing.assert_array_equal(points[-1], [1, 1, 3])

    def test_the_innermost_chord_sets_the_time_step(self):
        done = vsb("check", SCENES / "cylinder-polar.toml")
        self.assertEqual(done.returncode, 0, done.stderr)
        expected = 0.5 * math.sin(math.radians(4.5)) / math.sqrt(1e9 * 0.8 / (1.2 * 0.6) / 1e3)
        self.assertAlmostEqual(float(re.search(r"dt = ([\d.e+-]+) s", done.stdout)[1]) / expected, 1, delta=1e-5)


class Refused(ProgramTest):
    def refuse(self, text, *words, command="run"):
        out = self.folder / "results"
        done = vsb(command, self.write(text), *(("--out", out) if command == "run" else ()))
        self.assertEqual(done.returncode, 2, done.stderr + done.stdout)
        for word in words:
            self.assertIn(word, done.stderr)
        self.assertFalse(out.exists())

    def test_node_coordinates(self):
        for axis, words in (("x = [0.0]", ("grid.x", "at least two")), ("x = []", ("grid.x", "at least two")),
                            ("x = 3.0", ("grid.x", "at least two")), ("x = [0.0, 'a']", ("grid.x[1]",)),
                            ("x = [0.0, 1.0, 1.0]", ("grid.x[2]", "> 1.0")), ("x = [0.0, 2.0, 1.0]", ("grid.x[2]",)),
                            ("x = [0.0, inf]", ("grid.x[1]",)), ("y = [0.0, 1.0]", ("unknown key 'y'",)),
                            ("x = [0.0, 1.0]\ny = [0.0, 1.0]", ("unknown key 'y'",)),
                            ("x = [0.0, 12.0]\nspacing = 1.0", ("either lower, upper and spacing",)),
                            ("polar = { radii = [1.0, 2.0] }", ("dimension 2 or 3",))):
            self.refuse(replaced(COLUMN, (REGULAR, axis + "\n")), *words)

    def test_polar_tables(self):
        for old, new, words in (("[0.5, 5.5]", "[0.0, 5.5]", ("grid.polar.radii[0]", "> 0")),
                                ("[0.5, 5.5]", "[5.5, 0.5]", ("grid.polar.radii", "increase")),
                                ("radial_cells = 10", "radial_cells = 0", ("grid.polar.radial_cells",)),
                                ("radial_cells = 10, ", "", ("grid.polar.radial_cells is missing",)),
                                ("radial_cells = 10", "radial_cell = 10", ("radial_cell",)),
                                ("angular_cells = 10", "angular_cells = 1.5", ("grid.polar.angular_cells",)),
                                ("[0.0, 90.0]", "[0.0, 360.0]", ("less than 360", "not joined")),
                                ("[0.0, 90.0]", "[90.0, 0.0]", ("grid.polar.angles", "increase")),
                                ("[0.0, 90.0], angular_cells = 10", "[0.0, 270.0], angular_cells = 2", ("<= 90 degrees, not 135",)),
                                (" }", ", center = [0.0] }", ("grid.polar.center",)),
                                (" }", ", z = [0.0, 1.0] }", ("unknown key 'z'",)),
                                (RING, "polar = 3", ("grid.polar", "table")),
                                (RING, RING + "\nlower = [0.0, 0.0]", ("either lower, upper and spacing",))):
            ring = RING if old == RING else RING.replace(old, new)
            self.refuse(replaced(POLAR, (RING, new if old == RING else ring)), *words)

    def test_faces_of_a_polar_grid(self):
        faces = 'theta_min = ["y"]'
        self.refuse(replaced(POLAR, (faces, 'theta_min = "roller"')), "faces.theta_min", "list of fixed components")
        self.refuse(replaced(POLAR, (faces, 'r_min = "roller"')), "faces.r_min", "list of fixed components")
        self.refuse(replaced(POLAR, (faces, 'x_min = "roller"')), "unknown key 'x_min'")
        self.refuse(replaced(POLAR, (faces, 'theta_min = ["theta"]')), "faces.theta_min", "'x', 'y'")
        self.refuse(replaced(POLAR, (faces, "theta_min = []")), "faces.theta_min", "open")

    def test_a_body_at_an_open_face_under_a_traction(self):
        self.refuse(replaced(POLAR, ('theta_min = ["y"]', 'theta_min = "open"')), "open face theta_min")
        surface = "surface = { disc = { center = [0.0, 0.0], radius = 3.0 } }\n"
        self.refuse(replaced(POLAR, ("[0.5, 5.5], radial_cells = 10", "[0.5, 5.0], radial_cells = 9"), (surface, "")),
                    "open face r_max")
        self.refuse(replaced(POLAR, ("[0.5, 5.5], radial_cells = 10", "[1.0, 5.5], radial_cells = 9")), "finds no boundary node")

    def test_single_precision(self):
        self.refuse('precision = "float"\n' + POLAR, "precision", "double")


if __name__ == "__main__":
    unittest.main()
