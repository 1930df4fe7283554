# SPDX-License-Identifier: BSD-3-Clause
"""Lattices of bodies, particles on grid lines, the fill criterion, and loads that are smooth or periodic in time."""
import math
import re
import tomllib
import unittest

import numpy as np
from vsb_program import SCENES, ProgramTest, last_fields, vsb

SCENE = """
name = "s"
dimension = {dimension}
grid = {{ lower = {lower}, upper = {upper}, spacing = 0.5 }}
{faces}
[[body]]
shape = {shape}
{lattice}
density = 1000.0
material = {{ youngs_modulus = 1e6, poisson_ratio = 0.3 }}
{more}
[time]
{time}
"""
STILL = "dt = 1e-9\nsteps = 1"
BLOCK = "{ box = { lower = [0.0, 0.0], upper = [2.0, 2.0] } }"


def vector(x, dimension):
    return x if isinstance(x, list) else [float(x)] * dimension


class LatticeTest(ProgramTest):
    def scene(self, shape, lattice, dimension=2, lower=-4, upper=4, faces="", more="", time=STILL):
        return self.write(SCENE.format(dimension=dimension, lower=vector(lower, dimension), upper=vector(upper, dimension),
                                       faces=faces, shape=shape, lattice=lattice, more=more, time=time))

    def start(self, *arguments, **options):
        """Where the particles start, and their volumes."""
        self.run_scene(self.scene(*arguments, **options), out="s")
        fields = last_fields(self.folder / "s")
        return fields["position"] - fields["displacement"], fields["volume"]

    def refuse(self, scene, *words):
        done = vsb("run", scene, "--out", self.folder / "refused")
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        for word in words:
            self.assertIn(word, done.stderr)
        self.assertFalse((self.folder / "refused").exists())
        return done.stderr


def rows(points):
    """Points as a sorted array, rounded, for comparison as sets."""
    return np.array(sorted(map(tuple, np.round(np.asarray(points, dtype=float), 7) + 0.0)))


