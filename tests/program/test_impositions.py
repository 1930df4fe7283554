# SPDX-License-Identifier: BSD-3-Clause
"""Five ways to impose a traction, on lines, planes and bodies: errors of Table 2, resultants, conforming loads."""
import json
import os
import pathlib
import re
import unittest

import numpy as np
from vsb_program import PROGRAM, SCENES, ProgramTest, last_fields, vsb

ALL = ("virtual_stress", "virtual_stress_original", "boundary_particles", "material_points", "nodal")


def imposed(by, traction=0):
    return ("--set", f'traction[{traction}].imposition="{by}"')


class Column(ProgramTest):
    # e_sigma of Table 2; that of the material points is the independent prototype's.
    STRESS_ERRORS = {"virtual_stress_original": 9.7479e-4, "boundary_particles": 4.2490e-3, "material_points": 3.2827e-2}

    def test_planes_and_space_agree_with_the_line(self):
        for by, expected in self.STRESS_ERRORS.items():
            for scene in ("column-2d", "column-3d"):
                errors = self.run_scene(scene, *imposed(by))["errors"]
                self.assertAlmostEqual(errors["e_sigma"] / expected, 1, delta=1e-4, msg=f"{by} {scene}")

    def test_gauss_points_do_not_matter_to_a_uniform_field(self):
        hashes = []
        for points in (1, 2, 3, 4):
            errors = self.run_scene("column-2d", *imposed("virtual_stress_original"), "--set", "time.steps=3000",
                                    "--set", f"method.cell_gauss_points={points}")["errors"]
            hashes.append(errors["e_sigma"])
        np.testing.assert_allclose(hashes, hashes[0], rtol=1e-9)

    def test_closed_forms_of_the_last_cell(self):
        # Original: the last cell has -t exactly. Boundary particles: -0.981973 t.
        for by, expected in (("virtual_stress_original", -1.0), ("boundary_particles", -0.981973)):
            self.run_scene("column", *imposed(by))
            fields = last_fields(self.folder / "column")
            last = fields["position"][:, 0] - fields["displacement"][:, 0] > 9
            np.testing.assert_allclose(fields["cauchy_stress"][last, 0], expected, atol=1e-6, err_msg=by)

    def test_conforming_load(self):
        # A column that fills its nine cells, loaded at the nodes of its end: sigma A = t, A = 1.
        for scene, box in (("column", "[9.0]"), ("column-2d", "[9.0, 1.0]"), ("column-3d", "[9.0, 1.0, 1.0]")):
            self.run_scene(scene, *imposed("nodal"), "--set", f"body[0].shape.box.upper={box}",
                           "--set", "method.volume_update=exponential")
            stress = last_fields(self.folder / scene)["cauchy_stress"][:, 0]
            # The nodes stay while the column shortens by t/E: its last cell is not quite full.
            np.testing.assert_allclose(stress, -1, atol=2e-3, err_msg=scene)

    def test_a_surface_that_is_not_there_is_an_error(self):
        for by in ("boundary_particles", "material_points", "nodal"):
            done = vsb("run", SCENES / "column.toml", "--out", self.folder / "x", *imposed(by),
                       "--set", "traction[0].surface={ball={center=[3.0],radius=0.2}}")
            self.assertEqual(done.returncode, 2, by)
            self.assertIn("finds no surface", done.stderr)
        done = vsb("run", SCENES / "column.toml", "--out", self.folder / "x", *imposed("material_points"),
                   "--set", "traction[0].layer={ball={center=[3.0],radius=0.2}}")
        self.assertEqual(done.returncode, 2)
        self.assertIn("check its 'layer'", done.stderr)


class Resultants(ProgramTest):
    def resultant(self, by, *more):
        done = vsb("check", SCENES / "cylinder-free.toml", *imposed(by), *more)
        self.assertEqual(done.returncode, 0, done.stderr)
        number = r"([-+.\de]+)"
        found = re.search(rf"resultant of the tractions \({number}, {number}, {number}\) N, on the exact surface "
                          rf"\({number}, {number}", done.stdout)
        force = [float(f) for f in found.groups()]
        return np.hypot(*force[:2]) / 1e5, np.hypot(*force[3:]) / 1e5

    def test_closed_surface_under_uniform_pressure(self):
        modified, exact = self.resultant("virtual_stress")
        self.assertAlmostEqual(modified, 0.05, delta=0.002)  # p a; the independent prototype's figure
        self.assertLess(exact, 1e-14)
        for by in ("virtual_stress_original", "boundary_particles", "material_points"):
            self.assertLess(self.resultant(by)[0], 1e-14, by)

    def test_quarter_between_symmetry_planes(self):
        for by in ALL[:4]:
            force = self.run_scene("cylinder", *imposed(by), "--set", "grid.spacing=0.5")["net_force"]
            np.testing.assert_allclose(force[:2], 1e5, rtol=0.05, err_msg=by)


