# SPDX-License-Identifier: BSD-3-Clause
"""uGIMP and quadratic B-splines in scenes: patches, walls, what the grid's frames show, and refusals."""
import tomllib
import unittest

import h5py
import numpy as np
from vsb_program import SCENES, ProgramTest, last_fields, vsb

WIDE = ("ugimp", "quadratic_bspline")


def basis(name):
    return ("--set", f'method.basis="{name}"')


class Patches(ProgramTest):
    # A stiff column: uGIMP's particles keep their size, so its error grows with the strain, 2e-2 of it.
    STIFF = ("--set", "body[0].material.youngs_modulus=1e7", "--set", "time.dt=1e-4", "--set", "method.damping=0.2",
             "--set", "method.volume_update=exponential")

    def test_uniaxial_stress_wherever_the_end_lies_in_its_cell(self):
        for name in WIDE:
            for end in (9.125, 9.375, 9.5, 9.625, 9.875):
                errors = self.run_scene("column", *basis(name), *self.STIFF, "--set", f"body[0].shape.box.upper=[{end}]")["errors"]
                self.assertLess(errors["e_sigma"], 1e-7, f"{name} {end}")

    def test_rollers_on_a_grid_of_one_cell(self):
        for name in WIDE:
            errors = self.run_scene("column-2d", *basis(name), *self.STIFF)["errors"]
            self.assertLess(errors["e_sigma"], 1e-7, name)
            stress = last_fields(self.folder / "column-2d")["cauchy_stress"]
            np.testing.assert_allclose(stress[:, 3:], 0, rtol=0, atol=1e-12, err_msg=name)

    def test_surface_points_load_the_same_bar(self):
        for name in WIDE:
            for imposition in ("boundary_particles", "material_points"):
                summary = self.run_scene("column", *basis(name), "--set", f'traction[0].imposition="{imposition}"')
                stress = last_fields(self.folder / "column")["cauchy_stress"][:, 0]
                # Far from the loaded end the bar carries the load.
                np.testing.assert_allclose(stress[:48], -1, rtol=0, atol=5e-3, err_msg=f"{name} {imposition}")
                self.assertAlmostEqual(summary["net_force"][0], -1, delta=1e-9)


class Frames(ProgramTest):
    def test_nodes_of_the_scene_carry_all_mass(self):
        for name in WIDE:
            out = self.folder / name
            done = vsb("run", SCENES / "cylinder.toml", *basis(name), "--set", "output.grid=true", "--quiet",
                       "--set", "time.until_static.max_steps=3", "--out", out)
            self.assertEqual(done.returncode, 7, done.stderr)
            last = sorted(out.glob("cylinder_grid_*.hdf"))[-1]
            with h5py.File(last) as file:
                mass = file["VTKHDF/PointData/mass"][()]
                self.assertEqual(len(mass), 25 * 25)
                self.assertEqual(len(file["VTKHDF/Points"]), 25 * 25)
            self.assertAlmostEqual(mass.sum() / last_fields(out)["mass"].sum(), 1, delta=1e-12)

    def test_threads_do_not_matter(self):
        for name in WIDE:
            hashes = {self.run_scene("cylinder", *basis(name), "--set", "time.until_static.max_steps=100", out=f"{name}{n}",
                                     environment={"OMP_NUM_THREADS": str(n)})["state_hash"] for n in (1, 3)}
            self.assertEqual(len(hashes), 1, name)


class Accurate(ProgramTest):
    """The setting by its name, judged by the static solver."""
    HALF = ("--static", "--set", "grid.spacing=0.5")

    def test_what_the_name_stands_for(self):
        by_name = self.run_scene("cylinder-accurate", *self.HALF)
        by_keys = self.run_scene("cylinder", *self.HALF, *basis("quadratic_bspline"), "--set", "body[0].particles_per_cell=2",
                                 "--set", 'body[0].boundary="cut2x2"')
        self.assertEqual(by_name["state_hash"], by_keys["state_hash"])
        for name, most in (("e_rr", 1.1 * 9.5e-3), ("e_tt", 1.1 * 8.6e-3)):  # of the independent prototype
            self.assertLess(by_name["errors"][name], most)
        whole = self.run_scene("cylinder-accurate", *self.HALF, "--set", 'body[0].boundary="keep"')
        self.assertNotEqual(by_name["particles"], whole["particles"])

    def test_a_slab_in_space_has_the_errors_of_the_plane(self):
        plane = self.run_scene("cylinder-accurate", *self.HALF)["errors"]
        slab = ((SCENES / "cylinder-accurate.toml").read_text().replace("dimension = 2", "dimension = 3")
                .replace("lower = [0.0, 0.0]\nupper = [6.0, 6.0]", "lower = [0.0, 0.0, 0.0]\nupper = [6.0, 6.0, 0.5]")
                .replace('y_min = "roller"', 'y_min = "roller"\nz_min = "roller"\nz_max = "roller"')
                .replace("disc = { center = [0.0, 0.0], radius", "cylinder = { axis = 'z', center = [0.0, 0.0, 0.0], radius"))
        space = self.run_scene(self.write(slab), *self.HALF)["errors"]
        for name in ("e_rr", "e_tt"):  # shares of boxes are sampled at fewer lines in space
            self.assertAlmostEqual(space[name] / plane[name], 1, delta=1e-3, msg=name)

    def test_where_it_cannot_be(self):
        for scene, arguments, word in (("cylinder-polar", (), "uniform grids"), ("cylinder", ("--set", "precision=float"), "double")):
            done = vsb("check", SCENES / f"{scene}.toml", "--set", "setting=accurate", *arguments)
            self.assertEqual(done.returncode, 2)
            for part in ("method.basis", "accurate", word):
                self.assertIn(part, done.stderr)
        done = vsb("check", SCENES / "cylinder.toml", "--set", "setting=acurate")
        self.assertEqual(done.returncode, 2)
        self.assertIn("did you mean 'accurate'", done.stderr)


