# SPDX-License-Identifier: BSD-3-Clause
"""Bad input: exit code 2, a message that says where and what is allowed, and nothing written."""
import math
import re
import time
import tomllib
import unittest

from vsb_program import SCENES, ProgramTest, vsb

GOOD = """\
dimension = 2
grid = { lower = [0.0, 0.0], upper = [4.0, 4.0], spacing = 0.5 }

[[body]]
name = "block"
shape = { box = { lower = [1.0, 1.0], upper = [3.0, 3.0] } }
particles_per_cell = 2
density = 1000.0
material = { youngs_modulus = 1e6, poisson_ratio = 0.3 }

[[traction]]
pressure = 1e3

[time]
kappa = 0.5
steps = 10
"""


class BadScenes(ProgramTest):
    def refuse(self, text, *words, command="run", line=None, extra=()):
        """The scene is refused with a message that has all the words, names the line, and leaves no file behind."""
        path = self.write(text)
        out = self.folder / "results"
        begun = time.monotonic()
        done = vsb(command, path, *(("--out", out) if command == "run" else ()), *extra)
        self.assertLess(time.monotonic() - begun, 30)  # a hang guard, not a timing
        message = done.stderr
        self.assertEqual(done.returncode, 2, f"{message}{done.stdout}\n{text}")
        for word in words:
            self.assertIn(word, message)
        if line is not None:
            self.assertRegex(message, rf"scene\.toml:{line}:\d+: ")
        self.assertFalse(out.exists(), message)
        return message

    def changed(self, old, new):
        self.assertEqual(GOOD.count(old), 1, old)
        return GOOD.replace(old, new)

    def test_the_good_scene_is_good(self):
        self.run_scene(self.write(GOOD))

    def test_1_unknown_key_with_a_suggestion(self):
        self.refuse(self.changed("kappa = 0.5", "kapa = 0.5"), "unknown key 'kapa' in time", "did you mean 'kappa'", line=15)

    def test_2_wrong_type(self):
        self.refuse(self.changed("density = 1000.0", 'density = "heavy"'), "body[0].density", '(a string)', "> 0", line=8)

    def test_3_out_of_range(self):
        self.refuse(self.changed("poisson_ratio = 0.3", "poisson_ratio = 0.5"), "body[0].material.poisson_ratio = 0.5",
                    "> -1 and < 0.5", line=9)

    def test_4_not_a_number(self):
        self.refuse(self.changed("kappa = 0.5", "kappa = nan"), "time.kappa = nan", "> 0 and <= 2", line=15)

    def test_5_infinite(self):
        self.refuse(self.changed("pressure = 1e3", "pressure = inf"), "traction[0].pressure = inf", line=12)

    def test_6_missing_key(self):
        self.refuse(self.changed("density = 1000.0\n", ""), "body[0].density is missing", "> 0")

    def test_6_missing_tables(self):
        # Whatever is left out is named, and the file with it; what is allowed to be left out leaves a good scene.
        lines = GOOD.splitlines(keepends=True)
        for number, left_out in enumerate(lines):
            if not left_out.strip():
                continue
            done = vsb("check", self.write("".join(lines[:number] + lines[number + 1:])))
            self.assertIn(done.returncode, (0, 2), left_out + done.stderr)
            if done.returncode == 2:
                self.assertIn("scene.toml", done.stderr, left_out)
        message = self.refuse(self.changed("material = { youngs_modulus = 1e6, poisson_ratio = 0.3 }\n", ""),
                              "body[0].material.youngs_modulus is missing")
        self.assertRegex(message, r"scene\.toml:4:\d+: ")  # where the body begins

    def test_7_not_toml(self):
        self.refuse(self.changed("steps = 10", "steps = = 10"), "scene.toml:16:")

    def test_8_grid_that_is_no_whole_number_of_cells(self):
        self.refuse(self.changed("spacing = 0.5", "spacing = 0.3"), "whole number of cells", line=2)

    def test_9_unknown_shape(self):
        self.refuse(self.changed("box =", "bax ="), "unknown shape 'bax'", "did you mean 'box'", line=6)

    def test_10_empty_body(self):
        self.refuse(self.changed("upper = [3.0, 3.0]", "upper = [1.01, 1.01]"), "body 'block' has no particle")

    def test_11_overlapping_bodies(self):
        body = GOOD[GOOD.index("[[body]]"):GOOD.index("[[traction]]")]
        self.refuse(GOOD + body.replace('"block"', '"twin"'), "'twin' overlaps body 'block'")

    def test_12_traction_without_a_boundary_node(self):
        self.refuse(self.changed("pressure = 1e3", "pressure = 1e3\nsurface = { disc = { center = [2.0, 2.0], radius = 0.1 } }"),
                    "finds no boundary node")
        full = self.changed("{ box = { lower = [1.0, 1.0], upper = [3.0, 3.0] } }",
                            "{ box = { lower = [0.0, 0.0], upper = [4.0, 4.0] } }")
        self.refuse(full, "finds no boundary node")
        self.refuse(full, "finds no boundary node", command="check")

    def test_13_body_at_an_open_face_under_a_traction(self):
        self.refuse(self.changed("lower = [1.0, 1.0], upper = [3.0, 3.0]", "lower = [0.0, 1.0], upper = [3.0, 3.0]"),
                    "open face x_min")

    def test_14_file_that_is_not_there(self):
        done = vsb("run", self.folder / "nowhere.toml", "--out", self.folder / "results")
        self.assertEqual(done.returncode, 2)
        self.assertIn("nowhere.toml", done.stderr)

    def test_15_contradictions(self):
        self.refuse(self.changed("kappa = 0.5", "kappa = 0.5\ndt = 0.001"), "either dt or kappa")
        self.refuse(self.changed("steps = 10", "steps = 10\nuntil_static = {}"), "either steps or until_static")
        self.refuse(self.changed("pressure = 1e3", "pressure = 1e3\nstress = [1, 0, 0, 0, 0, 0]"),
                    "give one of pressure, stress")
        self.refuse(self.changed("pressure = 1e3", "pressure = 1e3\ntime = { ramp = 1, step = 2 }"), "one of ramp")

    def test_16_overrides_of_the_command_line(self):
        for override, word in (("time.kapa=1", "did you mean 'kappa'"), ("time.kappa=9", "> 0 and <= 2"),
                               ("body[7].density=1", "no element 7"), ("grid", "key=value"), ("time.kappa=[", "time.kappa")):
            message = self.refuse(GOOD, word, extra=("--set", override))
            self.assertIn("--set " + override, message)

    def test_17_a_name_that_is_no_file_name(self):
        self.refuse('name = "../up"\n' + GOOD, "name", line=1)


    def test_18_a_body_cut_off_at_an_open_face(self):
        block = "lower = [1.0, 1.0], upper = [3.0, 3.0]"
        bare = GOOD.replace("[[traction]]\npressure = 1e3\n", "")  # nothing but the cut to find fault with
        for box, face in (("lower = [-0.2, 1.0], upper = [3.0, 3.0]", "x_min"), ("lower = [1.0, 1.0], upper = [5.0, 3.0]", "x_max"),
                          ("lower = [1.0, -9.0], upper = [3.0, 3.0]", "y_min"), ("lower = [1.0, 1.0], upper = [3.0, 4.2]", "y_max")):
            text = bare.replace(block, box)
            self.refuse(text, "body 'block' reaches out of the grid at the open face " + face, "would be cut off")
            self.refuse(text.replace("particles_per_cell = 2", "lattice.uniform = { spacing = 0.2 }"), "open face " + face)
            for condition in ('"roller"', '"fixed"', '["x"]'):
                self.run_scene(self.write(text + f"[faces]\n{face} = {condition}\n"), out="cut")
        # Up to the face, between it and the first point beyond it, and without an end: not cut off.
        for shape in ("box = { lower = [0.0, 1.0], upper = [3.0, 4.0] }", "box = { lower = [1.0, 1.0], upper = [4.1, 3.0] }",
                      "half_space = { point = [0.0, 2.0], normal = [0.0, 1.0] }"):
            self.run_scene(self.write(bare.replace("box = { %s }" % block, shape)), out="whole")

    def test_19_a_body_cut_off_by_other_grids(self):
        disc = "disc = { center = [0.0, 0.0], radius = 3.0 }"
        rest = GOOD[GOOD.index("\n\n[[body]]"):].replace("[[traction]]\npressure = 1e3\n", "")
        rest = rest.replace("box = { lower = [1.0, 1.0], upper = [3.0, 3.0] }", disc)
        for grid, face in (("x = [-4.0, -1.0, 0.5, 1.5, 2.5], y = [-4.0, -2.0, 0.0, 2.0, 4.0]", "x_max"),
                           ("x = [-4.0, -2.0, 0.0, 2.0, 4.0], y = [-2.5, -1.5, -1.0, 4.0]", "y_min"),
                           ("polar = { radii = [0.1, 2.9], radial_cells = 14, angles = [0, 90], angular_cells = 9 }", "r_max"),
                           ("polar = { radii = [0.1, 3.1], radial_cells = 15, angles = [0, 90], angular_cells = 9 }", "theta_m")):
            closed = "[faces]\ntheta_min = ['y']\ntheta_max = ['x']\n" if face == "r_max" else ""
            self.refuse(f"dimension = 2\ngrid = {{ {grid} }}" + rest + closed, "reaches out of the grid at the open face " + face)

    def test_20_nothing_that_loads_a_run_until_static(self):
        bare = GOOD.replace("[[traction]]\npressure = 1e3\n", "").replace("steps = 10", "until_static = { max_steps = 1 }")
        for text in (bare, bare + "[[traction]]\npressure = 0.0\n"):
            self.refuse(text, "time.until_static", "nothing loads the bodies")
        for load in ("velocity = [0.1, 0.0]", "velocity = { dx = [0.1, 0.0] }", "stress = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0]"):
            self.run_scene(self.write(bare.replace("density", load + "\ndensity")), "--set", "time.until_static.max_steps=1")
        for load in ("gravity = [0.0, 1.0]\n", "traction = [{ stress = [0, 0, 0, 1, 0, 0] }]\n"):
            self.run_scene(self.write(load + bare), "--set", "time.until_static.max_steps=1")

    def test_21_misspelt_keys_are_answered_with_all_keys_of_the_table(self):
        for old, new, allowed in (
                ("spacing =", "spacng =", "lower, polar, spacing, upper, x, y"),
                ("density =", "densty =", "boundary, density, jitter, lattice, material, name, particles_per_cell, seed, shape, stress, velocity"),
                ("kappa =", "kapa =", "dt, kappa, steps, until_static"),
                ("dimension =", "dimensoin =", "body, compare, dimension, faces, gravity, gravity_time, grid, growth, method, name, output, precision, "
                 "published, removal, setting, static, time, title, traction"),
                ("upper = [3.0, 3.0]", "uper = [3.0, 3.0]", "lower, upper"),
                ("pressure =", "presure =", "affine, configuration, exact_ellipse, hydrostatic, imposition, layer, name, nodes, planar_blend, points_per_cell, pressure, "
                 "radial_blend, self_balanced, stress, surface, time")):
            self.refuse(self.changed(old, new), f"(allowed here: {allowed})", "did you mean")

    def test_22_words(self):
        done = vsb("run", self.folder)
        self.assertEqual((done.returncode, done.stderr), (2, f"vsb: {self.folder}: is a directory, not a TOML file\n"))
        self.refuse(self.changed("lower = [0.0, 0.0], upper = [4.0", "lower = [0.0], upper = [4.0"), "an array of 2 finite numbers")
        self.refuse(self.changed("pressure = 1e3", 'pressure = "high"'), "must be a finite number")
        self.refuse(self.changed("spacing = 0.5", "spacing = nan"), "must be finite and > 0")
        self.refuse(self.changed("pressure = 1e3", "pressure = nan"), "must be finite\n")
        self.refuse(GOOD, "'body' is an array of tables; say which one: body[0].density", extra=("--set", "body.density=1"))
        self.refuse(GOOD, "say which one: body[0].material.youngs_modulus", extra=("--set", "body.material.youngs_modulus=1"))
        self.refuse(self.changed("steps = 10\n", ""), "time.steps is missing", "until_static")