class Uniform(LatticeTest):
    def test_points_of_a_spacing_and_an_origin_that_the_grid_does_not_share(self):
        x, volume = self.start("{ box = { lower = [-1.0, -1.0], upper = [1.0, 1.0] } }",
                               "lattice.uniform = { spacing = [0.3, 0.7], origin = [0.02, 5.03] }")
        expected = [(0.02 + 0.3 * (i + 0.5), 5.03 + 0.7 * (j + 0.5), 0) for i in range(-40, 40) for j in range(-40, 40)]
        np.testing.assert_allclose(rows(x), rows([p for p in expected if max(map(abs, p)) <= 1]), atol=2e-7)
        np.testing.assert_allclose(volume, 0.21, rtol=1e-6)

    def test_by_default_it_starts_at_the_grids_corner_so_that_cells_can_be_divided_evenly(self):
        for lattice, twin in (("lattice.uniform = { spacing = 0.125 }", "particles_per_cell = 4"),
                              ("lattice.uniform = { spacing = [0.25, 0.5] }", "particles_per_cell = [2, 1]")):
            shape = "{ disc = { center = [0.3, 0.1], radius = 2.0 } }"
            got, twins = self.start(shape, lattice), self.start(shape, twin)
            np.testing.assert_array_equal(got[0], twins[0])
            np.testing.assert_array_equal(got[1], twins[1])

    def test_in_one_and_three_dimensions_and_cut_by_the_grid(self):
        x, volume = self.start("{ half_space = { point = [1.0], normal = [1.0] } }",
                               "lattice.uniform = { spacing = 0.3, origin = [100.1] }", dimension=1)
        expected = [100.1 + 0.3 * (k + 0.5) for k in range(-400, 0)]
        np.testing.assert_allclose(np.sort(x[:, 0]), [e for e in expected if -4 <= e <= 1], atol=1e-6)
        np.testing.assert_allclose(volume, 0.3, rtol=1e-6)
        x, volume = self.start("{ box = { lower = [0.0, 0.0, 0.0], upper = [1.0, 1.0, 1.0] } }",
                               "lattice.uniform = { spacing = [0.3, 0.25, 0.5], origin = [0.0, 0.0, 0.0] }", dimension=3)
        expected = [(i, j, k) for i in (0.15, 0.45, 0.75) for j in (0.125, 0.375, 0.625, 0.875) for k in (0.25, 0.75)]
        np.testing.assert_allclose(rows(x), rows(expected), atol=2e-7)
        np.testing.assert_allclose(volume, 0.0375, rtol=1e-6)

    def test_bad_values(self):
        for lattice, word in (("lattice.uniform = { spacing = 0 }", "body[0].lattice.uniform.spacing"),
                              ("lattice.uniform = { spacing = 1e-9 }", "1e10 points"),
                              ("lattice.uniform = { spacing = 0.1, origin = [1e12, 0.0] }", "1e9 spacings"),
                              ("lattice.uniform = { spacing = 0.1, origin = 0 }", "array of 2 finite numbers"),
                              ("lattice.uniform = { origin = [0.0, 0.0] }", "spacing is missing"),
                              ("lattice.uniform = { spacing = 0.1, orign = [0.0, 0.0] }", "did you mean 'origin'"),
                              ("lattice = { regular = { spacing = 0.1 } }", "unknown key 'regular' in body[0].lattice (allowed here: concentric, uniform)"),
                              ("lattice = {}", "one of uniform and concentric"),
                              ("lattice = 3", "must be a table"),
                              ("lattice.uniform = { spacing = 0.1 }\nlattice.concentric = {}", "one of uniform and concentric"),
                              ("lattice.uniform = { spacing = 0.1 }\nparticles_per_cell = 2", "not both"),
                              ("lattise.uniform = { spacing = 0.1 }", "did you mean 'lattice'"),
                              ("", "lattice.uniform or lattice.concentric")):
            message = self.refuse(self.scene(BLOCK, lattice), word)
            self.assertRegex(message, r"scene\.toml:\d+:\d+: ")