class Carried(ProgramTest):
    def test_a_comparison_about_a_moved_axis(self):
        def e_u(speed, moved, *more):
            return self.run_scene("cylinder-carried", "--set", "time.steps=1", "--set", f"body[0].velocity=[{speed},0.0]",
                                  "--set", f"compare.moved=[{moved},0.0]", *more)["errors"]["e_u"]
        at_rest = e_u(0.0, 0.0)
        self.assertAlmostEqual(e_u(0.625, 0.625 * 2e-4) / at_rest, 1, delta=1e-6)  # dt = 2e-4 s
        self.assertGreater(e_u(0.625, 0.0), 1.1 * at_rest)
        self.assertGreater(e_u(0.0, 0.0, "--set", "compare.center=[0.3,0.0]"), 1.001 * at_rest)


class Keys(ProgramTest):
    def check(self, *arguments, scene="cylinder"):
        return vsb("check", SCENES / f"{scene}.toml", *arguments)

    def test_half_width_of_the_particles(self):
        done = self.check(*basis("ugimp"))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("gimp_half_width = 0.125", done.stdout)
        done = self.check(*basis("ugimp"), "--set", "method.gimp_half_width=0.25")
        self.assertIn("gimp_half_width = 0.25", done.stdout)
        done = self.check(*basis("ugimp"), scene="cylinder-concentric")
        self.assertEqual(done.returncode, 2)
        self.assertIn("method.gimp_half_width is missing", done.stderr)
        for bad in ("0", "0.6", "-0.1", "[0.1]", '"wide"'):
            done = self.check(*basis("ugimp"), "--set", f"method.gimp_half_width={bad}")
            self.assertEqual(done.returncode, 2, bad)
            self.assertIn("gimp_half_width", done.stderr)
        done = self.check(*basis("linear"), "--set", "method.gimp_half_width=0.25")
        self.assertEqual(done.returncode, 2)
        self.assertIn('is for basis = "ugimp"', done.stderr)

    def test_what_only_the_linear_basis_can_do(self):
        for name in WIDE:
            for scene, arguments, word in (
                    ("cylinder-polar", (), "uniform grids"),
                    ("cylinder", ("--set", "precision=float"), "double"),
                    ("cylinder", ("--set", 'traction[0].imposition="nodal"'), "at a node"),
                    ("cylinder", ("--set", 'traction[0].imposition="virtual_stress_original"'), "whole cells")):
                done = self.check(*basis(name), *arguments, scene=scene)
                self.assertEqual(done.returncode, 2, f"{name} {scene} {arguments}")
                self.assertIn("method.basis", done.stderr)
                self.assertIn(word, done.stderr)
        done = self.check(*basis("cubic"))
        self.assertEqual(done.returncode, 2)
        self.assertIn("quadratic_bspline", done.stderr)

    def test_the_recovered_stress_is_for_the_linear_basis(self):
        text = (SCENES / "cylinder.toml").read_text()
        for name in WIDE:
            scene = text + '\n[output]\nfields = ["id", "recovered_stress"]\n'
            line = scene[:scene.index("fields =")].count("\n") + 1
            done = vsb("check", self.write(scene), *basis(name))
            self.assertEqual(done.returncode, 2, name)
            self.assertRegex(done.stderr, rf"scene\.toml:{line}:\d+: .*output\.fields")
            self.assertIn('is for method.basis = "linear"', done.stderr)
            scene = text.replace("[compare]\n", "[compare]\nrecovered = true\n")
            line = scene[:scene.index("recovered =")].count("\n") + 1
            done = vsb("check", self.write(scene), *basis(name))
            self.assertEqual(done.returncode, 2, name)
            self.assertRegex(done.stderr, rf"scene\.toml:{line}:\d+: .*compare\.recovered")
            self.assertIn('is for method.basis = "linear"', done.stderr)
            allowed = ("--set", "compare.recovered=false", "--set", "compare.cell_means=true")
            self.assertEqual(self.check(*basis(name), *allowed).returncode, 0, name)

    def test_particles_on_grid_lines_do_no_harm(self):
        # Points at 0.125 m (k + 1), every eighth of them on a line between cells of 1 m.
        text = (SCENES / "column.toml").read_text().replace(
            "particles_per_cell = 8", "lattice = { uniform = { spacing = 0.125, origin = [0.0625] } }")
        path = self.write(text)
        self.assertEqual(vsb("check", path).returncode, 2)
        for name in WIDE:
            self.assertEqual(vsb("check", path, *basis(name)).returncode, 0)

    def test_resolved_scene_is_read_as_itself(self):
        for name in WIDE:
            done = self.check(*basis(name))
            text = done.stdout[done.stdout.index("name ="):]
            self.assertIn(f"basis = '{name}'", text)
            tomllib.loads(text)


if __name__ == "__main__":
    unittest.main()