class EveryKey(ProgramTest):
    """Every key of the resolved scenes, misspelt and with values of the wrong kind."""

    def leaves(self, table, path=""):
        for key, value in table.items():
            name = f"{path}.{key}" if path else key
            if isinstance(value, dict) and key not in ("shape", "surface"):
                yield from self.leaves(value, name)
            elif isinstance(value, list) and value and isinstance(value[0], dict):
                for i, item in enumerate(value):
                    yield from self.leaves(item, f"{name}[{i}]")
            else:
                yield name, value

    def refused(self, scene, override):
        done = vsb("run", scene, "--out", self.folder / "results", "--set", override)
        self.assertEqual(done.returncode, 2, f"{override}: {done.stdout}{done.stderr}")
        self.assertIn("--set " + override, done.stderr)
        key = re.split(r"[.=]", override)[0].split("[")[0]
        self.assertIn(key, done.stderr)
        self.assertFalse((self.folder / "results").exists(), override)

    def test_wrong_values_and_misspellings(self):
        tried = 0
        for name in ("column", "cylinder"):
            resolved = vsb("check", SCENES / f"{name}.toml")
            self.assertEqual(resolved.returncode, 0, resolved.stderr)
            scene = self.write(resolved.stdout, f"{name}.toml")
            for key, value in self.leaves(tomllib.loads(resolved.stdout)):
                bad = ["1979-05-27", "{ a = 1 }"]
                if isinstance(value, bool):
                    bad += ["1", '"true"']
                elif isinstance(value, (int, float)):
                    bad += ["nan", "inf", "-inf", '"text"', "true", "[]"]
                elif isinstance(value, list) and value and isinstance(value[0], (int, float)):
                    bad += ["[nan]", '["text"]', "[]", "[1, 2, 3, 4, 5, 6, 7]"]
                elif isinstance(value, list):
                    bad += ['["nonsense"]', "[1]", "3"]
                else:
                    bad += ["1.5", "[]"]
                for text in bad:
                    self.refused(scene, f"{key}={text}")
                    tried += 1
                self.refused(scene, f"{key}zz={'1' if not isinstance(value, str) else 'a'}")
        self.assertGreater(tried, 200)

    def test_numbers_out_of_range(self):
        for override in ("dimension=4", "dimension=0", "grid.spacing=0", "grid.spacing=-1", "body[0].density=0",
                         "body[0].particles_per_cell=0", "body[0].particles_per_cell=65",
                         "body[0].material.youngs_modulus=0", "body[0].material.poisson_ratio=-1",
                         "method.damping=1", "method.damping=-0.1", "time.dt=0", "time.dt=1e9", "time.steps=0",
                         "traction[0].time.ramp_steps=0", "output.every=-1", "output.checkpoint_minutes=-1",
                         "compare.length=0", "compare.traction=0", "published[0].e_u=-1", "grid.spacing=1e-300"):
            self.refused(SCENES / "column.toml", override)