class Concentric(LatticeTest):
    RINGS = "lattice.concentric = {{ center = [0.0, 0.0], radii = [1.0, 3.0], rings = 4, per_ring = {n}, angles = {angles} }}"
    EVERYWHERE = "{ disc = { center = [0.0, 0.0], radius = 9.0 } }"

    def test_rings_angles_and_sector_areas(self):
        x, volume = self.start(self.EVERYWHERE, self.RINGS.format(n=6, angles="[-30.0, 105.0]"))
        radii = [1.25, 1.75, 2.25, 2.75]
        expected = [(r * math.cos(math.radians(t)), r * math.sin(math.radians(t)), 0)
                    for r in radii for t in np.arange(6) * 22.5 - 30 + 11.25]
        np.testing.assert_allclose(rows(x), rows(expected), atol=2e-7)
        # A sector of the ring between s and s + 1/2: (22.5 / 360) pi ((s + 1/2)^2 - s^2).
        areas = [math.pi / 16 * ((s + 0.5)**2 - s**2) for s in (1, 1.5, 2, 2.5)]
        np.testing.assert_allclose(np.sort(volume), np.repeat(areas, 6), rtol=1e-6)

    def test_full_circles_are_the_default_and_the_shape_still_decides(self):
        lattice = self.RINGS.format(n=40, angles="[0, 360]").replace(", angles = [0, 360]", "")
        _, volume = self.start(self.EVERYWHERE, lattice)
        self.assertAlmostEqual(volume.sum() / (8 * math.pi), 1, delta=1e-6)
        x, volume = self.start("{ half_space = { point = [0.0, 0.0], normal = [-1.0, 0.0] } }", lattice)
        self.assertAlmostEqual(volume.sum() / (4 * math.pi), 1, delta=1e-6)
        self.assertGreater(x[:, 0].min(), 0)

    def test_a_grid_that_ends_at_symmetry_planes_cuts_out_the_quarter(self):
        quarter = self.start(self.EVERYWHERE, self.RINGS.format(n=7, angles="[0, 90]"))
        cut = self.start(self.EVERYWHERE, self.RINGS.format(n=28, angles="[0, 360]"), lower=0,
                         faces='faces = { x_min = "roller", y_min = "roller" }')
        np.testing.assert_allclose(rows(cut[0]), rows(quarter[0]), atol=2e-7)

    def test_layers_in_space(self):
        lattice = self.RINGS.format(n=5, angles="[10, 370]")[:-2] + ", layers = { lower = -1.0, upper = 0.5, count = 3 } }"
        x, volume = self.start("{ cylinder = { center = [0.0, 0.0, 0.0], radius = 9.0 } }", lattice.replace("}}", "}"),
                               dimension=3)
        self.assertEqual(len(x), 4 * 5 * 3)
        np.testing.assert_allclose(np.unique(np.round(x[:, 2], 6)), [-0.75, -0.25, 0.25])
        self.assertAlmostEqual(volume.sum() / (8 * math.pi * 1.5), 1, delta=1e-6)
        np.testing.assert_allclose(np.unique(np.round(np.hypot(x[:, 0], x[:, 1]), 5)), [1.25, 1.75, 2.25, 2.75])

    def test_bad_values(self):
        good = self.RINGS.format(n=4, angles="[0, 90]")
        for old, new, word in (("[1.0, 3.0]", "[3.0, 1.0]", "outer radius must be greater"),
                               ("[1.0, 3.0]", "[-1.0, 1.0]", ">= 0"),
                               ("rings = 4", "rings = 0", "from 1"), ("per_ring = 4", "per_ring = 0", "from 1"),
                               ("per_ring = 4", "per_rings = 4", "did you mean 'per_ring'"),
                               ("[0, 90]", "[90, 0]", "at most 360"), ("[0, 90]", "[0, 361]", "at most 360"),
                               ("center = [0.0, 0.0]", "center = [0.0]", "array of 2 finite numbers"),
                               ("rings = 4", "rings = 4, layers = { lower = 0, upper = 1, count = 1 }", "dimension 3"),
                               ("angles = [0, 90] }", "angles = [0, 90] }\njitter = 0.1", "not for rings"),
                               ("angles = [0, 90] }", "angles = [0, 90] }\nseed = 3", "not for rings")):
            self.assertEqual(good.count(old), 1, old)
            self.assertRegex(self.refuse(self.scene(self.EVERYWHERE, good.replace(old, new)), word), r"scene\.toml:\d+:\d+: ")
        self.refuse(self.scene("{ box = { lower = [0.0], upper = [1.0] } }", good, dimension=1), "dimension 2 or 3")
        ball = "{ ball = { center = [0.0, 0.0, 0.0], radius = 3.0 } }"
        self.refuse(self.scene(ball, good, dimension=3), "layers is missing")
        self.refuse(self.scene(ball, good[:-2] + ", layers = { lower = 1, upper = 1, count = 1 } }", dimension=3), "layers.upper")


