# SPDX-License-Identifier: BSD-3-Clause
"""Bodies as drawn beside bodies as placed: volume and mass, messages with their lines, open faces, many shapes."""
import json
import math
import unittest

import h5py
from vsb_program import ProgramTest, frames, vsb

BAR = """\
dimension = 1
gravity = [-10.0]
grid = { lower = [0.0], upper = [4.0], spacing = 0.5 }
faces = { x_min = "fixed" }
time = { kappa = 0.2, steps = 2 }

[[body]]
name = "bar"
shape.box = { lower = [0.0], upper = [0.95] }
lattice.uniform = { spacing = 0.4, origin = [0.0] }
density = 1000.0
material = { youngs_modulus = 1e7, poisson_ratio = 0.0 }
"""
PLANE = """\
dimension = 2
grid = {grid}
faces = {{ {faces} }}
time = {{ kappa = 0.2, steps = 2 }}
output = {{ every = 1 }}
method = {{ {method} }}

[[body]]
name = "block"
shape = {shape}
{lattice}
density = 2000.0
material = {{ youngs_modulus = 1e7, poisson_ratio = 0.2 }}
velocity = [0.1, 0.0]
"""
SQUARE_GRID = "{ lower = [0.0, 0.0], upper = [4.0, 4.0], spacing = 0.5 }"


class GeometryTest(ProgramTest):
    def plane(self, shape, lattice="particles_per_cell = 2", grid=SQUARE_GRID, faces="", method="", more=""):
        return self.write(PLANE.format(shape=shape, lattice=lattice, grid=grid, faces=faces, method=method) + more)

    def run_told(self, scene):
        """What a run prints, its warnings, and the bodies of its summary."""
        done = vsb("run", scene, "--out", self.folder / "out")
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout, done.stderr, json.loads((self.folder / "out" / "summary.json").read_text())["bodies"]


