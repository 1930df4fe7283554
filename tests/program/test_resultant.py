# SPDX-License-Identifier: BSD-3-Clause
"""The study `resultant` with few bodies: its figures from first principles, what it draws, and mistakes in its keys."""
import itertools
import json
import math
import statistics
import tomllib
import unittest

import numpy as np
from study_test import StudyTest
from vsb_program import SCENES, ProgramTest, last_fields

FEW = """\
title = "Few bodies"
balance = true

[axis]
name = "seed"

[chart]
figures = ["net_force_share", "net_torque_share"]
distribution = true

[[series]]
name = "all"
scene = "SCENES/closed-body.toml"
random_bodies = { count = 6, first_seed = 1, half_width = 7.0 }

[[series]]
name = "boundary"
scene = "SCENES/closed-body.toml"
set = ["traction[0].nodes=boundary"]
random_bodies = { count = 6, first_seed = 1, half_width = 7.0 }

[[series]]
name = "3D"
scene = "SCENES/closed-body-3d.toml"
set = ["traction[0].nodes=boundary"]
random_bodies = { count = 2, first_seed = 7, half_width = 5.0 }
"""


def inside(shape, x):
    """Which of the points x lie in a shape as a scene has it."""
    (kind, value), = shape.items()
    if kind == "ball":
        return np.sum((x - value["center"]) ** 2, axis=1) <= value["radius"] ** 2
    if kind == "box":
        return np.all((x >= value["lower"]) & (x <= value["upper"]), axis=1)
    first, second = (inside(part, x) for part in value)
    return first | second if kind == "union" else first & ~second


def primitives(shape):
    (kind, value), = shape.items()
    return sum((primitives(part) for part in value), []) if kind in ("union", "difference") else [(kind, value)]


def surface_of(kind, value):
    """Points on the surface of a ball or a box, outward normals, and areas."""
    if kind == "ball":
        center, r = np.array(value["center"]), value["radius"]
        if len(center) == 2:
            n = 40000
            a = (np.arange(n) + 0.5) * 2 * np.pi / n
            normal, area = np.column_stack([np.cos(a), np.sin(a)]), np.full(n, 2 * np.pi * r / n)
        else:  # a spiral of equal areas
            n = 200000
            z = 1 - (2 * np.arange(n) + 1) / n
            a = np.arange(n) * np.pi * (3 - math.sqrt(5))
            s = np.sqrt(1 - z**2)
            normal, area = np.column_stack([s * np.cos(a), s * np.sin(a), z]), np.full(n, 4 * np.pi * r**2 / n)
        return center + r * normal, normal, area
    lower, upper = np.array(value["lower"]), np.array(value["upper"])
    d, points, normals, areas = len(lower), [], [], []
    n = 5000 if d == 2 else 150
    for axis, (side, at) in itertools.product(range(d), ((-1, lower), (1, upper))):
        others = [k for k in range(d) if k != axis]
        lines = [lower[k] + (np.arange(n) + 0.5) / n * (upper[k] - lower[k]) for k in others]
        x = np.empty((n ** len(others), d))
        x[:, axis] = at[axis]
        for k, line in zip(others, np.meshgrid(*lines, indexing="ij")):
            x[:, k] = line.ravel()
        points.append(x)
        normals.append(np.tile(side * np.eye(d)[axis], (len(x), 1)))
        areas.append(np.full(len(x), math.prod(upper[k] - lower[k] for k in others) / len(x)))
    return np.concatenate(points), np.concatenate(normals), np.concatenate(areas)


def area_of(shape):
    """What of the parts' surfaces separates the inside from the outside."""
    total = 0.0
    for part in primitives(shape):
        x, normal, area = surface_of(*part)
        total += area[inside(shape, x - 1e-7 * normal) != inside(shape, x + 1e-7 * normal)].sum()
    return total