class Jitter(LatticeTest):
    def test_shifts_are_bounded_repeatable_and_know_nothing_of_the_shape(self):
        square = "{ box = { lower = [-2.0, -2.0], upper = [2.0, 2.0] } }"
        part = "{ box = { lower = [-0.5, -1.0], upper = [2.0, 1.0] } }"
        plain, _ = self.start(square, "particles_per_cell = 4")
        moved, volume = self.start(square, "particles_per_cell = 4\njitter = 0.2\nseed = 7")
        shift = (moved - plain)[:, :2] / 0.125
        self.assertEqual(len(shift), 32 * 32)
        np.testing.assert_allclose(volume, 0.125**2, rtol=1e-6)
        # 2048 numbers, uniform in [-0.2, 0.2]: mean 0, variance 0.2^2 / 3, directions and neighbours independent.
        self.assertLessEqual(np.abs(shift).max(), 0.2 + 1e-5)
        self.assertGreater(np.abs(shift).max(axis=0).min(), 0.198)
        sigma = 0.2 / math.sqrt(3 * len(shift))
        np.testing.assert_allclose(shift.mean(axis=0), 0, atol=4 * sigma)
        np.testing.assert_allclose(shift.var(axis=0), 0.04 / 3, rtol=0.12)
        for a, b in ((shift[:, 0], shift[:, 1]), (shift[:-1, 0], shift[1:, 0]), (shift[:-32, 0], shift[32:, 0])):
            self.assertLess(abs(np.corrcoef(a, b)[0, 1]), 4 / math.sqrt(len(shift)))

        again, _ = self.start(part, "particles_per_cell = 4\njitter = 0.2\nseed = 7")
        inside = (plain[:, 0] > -0.5) & (np.abs(plain[:, 1]) < 1)
        self.assertEqual(inside.sum(), 20 * 16)
        np.testing.assert_allclose(again, moved[inside], rtol=0, atol=1e-12)
        other, _ = self.start(square, "particles_per_cell = 4\njitter = 0.2\nseed = 8")
        self.assertGreater(np.abs(other - moved).max(), 0.03)

    def test_every_direction_of_a_uniform_lattice_moves_by_its_own_spacing(self):
        lattice = "lattice.uniform = { spacing = [0.25, 0.05, 0.5] }"
        box = "{ box = { lower = [0.0, 0.0, 0.0], upper = [4.0, 1.0, 4.0] } }"
        plain, _ = self.start(box, lattice, dimension=3, lower=0, upper=4)
        moved, _ = self.start(box, lattice + "\njitter = 0.45", dimension=3, lower=0, upper=4)
        largest = np.abs(moved - plain).max(axis=0) / [0.25, 0.05, 0.5]
        np.testing.assert_allclose(largest, 0.45, rtol=0.03)

    def test_bad_values(self):
        for line, word in (("jitter = 0.5", ">= 0 and < 0.5"), ("jitter = -0.1", ">= 0 and < 0.5"), ("seed = -1", "seed"),
                           ("seed = 1.5", "integer"), ("jiter = 0.1", "did you mean 'jitter'")):
            self.refuse(self.scene(BLOCK, "particles_per_cell = 2\n" + line), word, "scene.toml:9:")

    def test_a_shift_out_of_the_grid_is_refused(self):
        # Unshifted, the points closest to the grid's face lie a hundredth of a spacing inside.
        self.refuse(self.scene(BLOCK, "lattice.uniform = { spacing = 0.2, origin = [0.102, 0.0] }\njitter = 0.4", lower=0),
                    "jitter moves a particle out of the grid")