class Volumes(GeometryTest):
    def test_a_bar_that_its_lattice_does_not_fill(self):
        for command in ("run", "check"):
            done = vsb(command, self.write(BAR), *(("--out", self.folder / "out") if command == "run" else ()))
            self.assertRegex(done.stdout, r"body 'bar': particles 0\.8 m and 800 kg/m\^2, shape 0\.95 m and 950 kg/m\^2 \(-15\.79 %\)")
            self.assertRegex(done.stderr, r"warning: the particles of body 'bar' have 0\.8 m and 800 kg/m\^2, its shape 0\.95 m.*\"cut\"")
        summary = json.loads((self.folder / "out" / "summary.json").read_text())
        body, = summary["bodies"]
        self.assertEqual(body["name"], "bar")
        for key, value in {"particle_volume": 0.8, "particle_mass": 800, "shape_volume": 0.95, "shape_mass": 950}.items():
            self.assertAlmostEqual(body[key] / value, 1, delta=1e-12)

    def test_a_bar_that_its_lattice_fills_or_that_is_cut_is_told_without_a_warning(self):
        for lattice in ("spacing = 0.19, origin = [0.0] }", 'spacing = 0.4, origin = [0.0] }\nboundary = "cut"'):
            out, warnings, bodies = self.run_told(self.write(BAR.replace("spacing = 0.4, origin = [0.0] }", lattice)))
            self.assertRegex(out, r"particles 0\.95 m and 950 kg/m\^2, shape 0\.95 m and 950 kg/m\^2 \(\+0\.00 %\)")
            self.assertNotIn("warning: the particles", warnings)
            self.assertAlmostEqual(bodies[0]["particle_mass"], 950, delta=1e-6)

    def test_the_masses_are_those_of_the_frames(self):
        shape = "{ difference = [{ disc = { center = [2.0, 2.0], radius = 1.3 } }, { disc = { center = [2.2, 2.0], radius = 0.4 } }] }"
        exact = math.pi * (1.3**2 - 0.4**2)
        _, warnings, bodies = self.run_told(self.plane(shape))
        with h5py.File(frames(self.folder / "out")[0][0]) as file:
            mass = file["VTKHDF/PointData/mass"][:].sum()
        self.assertAlmostEqual(bodies[0]["particle_mass"] / mass, 1, delta=1e-12)
        self.assertAlmostEqual(bodies[0]["shape_volume"] / exact, 1, delta=1e-5)
        self.assertAlmostEqual(bodies[0]["shape_mass"] / (2000 * exact), 1, delta=1e-5)
        more = abs(mass / (2000 * exact) - 1) > 0.01
        self.assertEqual("warning: the particles of body 'block'" in warnings, more)

    def test_at_rollers_the_part_beyond_the_grid_is_left_out(self):
        _, warnings, bodies = self.run_told(self.plane("{ disc = { center = [0.0, 0.0], radius = 2.0 } }",
                                                       'particles_per_cell = 2\nboundary = "cut"',
                                                       faces='x_min = "roller", y_min = "roller"'))
        self.assertAlmostEqual(bodies[0]["shape_volume"] / math.pi, 1, delta=1e-5)
        self.assertAlmostEqual(bodies[0]["particle_volume"] / math.pi, 1, delta=2e-3)
        self.assertNotIn("warning: the particles", warnings)

    def test_rings_that_end_short_of_the_shape(self):
        rings = "lattice.concentric = { center = [2.0, 2.0], radii = [0.0, 1.0], rings = 8, per_ring = 40 }"
        _, warnings, bodies = self.run_told(self.plane("{ disc = { center = [2.0, 2.0], radius = 1.2 } }", rings))
        self.assertAlmostEqual(bodies[0]["particle_volume"], math.pi, delta=1e-9)
        self.assertAlmostEqual(bodies[0]["shape_volume"], math.pi * 1.44, delta=1e-4)
        self.assertRegex(warnings, r"'block' have .*\(-30\.56 %\): let radii, angles and layers of the lattice end where the shape does")

    def test_a_fit_of_moments_leaves_out_cells_without_a_particle(self):
        # Particles of 0.25 in cells of 0.5; the shape ends at 1.1, and no particle lies in the cells beyond 1.
        _, warnings, bodies = self.run_told(self.plane("{ box = { lower = [0.0, 0.0], upper = [1.1, 1.0] } }",
                                                       "particles_per_cell = 2\njitter = 0.1",
                                                       faces='x_min = "roller", y_min = "roller"', method="moment_fit = true"))
        self.assertAlmostEqual(bodies[0]["particle_volume"], 1.0, delta=1e-9)
        self.assertAlmostEqual(bodies[0]["shape_volume"], 1.1, delta=1e-9)
        self.assertRegex(warnings, r"\(-9\.09 %\): cells of the grid without a particle of it are left out")

    def test_slivers_of_a_cut_lattice(self):
        lattice = 'lattice.uniform = { spacing = 0.5, origin = [0.0, 0.0] }\nboundary = "cut"'
        _, warnings, bodies = self.run_told(self.plane("{ box = { lower = [0.5, 0.5], upper = [1.009, 1.0] } }", lattice))
        self.assertAlmostEqual(bodies[0]["shape_volume"], 0.509 * 0.5, delta=1e-9)
        self.assertAlmostEqual(bodies[0]["particle_volume"], 0.25, delta=1e-9)
        self.assertRegex(warnings, r"\(-1\.77 %\): what is missing lies in slivers")

    def test_on_a_polar_grid_the_arcs_count(self):
        grid = "{ polar = { radii = [1.0, 2.0], radial_cells = 4, angles = [0.0, 90.0], angular_cells = 6 } }"
        faces = 'theta_min = ["y"], theta_max = ["x"], r_min = "fixed", r_max = "fixed"'
        _, _, bodies = self.run_told(self.plane("{ disc = { center = [0.0, 0.0], radius = 5.0 } }", grid=grid, faces=faces))
        self.assertAlmostEqual(bodies[0]["shape_volume"] / (0.75 * math.pi), 1, delta=1e-5)
        self.assertAlmostEqual(bodies[0]["particle_volume"] / (0.75 * math.pi), 1, delta=1e-12)

    def test_every_body_has_its_line(self):
        other = PLANE[PLANE.index("[[body]]"):].format(shape="{ box = { lower = [2.5, 1.0], upper = [3.0, 2.0] } }",
                                                       lattice="particles_per_cell = 2").replace('"block"', '"post"')
        out, _, bodies = self.run_told(self.plane("{ box = { lower = [1.0, 1.0], upper = [2.0, 2.0] } }", more=other))
        self.assertEqual([body["name"] for body in bodies], ["block", "post"])
        self.assertEqual([body["shape_mass"] for body in bodies], [2000, 1000])
        for name in ("block", "post"):
            self.assertEqual(out.count(f"body '{name}': particles"), 1)