class Body:
    """A closed body on a grid, from the text of a scene: particles, boundary nodes, and forces of a pressure."""

    def __init__(self, scene):
        scene = tomllib.loads(scene)
        grid, body = scene["grid"], scene["body"][0]
        d = scene["dimension"]
        self.shape, self.pressure = body["shape"], scene["traction"][0]["pressure"]
        self.lower, self.h = np.array(grid["lower"]), np.broadcast_to(grid["spacing"], d)
        cells = np.rint((np.array(grid["upper"]) - self.lower) / self.h).astype(int)
        lattice = body["lattice"]["uniform"]
        spacing, origin = np.broadcast_to(lattice["spacing"], d), np.array(lattice["origin"])
        lines = [origin[i] + (np.arange(-1, cells[i] * self.h[i] / spacing[i] + 1) + 0.5) * spacing[i] for i in range(d)]
        lattice_points = np.column_stack([x.ravel() for x in np.meshgrid(*lines, indexing="ij")])
        self.x = lattice_points[inside(self.shape, lattice_points)]
        self.volume = math.prod(spacing)
        # Algorithm 1, cell by cell.
        cell = np.floor((self.x - self.lower) / self.h).astype(int)
        full = set(map(tuple, cell))
        near = list(itertools.product((-1, 0, 1), repeat=d))
        add = lambda a, b: tuple(i + j for i, j in zip(a, b))
        beyond = {add(c, n) for c in full for n in near} - full
        beside = {c for c in full if any(add(c, n) in beyond for n in near)}
        corners = list(itertools.product((0, 1), repeat=d))
        active = {add(c, k) for c in full for k in corners}
        self.boundary = active & {add(c, k) for c in beyond | beside for k in corners}
        self.inner = active - self.boundary
        # f_I = p sum_p V grad N_I(x_p)
        self.force = {}
        xi = (self.x - self.lower) / self.h - cell
        for k in corners:
            gradient = np.ones_like(self.x)
            for i in range(d):
                for j in range(d):
                    n = xi[:, j] if k[j] else 1 - xi[:, j]
                    gradient[:, i] *= (1 if k[j] else -1) / self.h[j] if i == j else n
            for c, g in zip(cell, self.pressure * self.volume * gradient):
                node = add(c, k)
                self.force[node] = self.force.get(node, 0) + g

    def resultant(self, nodes):
        """Sizes of the net force, and of the net torque about the middle of the particles' box; its half width."""
        lower, upper = self.x.min(axis=0), self.x.max(axis=0)
        force = sum(self.force[n] for n in nodes)
        torque = sum(np.cross(self.lower + n * self.h - 0.5 * (lower + upper), self.force[n]) for n in nodes)
        return np.linalg.norm(force), np.linalg.norm(torque), 0.5 * (upper - lower).max()