class GridLines(LatticeTest):
    ON_LINES = "lattice.uniform = { spacing = 0.25, origin = [0.125, 0.0] }"  # x = 0, 0.25, 0.5, ...; y = 0.125, ...

    def test_refused_with_their_number_and_what_to_do(self):
        # Of x = 0, ..., 2 every other one is on a line: 5 of 9 columns of 8. Both ends are lines inside the grid.
        message = self.refuse(self.scene(BLOCK, self.ON_LINES), "40 of 72 particles lie on a grid line", "(0, 0.125, 0)",
                              "shift the grid", "method.allow_particles_on_grid_lines")
        self.assertNotIn("warning", message)

    def test_a_face_of_the_grid_is_no_grid_line(self):
        self.refuse(self.scene(BLOCK, self.ON_LINES, lower=0), "32 of 72 particles")  # x = 0.5, 1, 1.5, 2
        narrow = "{ box = { lower = [0.0, 0.0], upper = [0.3, 2.0] } }"
        x, _ = self.start(narrow, self.ON_LINES, lower=0)
        self.assertEqual(len(x), 16)

    def test_allowed_with_one_warning(self):
        done = vsb("run", self.scene(BLOCK, self.ON_LINES, more="[method]\nallow_particles_on_grid_lines = true"), "--quiet",
                   "--out", self.folder / "s")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stderr.count("warning: 40 of 72 particles lie on a grid line"), 1)
        done = vsb("run", self.scene(BLOCK, "particles_per_cell = 3"), "--quiet", "--out", self.folder / "t")
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_in_the_last_direction_of_space_and_in_1d(self):
        box = "{ box = { lower = [0.0, 0.0, 0.0], upper = [1.0, 1.0, 1.0] } }"
        self.refuse(self.scene(box, "lattice.uniform = { spacing = [0.25, 0.25, 0.2], origin = [0.0, 0.0, -0.1] }", dimension=3),
                    "32 of 96 particles lie on a grid line, the first at (0.125, 0.125, 0)")  # z = 0 and 1 of 0, 0.2, ..., 1
        self.refuse(self.scene("{ box = { lower = [0.1], upper = [1.2] } }",
                               "lattice.uniform = { spacing = 1.0, origin = [0.0] }", dimension=1), "1 of 1 particles")

    def test_a_jitter_moves_them_off(self):
        x, _ = self.start(BLOCK, self.ON_LINES + "\njitter = 0.1")
        self.assertEqual(len(x), 72)


class FillCriterion(LatticeTest):
    H1 = ("--set", "grid.spacing=1.0")

    def test_cylinder_with_a_node_at_the_centre_of_the_hole(self):
        # Every cell that touches the hole holds a particle, so no cell there is void and none is E2.
        done = vsb("run", SCENES / "cylinder.toml", *self.H1, "--out", self.folder / "refused")
        self.assertEqual(done.returncode, 2, done.stdout)
        for word in ("finds no boundary node", "method.fill_criterion"):
            self.assertIn(word, done.stderr)
        summary = self.run_scene("cylinder", *self.H1, "--set", "method.fill_criterion=0.05")
        # Only the cell [0, 1]^2 is not full: 3 of its 16 lattice points lie outside the hole. Its four corners are loaded;
        # the forces along x on those at x = 1, -p sum V dN/dx: -3/16 p from [0, 1]^2, p from the cell to its right, +-p/2
        # from the two above. Those at x = 0 have 3/16 p beyond what closes the body at the support.
        self.assertEqual(summary["boundary_nodes"], 4)
        for component in (0, 1):
            self.assertAlmostEqual(summary["net_force"][component] / 1e5, 1, delta=1e-3)
        self.assertTrue(summary["static"])
        self.assertLess(summary["errors"]["e_rr"], 0.2)

    def test_off_by_default_and_no_effect_where_all_cells_are_full(self):
        block = "{ box = { lower = [0.0, 0.0], upper = [2.0, 2.0] } }"
        hashes = set()
        for criterion in ("", "fill_criterion = 0.0", "fill_criterion = 0.5"):
            method = "[method]\nengine = \"particles\"\n" + criterion
            path = self.scene(block, "particles_per_cell = 2", more="[[traction]]\npressure = 1e3\n" + method,
                              time="kappa = 0.5\nsteps = 50")
            hashes.add(self.run_scene(path, out="s")["state_hash"])
        self.assertEqual(len(hashes), 1)

    def test_bad_values(self):
        for value in ("1.0", "-0.1", "nan", "true"):
            self.refuse(self.scene(BLOCK, "particles_per_cell = 2", more=f"[method]\nfill_criterion = {value}"),
                        "method.fill_criterion", ">= 0 and < 1")