class Positions(GeometryTest):
    def refuse(self, scene, line, *words):
        done = vsb("run", scene, "--out", self.folder / "refused")
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        self.assertRegex(done.stderr, rf"^vsb: \S*scene\.toml:{line}:\d+: ")
        for word in words:
            self.assertIn(word, done.stderr)
        self.assertFalse((self.folder / "refused").exists())

    def test_messages_about_a_body_have_its_line(self):
        block = "{ box = { lower = [1.0, 1.0], upper = [2.0, 2.0] } }"
        second = PLANE[PLANE.index("[[body]]"):].format(shape=block, lattice="particles_per_cell = 2").replace('"block"', '"post"')
        self.refuse(self.plane("{ box = { lower = [1.0, 1.0], upper = [4.5, 2.0] } }"), 8, "body 'block'", "open face x_max")
        self.refuse(self.plane("{ box = { lower = [1.0, 1.0], upper = [1.01, 2.0] } }"), 8, "body 'block' has no particle")
        self.refuse(self.plane(block, more=second), 15, "body 'post' overlaps body 'block'")
        self.refuse(self.plane("{ box = { lower = [0.0, 0.5], upper = [1.0, 3.5] } }",
                               "lattice.uniform = { spacing = 0.5, origin = [-0.2, 0.0] }\njitter = 0.49", faces='x_min = "roller"'),
                    8, "body 'block': its jitter moves a particle out of the grid")

    def test_messages_about_a_traction_have_its_line(self):
        block = "{ box = { lower = [1.0, 1.0], upper = [2.0, 2.0] } }"
        nowhere = "\n[[traction]]\npressure = 1e3\nsurface = { box = { lower = [3.4, 3.4], upper = [3.6, 3.6] } }\n"
        self.refuse(self.plane(block, more=nowhere), 16, "traction 'traction 1' finds no boundary node")
        reaches = "\n[[traction]]\npressure = 1e3\n"
        self.refuse(self.plane("{ box = { lower = [1.0, 1.0], upper = [4.0, 2.0] } }", more=reaches), 8,
                    "body 'block' reaches the open face x_max")


class OpenFaces(GeometryTest):
    def test_a_body_at_an_open_face_without_a_load_is_warned_about(self):
        for shape, face in (("{ box = { lower = [1.0, 1.0], upper = [2.0, 4.0] } }", "y_max"),
                            ("{ box = { lower = [0.0, 1.0], upper = [2.0, 3.0] } }", "x_min"),
                            ("{ box = { lower = [1.0, 1.0], upper = [3.75, 2.0] } }", "x_max")):
            for command in ("check", "run"):
                done = vsb(command, self.plane(shape), *(("--out", self.folder / "out") if command == "run" else ()))
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertRegex(done.stderr, rf"warning: body 'block' has particles in the last cells before the open face {face}")

    def test_none_is_where_the_face_has_a_condition_or_an_empty_cell_before_it(self):
        for shape, faces in (("{ box = { lower = [0.0, 1.0], upper = [2.0, 3.0] } }", 'x_min = "roller"'),
                             ("{ box = { lower = [0.5, 0.5], upper = [3.5, 3.5] } }", "")):
            done = vsb("check", self.plane(shape, faces=faces))
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertNotIn("last cells", done.stderr)


class ManyShapes(GeometryTest):
    def test_shapes_nested_forty_deep(self):
        # A copy per level was a terabyte at forty.
        shape = "{ box = { lower = [1.0, 1.0], upper = [3.0, 3.0] } }"
        for level in range(40):
            disc = f"{{ disc = {{ center = [{1.2 + 0.04 * level:.2f}, 2.01], radius = 0.01 }} }}"
            shape = f"{{ difference = [{shape}, {disc}] }}"
        _, _, bodies = self.run_told(self.plane(shape))
        self.assertAlmostEqual(bodies[0]["shape_volume"], 4 - 40 * math.pi * 1e-4, delta=2e-4)


if __name__ == "__main__":
    unittest.main()