class Resultant(StudyTest):
    def scene_of(self, row):
        summary = json.loads((self.folder / "out" / row["directory"] / "summary.json").read_text())
        return summary["provenance"]["scene"], summary

    def test_figures_from_first_principles(self):
        _, table = self.study(FEW)
        told = {(row["series"], row["case"], row["figure"]): float(row["value"]) for row in table}
        self.assertEqual(len(told), 2 * (6 + 6 + 2))
        scenes, larger = set(), 0
        for series, case, figure in told:
            if figure != "net_force_share":
                continue
            row = next(r for r in table if (r["series"], r["case"]) == (series, case))
            scene, summary = self.scene_of(row)
            body = Body(scene)
            scenes.add(scene)
            self.assertEqual(summary["particles"], len(body.x))
            load = summary["resultant"]["load"]
            # The program cuts edges and corners off at the distance of its sampling points, an eighth of a cell; 3D: a half.
            self.assertAlmostEqual(load / (1e5 * area_of(body.shape)), 1, delta=0.03 if series == "3D" else 0.01)
            force, torque, half_width = body.resultant(body.force if series == "all" else body.boundary)
            larger += force > 1e-3 * load
            self.assertAlmostEqual(told[series, case, "net_force_share"], force / load, delta=1e-12)
            self.assertAlmostEqual(told[series, case, "net_torque_share"], torque / (load * half_width), delta=1e-12)
        self.assertEqual(len(scenes), 14)
        self.assertGreaterEqual(larger, 5)  # shares that round-off does not explain

    def test_the_same_seed_is_the_same_body(self):
        _, table = self.study(FEW)
        of = lambda series: [(row["particles"], row["state_hash"]) for row in table if row["series"] == series]
        self.assertEqual(of("all"), of("boundary"))
        self.assertEqual(len(set(of("all"))), 6)
        _, other = self.study(FEW, out="other")
        values = lambda rows: [(row["case"], row["figure"], row["value"]) for row in rows]
        self.assertEqual(values(table), values(other))
        shifted = FEW.replace("count = 6, first_seed = 1", "count = 4, first_seed = 3")
        _, part = self.study(shifted, out="part")
        some = lambda rows: [v for v, row in zip(values(rows), rows) if row["series"] == "all" and int(row["case"]) in (3, 4, 5, 6)]
        self.assertEqual(len(some(part)), 8)
        self.assertEqual(some(table), some(part))

    def test_shape_lattice_and_grid_lie_anywhere(self):
        _, table = self.study(FEW.replace("count = 6", "count = 20"))
        scenes = [tomllib.loads(self.scene_of(row)[0]) for row in table
                  if row["series"] == "all" and row["figure"] == "net_force_share"]
        drawn = {"grid": [], "lattice": [], "shape": [], "per cell": []}
        kinds, counts = set(), set()
        for scene in scenes:
            body, lower = scene["body"][0], np.array(scene["grid"]["lower"])
            lattice = body["lattice"]["uniform"]
            parts = primitives(body["shape"])
            kind, first = parts[0]
            middle = first["center"] if kind == "ball" else np.add(first["lower"], first["upper"]) / 2
            drawn["grid"] += list(lower % 1)
            drawn["lattice"] += list((np.array(lattice["origin"]) - lower) / np.array(lattice["spacing"]))
            drawn["shape"] += list(middle - lower - (np.array(scene["grid"]["upper"]) - lower) / 2 + 0.5)
            drawn["per cell"].append((1 / lattice["spacing"][0] - 2) / 1.2)
            kinds |= {kind for kind, _ in parts}
            counts.add(len(parts))
        for name, numbers in drawn.items():  # uniform in [0, 1): 20 or 40 of them, at 4 standard deviations of their mean
            self.assertTrue(all(0 <= x <= 1 for x in numbers), name)
            self.assertAlmostEqual(np.mean(numbers), 0.5, delta=4 * math.sqrt(1 / 12 / len(numbers)), msg=name)
            self.assertGreater(np.ptp(numbers), 0.7, name)
        self.assertEqual((kinds, counts), ({"ball", "box"}, {2, 3, 4}))

    def test_the_study_goes_on(self):
        cut = FEW[:FEW.rindex("[[series]]")]
        self.study(cut)
        done, _ = self.study(FEW)
        self.assertIn("cases 7 to 12 of 14: boundary (6 done before", done.stdout)
        self.assertIn("cases 13 to 14 of 14: 3D (0 done before", done.stdout)


STATISTIC = """
[[statistic]]
title = "{0} {1} of {2}"
series = "{2}"
figure = "{1}"
{0} = {{ value = {3!r}, tolerance = 1e-12 }}
"""