class MomentFit(LatticeTest):
    FIT = ("--set", "method.moment_fit=true")

    def test_a_closed_surface_of_rings_is_pushed_no_more(self):
        pressure_times_radius = 1e5
        at_the_start = ("--set", "time.kappa=1e-6")
        plain = self.run_scene("cylinder-free", *at_the_start)
        self.assertGreater(np.hypot(*plain["net_force"][:2]) / pressure_times_radius, 0.04)
        fitted = self.run_scene("cylinder-free", *self.FIT, *at_the_start)
        self.assertLess(np.hypot(*fitted["net_force"][:2]) / pressure_times_radius, 1e-12)
        self.assertLess(abs(fitted["net_torque"][2]) / pressure_times_radius, 1e-12)

    def test_nor_is_a_jittered_ball(self):
        text = """
dimension = 3
grid = { lower = [-2.6, -2.7, -2.8], upper = [2.4, 2.3, 2.2], spacing = 0.5 }
[[body]]
shape = { ball = { center = [0.0, 0.0, 0.0], radius = 1.4 } }
particles_per_cell = 4
jitter = 0.3
density = 1000.0
material = { youngs_modulus = 1e9, poisson_ratio = 0.3 }
[[traction]]
pressure = 1e5
[time]
kappa = 1e-6
steps = 1
"""
        pushed = lambda run: max(map(abs, run["net_force"] + run["net_torque"])) / 1e5
        self.assertGreater(pushed(self.run_scene(self.write(text))), 1e-3)
        self.assertLess(pushed(self.run_scene(self.write(text), *self.FIT)), 1e-12)

    def test_masses_follow_the_volumes_and_what_was_done_is_told(self):
        done = vsb("check", SCENES / "cylinder-free.toml", *self.FIT)
        # The sum is the number of cells that hold particles, of which those beside the surface have fewer moments.
        told = re.search(r"# volumes fitted to all moments in (\d+) cells, to fewer in (\d+), not in 0;", done.stdout)
        done = vsb("check", SCENES / "cylinder-free.toml")
        self.assertNotIn("moments", done.stdout.partition("name =")[0])
        summary = self.run_scene("cylinder-free", *self.FIT, "--set", "time.kappa=1e-6")
        cells = [summary["moment_fit"][name] for name in ("cells_of_all_moments", "cells_of_fewer", "cells_not_fitted")]
        self.assertEqual(cells, [int(told[1]), int(told[2]), 0])
        fields = last_fields(self.folder / "cylinder-free")
        np.testing.assert_allclose(fields["mass"], 1000 * fields["volume"], rtol=1e-6)
        occupied = {tuple(np.floor((x[:2] - [-5.875, -5.8]) / 0.5)) for x in fields["position"]}
        self.assertEqual(sum(cells), len(occupied))
        self.assertAlmostEqual(summary["moment_fit"]["volume"] / fields["volume"].sum(), 1, delta=1e-6)
        self.assertGreater(np.ptp(fields["volume"] / np.hypot(*fields["position"][:, :2].T)), 1e-3)  # V = r dr dtheta no more
        self.assertAlmostEqual(fields["volume"].sum() / (24 * math.pi), 1, delta=1e-3)

    def errors_of(self, key, values, scene, *arguments):
        """Of static solutions: e_tt and e_u, a column each."""
        runs = [self.run_scene(scene, "--static", "--set", f"{key}={value}", *arguments)["errors"] for value in values]
        return np.array([[errors["e_tt"], errors["e_u"]] for errors in runs])

    def test_the_number_of_particles_on_a_ring_does_not_matter(self):
        rings = ("body[0].lattice.concentric.per_ring", (74, 75, 77, 78), "cylinder-concentric")
        plain, fitted = self.errors_of(*rings), self.errors_of(*rings, *self.FIT)
        self.assertGreater(np.max(plain[:, 1]), 2 * np.min(plain[:, 1]))
        self.assertLess(np.max(fitted[:, 1]), 1.05 * np.min(fitted[:, 1]))
        self.assertLess(np.max(fitted[:, 0]), 1.02 * np.min(fitted[:, 0]))
        self.assertLess(np.max(fitted[:, 0]), np.min(plain[:, 0]))

    def test_a_jittered_cylinder_is_as_accurate_as_one_on_a_square_lattice(self):
        seeds = ("body[0].seed", (1, 2, 3), "cylinder", "--set", "body[0].jitter=0.3")
        plain, fitted = self.errors_of(*seeds), self.errors_of(*seeds, *self.FIT)
        self.assertGreater(np.max(plain[:, 1]), 1e-6)
        self.assertLess(np.max(fitted[:, 1]), 1.1 * 3.22e-7)
        self.assertLess(np.max(fitted[:, 0]), 1.05 * 2.10e-2)

    def test_where_there_is_nothing_to_fit_it_is_refused(self):
        for scene, arguments, words in (("cylinder", (), "jitter"), ("cylinder-polar", (), "uniform grids"),
                                        ("cylinder-concentric", ("--set", "method.basis=quadratic_bspline"), "linear"),
                                        ("cylinder-concentric", ("--set", "method.basis=ugimp", "--set",
                                                                 "method.gimp_half_width=0.125"), "linear")):
            done = vsb("check", SCENES / f"{scene}.toml", *arguments, *self.FIT)
            self.assertEqual(done.returncode, 2, scene)
            self.assertIn("method.moment_fit", done.stderr)
            self.assertIn(words, done.stderr)
        text = (SCENES / "cylinder.toml").read_text().replace("[method]\n", "[method]\nmoment_fit = true\n")
        line = text[:text.index("moment_fit")].count("\n") + 1
        self.assertRegex(vsb("check", self.write(text)).stderr, rf"scene\.toml:{line}:\d+: .*method\.moment_fit")
        done = vsb("check", SCENES / "cylinder-concentric.toml", "--set", 'method.moment_fit="yes"')
        self.assertIn("method.moment_fit", done.stderr)
        done = vsb("check", SCENES / "cylinder.toml", "--set", "body[0].jitter=0.2", *self.FIT)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("moment_fit = true", done.stdout)