class Cylinder(ProgramTest):
    def test_a_slab_in_space_has_the_errors_of_the_plane(self):
        plane = self.run_scene("cylinder", "--set", "grid.spacing=0.5")["errors"]
        text = (SCENES / "cylinder.toml").read_text()
        slab = (text.replace("dimension = 2", "dimension = 3")
                .replace("lower = [0.0, 0.0]\nupper = [6.0, 6.0]\nspacing = 0.25",
                         "lower = [0.0, 0.0, 0.0]\nupper = [6.0, 6.0, 0.5]\nspacing = 0.5")
                .replace('y_min = "roller"', 'y_min = "roller"\nz_min = "roller"\nz_max = "roller"')
                .replace("particles_per_cell = 4", "particles_per_cell = [4, 4, 1]")
                .replace("disc = { center = [0.0, 0.0], radius", "cylinder = { axis = 'z', center = [0.0, 0.0, 0.0], radius"))
        space = self.run_scene(self.write(slab))["errors"]
        for name, error in plane.items():
            self.assertAlmostEqual(space[name] / error, 1, delta=1e-6, msg=name)

    def test_original_and_modified_stresses_differ_little(self):
        by = {way: self.run_scene("cylinder-concentric", *imposed(way), "--set", "grid.spacing=0.5",
                                  "--set", "body[0].lattice.concentric.rings=32",
                                  "--set", "body[0].lattice.concentric.per_ring=38")["errors"]
              for way in ("virtual_stress", "virtual_stress_original")}
        for name in ("e_rr", "e_tt"):
            self.assertLess(abs(by["virtual_stress"][name] - by["virtual_stress_original"][name]), 2e-4, name)
            self.assertNotEqual(by["virtual_stress"][name], by["virtual_stress_original"][name])


class Ellipse(ProgramTest):
    EXPECTED = {"ellipse": (4.83e-3, 7.69e-3, 2.67e-3), "ellipse-exact": (4.32e-3, 7.07e-3, 2.67e-3)}

    def test_errors_of_the_coarsest_mesh(self):
        for scene, expected in self.EXPECTED.items():
            summary = self.run_scene(scene, "--set", "grid.spacing=1", "--set", "time.kappa=0.8")
            self.assertEqual(summary["particles"], 3563)  # Table 10
            for name, value in zip(("e_xx", "e_yy", "e_xy"), expected):
                self.assertAlmostEqual(summary["errors"][name] / value, 1, delta=0.03, msg=f"{scene} {name}")

    def test_exact_fields_are_of_plane_strain_and_there_may_be_several(self):
        done = vsb("check", SCENES / "ellipse-exact.toml", "--set", "traction[1].pressure=1.0")
        self.assertEqual(done.returncode, 2)
        self.assertIn("beside 'pressure': give one of pressure, stress, affine", done.stderr)
        text = (SCENES / "ellipse-exact.toml").read_text()
        exact = re.search(r"^exact_ellipse = .*$", text, re.MULTILINE).group()
        # The exact stress has the pressure as its traction on the hole.
        twice = text.replace("pressure = 12.5e3\nsurface", exact + "\nsurface")
        self.assertEqual(twice.count("exact_ellipse"), 2)
        forces = [self.run_scene(self.write(t, "e.toml"), "--set", "time.until_static.max_steps=400")["exact_force"]
                  for t in (text, twice)]
        for i in (0, 1):
            self.assertAlmostEqual(forces[1][i] / forces[0][i], 1, delta=1e-2)
        done = vsb("check", SCENES / "column.toml", "--set", "traction[0].exact_ellipse={semi_major=2}")
        self.assertEqual(done.returncode, 2)


class SameBits(ProgramTest):
    SHORT = ("--set", "grid.spacing=0.5", "--set", "time.until_static.max_steps=400")

    def test_threads_and_backends(self):
        other = os.environ.get("VSB_SERIAL_PROGRAM", "")
        programs = [PROGRAM] + ([other] if pathlib.Path(other).is_file() else [])
        for by in ALL[1:4]:
            hashes = set()
            for program in programs:
                for threads in (1, 3) if program == PROGRAM else (1,):
                    hashes.add(self.run_scene("cylinder", *imposed(by), *self.SHORT, "--threads", threads, program=program,
                                              environment={"OMP_WAIT_POLICY": "passive"})["state_hash"])
            self.assertEqual(len(hashes), 1, by)

    def test_resuming_changes_no_bit(self):
        for engine, by in (("cell_lanes", "boundary_particles"), ("cell_lanes", "material_points"),
                           ("cell_lanes", "virtual_stress_original"), ("particles", "boundary_particles")):
            with self.subTest(engine=engine, by=by):
                steps = 20000 if engine == "cell_lanes" else 2000  # about a second: neither is static by then
                self.resume("cylinder", *imposed(by), "--set", f"method.engine={engine}", "--set", "grid.spacing=0.5", "--set",
                            f"time.until_static.max_steps={steps}", "--set", "time.until_static.force_ratio=1e-14", pause=0.3)


if __name__ == "__main__":
    unittest.main()