class Statistics(StudyTest):
    def test_largest_smallest_and_median(self):
        odd = FEW.replace("count = 2", "count = 3")
        _, table = self.study(odd)
        expected = []
        for (kind, of), figure, series in itertools.product(
                (("largest", max), ("smallest", min), ("median", statistics.median)), ("net_force_share", "net_torque_share"),
                ("boundary", "3D")):
            values = [float(r["value"]) for r in table if (r["series"], r["figure"]) == (series, figure)]
            expected.append((kind, figure, series, of(values)))
        done, judged = self.study(odd + "".join(STATISTIC.format(*e) for e in expected))
        lines = [row for row in judged if row["series"] == "statistic"]
        self.assertEqual([(row["case"], row["figure"], row["verdict"]) for row in lines],
                         [(f"{kind} {figure} of {series}", f"{kind} {figure}", "pass") for kind, figure, series, _ in expected])
        self.assertIn("mine: 12 pass, 0 fail", done.stdout)
        wrong = [(kind, figure, series, 1.001 * value) for kind, figure, series, value in expected]
        _, judged = self.study(odd + "".join(STATISTIC.format(*e) for e in wrong), code=6)
        self.assertEqual([row["verdict"] for row in judged if row["series"] == "statistic"], ["fail"] * 12)

    def test_a_case_without_the_figure_fails_its_statistic(self):
        text = FEW[:FEW.index("[[series]]")].replace("balance = true\n", "") + """
            [[series]]
            name = "columns"
            scene = "SCENES/column.toml"
            set = ["time.steps=200"]
            case = [{ axis = 1 }, { axis = 2, set = ["time.dt=0.06", "time.steps=20000"] }]
            """.replace("            ", "")
        text = text.replace('["net_force_share", "net_torque_share"]', '["e_u"]')
        text += STATISTIC.format("largest", "e_u", "columns", 1.0).replace("value = 1.0, tolerance = 1e-12", "highest = 1e9")
        _, table = self.study(text, code=6)
        line, = (row for row in table if row["series"] == "statistic")
        self.assertEqual((line["verdict"], line["value"]), ("fail", ""))
        self.assertIn("not every case", line["note"])
        self.study(text.replace('time.dt=0.06", "time.steps=20000', "time.steps=100"))

    def test_failing_cases_of_a_drawn_series_are_told(self):
        # No body reaches to where the traction may act.
        text = FEW[:FEW.rindex("[[series]]")].replace("traction[0].nodes=boundary",
            "traction[0].nodes=boundary\", \"traction[0].surface={ disc = { center = [99.0, 0.0], radius = 1.0 } }")
        done, table = self.study(text, code=6)
        self.assertEqual([row["series"] for row in table if row["verdict"] == "fail"], ["boundary"] * 6)
        self.assertEqual(done.stdout.count("FAIL outcome: traction 'pressure'"), 12)  # where they occur, and at the end


class Charts(StudyTest):
    def picture(self, name):
        data = (self.folder / "out" / name).read_bytes()
        self.assertEqual(data[:8], b"\x89PNG\r\n\x1a\n")
        self.assertGreater(len(data), 10_000)

    def test_a_distribution(self):
        self.study(FEW)
        self.picture("mine_distribution.png")
        self.assertEqual(len(list((self.folder / "out").glob("*.png"))), 1)
        about = json.loads((self.folder / "out" / "mine.json").read_text())
        self.assertEqual(about["chart"], {"figures": ["net_force_share", "net_torque_share"], "distribution": True, "log": True,
                                          "cost": False})

    def test_figures_in_place_of_errors(self):
        text = FEW[:FEW.rindex("[[series]]")].replace("distribution = true", "log = false").replace("net_torque_share", "net_force_x")
        _, table = self.study(text)
        self.picture("mine_figures.png")
        self.assertEqual(len(list((self.folder / "out").glob("*.png"))), 1)
        self.assertTrue(any(float(row["value"]) < 0 for row in table if row["figure"] == "net_force_x"))


class ClosedBodies(ProgramTest):
    def test_they_stay_at_rest_at_all_nodes_and_are_driven_away_at_the_boundary_nodes(self):
        for scene in ("closed-body", "closed-body-3d"):
            speed = {}
            for nodes in ("all", "boundary"):
                summary = self.run_scene(scene, "--set", f"traction[0].nodes={nodes}", out=f"{scene}-{nodes}")
                self.assertEqual(summary["steps"], 1000)
                speed[nodes] = np.abs(last_fields(self.folder / f"{scene}-{nodes}")["velocity"]).max()
            # Pressure over impedance is the speed that an unbalanced surface has: 0.1 m/s.
            self.assertLess(speed["all"], 1e-13)
            self.assertGreater(speed["boundary"], 1e-2)