class CylinderOfRings(LatticeTest):
    def test_errors_at_h_05(self):
        text = (SCENES / "cylinder.toml").read_text()
        line = "particles_per_cell = 4\n"
        self.assertEqual(text.count(line), 1)
        h, a, b = 0.5, 1, 5
        rings, per_quarter = round(4 * (b - a) / h), round(math.pi * (a + b) / h)
        path = self.write(text.replace(line, "lattice.concentric = { center = [0.0, 0.0], radii = [1.0, 5.0], "
                                             f"rings = {rings}, per_ring = {per_quarter}, angles = [0.0, 90.0] }}\n"))
        summary = self.run_scene(path, "--set", f"grid.spacing={h}")
        self.assertEqual(summary["particles"], 32 * 38)
        for name, expected in (("e_rr", 3.99e-2), ("e_tt", 3.98e-2), ("e_u", 2.25e-6)):
            self.assertAlmostEqual(summary["errors"][name] / expected, 1, delta=0.03, msg=name)


class Loads(LatticeTest):
    BLOCK_ON_WALL = dict(lower=[0.0, -1.0], upper=[4.0, 3.0], faces='faces = { x_min = "fixed" }')

    def loaded(self, time_function, steps):
        return self.scene(BLOCK, "particles_per_cell = 2", more=f"[[traction]]\npressure = 100.0\ntime = {time_function}",
                          time=f"dt = 0.001\n{steps}", **self.BLOCK_ON_WALL)

    def factor(self, time_function, steps):
        summary = self.run_scene(self.loaded(time_function, f"steps = {steps}"), out="s")
        return summary["net_force"][0] / (-100 * 2)

    def test_factors(self):
        sine = "{ sine = { period = 0.08, amplitude = 0.5, mean = 0.25, start = 0.01, phase = 90.0 } }"
        for time, steps, expected in (
                ("{ smooth_ramp = 0.04 }", 10, 53 / 512),  # s = 1/4: 10/64 - 15/256 + 6/1024
                ("{ smooth_ramp = 0.04 }", 20, 0.5), ("{ smooth_ramp = 0.04 }", 30, 1 - 53 / 512),
                ("{ smooth_ramp = 0.04 }", 60, 1),
                ("{ smooth_ramp = 0.04 }", 2, 0.00116),  # a line would give 0.05; 10/8000 - 15/160000 + ...
                ("{ smooth_ramp_steps = 40 }", 10, 53 / 512), ("{ smooth_ramp_steps = 40 }", 45, 1),
                ("{ sine = { period = 0.04 } }", 10, 1), ("{ sine = { period = 0.04 } }", 30, -1),
                ("{ sine = { period = 0.06 } }", 5, 0.5), ("{ sine = { period = 0.04 } }", 50, 1),
                (sine, 5, 0.25), (sine, 10, 0.75), (sine, 30, 0.25), (sine, 50, -0.25),
                (sine, 60, 0.25 - 0.5 / math.sqrt(2))):
            self.assertAlmostEqual(self.factor(time, steps), expected, delta=2e-3, msg=f"{time} {steps}")

    def test_a_sine_never_settles(self):
        message = self.refuse(self.loaded("{ sine = { period = 0.04 } }", "until_static = {}"), "time.until_static",
                              "traction 'traction 1' is a sine, which never settles")
        self.assertRegex(message, r"scene\.toml:\d+:\d+: ")
        done = vsb("check", self.loaded("{ sine = { period = 0.04 } }", "steps = 5"))
        self.assertIn("loads never constant", done.stdout)
        done = vsb("check", self.loaded("{ smooth_ramp = 0.04 }", "until_static = {}"))
        self.assertIn("loads constant from 0.04 s on", done.stdout)

    def test_bad_values(self):
        for time, word in (("{ smooth_ramp = 0 }", "> 0"), ("{ smooth_ramp_steps = 0 }", "smooth_ramp_steps"),
                           ("{ smooth_ramp = 1, ramp = 1 }", "give one of ramp"),
                           ("{ sine = {} }", "sine.period is missing"), ("{ sine = { period = 0 } }", "> 0"),
                           ("{ sine = { period = 1, start = -1 } }", ">= 0"), ("{ sine = 3 }", "must be a table"),
                           ("{ sine = { period = 1, phse = 1 } }", "did you mean 'phase'"),
                           ("{ smoothramp = 1 }", "did you mean 'smooth_ramp'")):
            self.refuse(self.loaded(time, "steps = 1"), word)