class CheckAndInfo(ProgramTest):
    def resolved(self, path):
        done = vsb("check", path)
        self.assertEqual(done.returncode, 0, done.stderr)
        notes = [line for line in done.stdout.splitlines() if line.startswith("#")]
        return notes, "\n".join(line for line in done.stdout.splitlines() if not line.startswith("#"))

    def test_the_resolved_scene_parses_back_to_itself(self):
        for path in sorted(SCENES.glob("*.toml")) + [self.write(GOOD)]:
            notes, once = self.resolved(path)
            _, twice = self.resolved(self.write(once, path.name))
            self.assertEqual(once, twice)
            self.assertIn("damping", tomllib.loads(once)["method"])
            text = "\n".join(notes)
            for word in ("particles", "boundary nodes", "dt =", "steps", "estimated time", "MB"):
                self.assertIn(word, text)

    def test_check_counts_and_writes_nothing(self):
        before = sorted(p.name for p in self.folder.iterdir())
        notes, _ = self.resolved(SCENES / "cylinder.toml")
        self.assertIn("# 4824 particles, 20 boundary nodes", notes[0])
        expected = 0.2 * 0.25 / math.sqrt(1e9 * 0.8 / (1.2 * 0.6) / 1e3)  # Eq. (29)
        self.assertAlmostEqual(float(re.search(r"dt = ([\d.e+-]+) s", "\n".join(notes))[1]) / expected, 1, delta=1e-5)
        self.assertEqual(before, sorted(p.name for p in self.folder.iterdir()))

    def test_the_estimate_of_a_run_until_static_is_a_limit(self):
        notes = "\n".join(self.resolved(SCENES / "cylinder.toml")[0])
        rate = float(re.search(r"# ([\d.e+-]+) s per 1000 steps", notes)[1])
        whole = re.search(r"max_steps = 1000000 ends the run in any case \((?:(\d+) h ?)?(?:(\d+) min ?)?(?:([\d.]+) s)?\)", notes)
        hours, minutes, seconds = (float(part or 0) for part in whole.groups())
        self.assertAlmostEqual((3600 * hours + 60 * minutes + seconds) / (1000 * rate), 1, delta=0.1)  # rounded
        self.assertNotIn("rest is expected", "\n".join(self.resolved(SCENES / "column.toml")[0]))

    def test_comments_name_the_choices(self):
        done = vsb("check", SCENES / "cylinder.toml").stdout
        for line in (r"precision = 'double' +# one of double, float", r"x_max = 'open' +# one of open, outflow, roller, fixed",
                     r"pressure = .*# .*or stress .*, or exact_ellipse", r"ramp = .*or ramp_steps, .*table, sine",
                     r"kappa = .*or dt", r"max_steps = .*in place of until_static, steps"):
            self.assertRegex(done, line)

    def test_doubtful_units_and_missing_damping_are_warned_of(self):
        for command in (["check"], ["run", "--out", self.folder / "results"]):
            quiet = vsb(command[0], self.write(GOOD), *command[1:])
            self.assertEqual((quiet.returncode, quiet.stderr), (0, ""))
            soft = vsb(command[0], self.write(GOOD), *command[1:], "--set", "body[0].material.youngs_modulus=9e3")
            self.assertIn("warning: largest load / smallest Young's modulus = 1e+03 Pa / 9e+03 Pa = 0.11: check the units", soft.stderr)
        heavy = vsb("check", self.write("gravity = [0.0, -10.0]\n" + GOOD), "--set", "body[0].material.youngs_modulus=1e5",
                    "--set", "faces.y_min=roller")
        self.assertIn("= 2e+04 Pa / 1e+05 Pa = 0.2: check", heavy.stderr)  # 1000 kg/m^3 over the 2 m of the body
        bouncing = self.write(GOOD.replace("steps = 10", "until_static = {}"))
        self.assertIn("method.damping = 0", vsb("check", bouncing).stderr)
        self.assertEqual(vsb("check", bouncing, "--set", "method.damping=0.1").stderr, "")

    def test_overrides_reach_the_scene(self):
        done = vsb("check", SCENES / "column.toml", "--set", "time.dt=0.005", "--set", "grid.spacing=0.5",
                   "--set", "title=two words", "--set", "body[0].density=2")
        self.assertEqual(done.returncode, 0, done.stderr)
        scene = tomllib.loads(done.stdout)
        self.assertEqual((scene["time"]["dt"], scene["grid"]["spacing"], scene["title"], scene["body"][0]["density"]),
                         (0.005, 0.5, "two words", 2.0))

    def test_info(self):
        done = vsb("info")
        self.assertEqual(done.returncode, 0)
        for word in ("version", "commit", "kokkos", "backend", "instruction_set"):
            self.assertRegex(done.stdout, rf"{word} +\S")


if __name__ == "__main__":
    unittest.main()