class BadKeys(StudyTest):
    def test_random_bodies(self):
        bodies = "random_bodies = { count = 2, first_seed = 7, half_width = 5.0 }"
        line = FEW[:FEW.index(bodies)].count("\n") + 1
        for new, *words in ((bodies.replace("count = 2", "count = 0"), "series[2].random_bodies.count", "from 1 to 10000"),
                            (bodies.replace("count = 2, ", ""), "count is missing"),
                            (bodies.replace("7", "-1"), "first_seed", "from 0 to"),
                            (bodies.replace("5.0", "0.0"), "half_width", "> 0"),
                            (bodies.replace("half_width", "halfwidth"), "unknown key 'halfwidth'", "did you mean 'half_width'"),
                            (bodies.replace("{", "[{").replace("}", "}]"), "random_bodies", "table"),
                            (bodies + '\nsweep = "time.kappa"', "either cases or random_bodies"),
                            (bodies + "\ncase = [{ axis = 1 }]", "either cases or random_bodies")):
            self.refuse(FEW.replace(bodies, new), *words, line=line + new.count("\n"))
        for scene, why in (("ring", "lattice.uniform"), ("cylinder-polar", "uniform grid")):
            self.refuse(FEW.replace("closed-body-3d", scene).replace('set = ["traction[0].nodes=boundary"]\n' + bodies, bodies),
                        "random bodies need a scene", why, line=line - 1)
        self.refuse(FEW.replace('name = "seed"', 'name = "seed"\nlabels = true'), "must not have labels", line=15)
        two = (SCENES / "closed-body.toml").read_text() + """
            [[body]]
            shape = { disc = { center = [1.0, 1.0], radius = 0.5 } }
            lattice.uniform = { spacing = 0.4 }
            density = 1.0
            material = { youngs_modulus = 1e6, poisson_ratio = 0.0 }
            """
        self.write(two, "two.toml")
        self.refuse(FEW.replace("SCENES/closed-body.toml", "two.toml"), "with one body", line=14)

    def test_balance(self):
        both = FEW.replace("balance = true", "balance = true\nstatic = true")
        self.refuse(both, "either static = true or balance = true", line=2)
        self.refuse(FEW.replace("balance = true", "balance = 1"), "balance", line=2)
        # Shares are figures of a balance alone.
        self.refuse(FEW.replace("balance = true\n", ""), "net_force_share", line=7)
        sine = FEW[:FEW.index("[[series]]", FEW.index("[[series]]") + 1)].replace(
            "random_bodies", 'set = ["traction[0].time={ sine = { period = 1.0 } }"]\nrandom_bodies')
        done, table = self.study(sine, code=6)
        self.assertIn("never settles", table[0]["note"])

    def test_statistics(self):
        good = STATISTIC.format("largest", "net_force_share", "3D", 1.0).replace("value = 1.0, tolerance = 1e-12", "highest = 1.0")
        self.study(FEW + good, out="good")
        first = FEW.count("\n") + 1
        for old, new, *words, line in (('"3D"\n', '"4D"\n', "no series of this name", 3), ('"net_force_share"', '"net_farce_share"',
                "no such figure", "did you mean 'net_force_share'", 4), ("largest =", "lergest =", "unknown key 'lergest'", 5),
                ("largest = { highest = 1.0 }", "", "exactly one of largest, smallest and median", 1),
                ("largest = {", "median = { lowest = 0 }\nlargest = {", "exactly one of largest, smallest and median", 1),
                ("highest = 1.0", "highest = true", "highest", 5)):
            self.assertEqual(good.count(old), 1, old)
            self.refuse(FEW + good.replace(old, new), *words, line=first + line)

    def test_charts(self):
        self.refuse(FEW.replace('"net_torque_share"]', '"net_tork_share"]'), "net_tork_share", line=8)
        self.refuse(FEW.replace("distribution = true", 'distribution = "yes"'), "distribution", line=9)
        self.refuse(FEW.replace("distribution", "distributions"), "unknown key 'distributions' in chart", line=9)


if __name__ == "__main__":
    unittest.main()