class RoundTrip(LatticeTest):
    def test_the_resolved_scene_parses_back_to_itself(self):
        lattices = ("lattice.uniform = { spacing = [0.3, 0.35] }\njitter = 0.1\nseed = 12345678901234567",
                    Concentric.RINGS.format(n=40, angles="[0, 180]"))
        times = ("{ sine = { period = 0.3, phase = 10 } }", "{ smooth_ramp = 0.1 }", "{ smooth_ramp_steps = 7 }")
        for lattice in lattices:
            for time in times:
                texts = []
                for text in (self.scene("{ disc = { center = [0.0, 0.0], radius = 3.0 } }", lattice,
                                        more=f"[[traction]]\npressure = 1.0\ntime = {time}\n[method]\nfill_criterion = 0.1"
                                             "\nallow_particles_on_grid_lines = true").read_text(), None):
                    done = vsb("check", self.write(text or texts[0]))
                    self.assertEqual(done.returncode, 0, done.stderr)
                    texts.append(re.sub(r"^#.*\n", "", done.stdout, flags=re.MULTILINE))
                self.assertEqual(*texts)
                resolved = tomllib.loads(texts[0])
                self.assertEqual(resolved["method"]["fill_criterion"], 0.1)
                self.assertEqual("jitter" in resolved["body"][0], "uniform" in lattice)


if __name__ == "__main__":
    unittest.main()
