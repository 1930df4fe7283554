# SPDX-License-Identifier: BSD-3-Clause
"""Studies: verdicts, tables and pictures, mistakes in study files, and going on after an interrupt."""
import json
import math
import signal
import subprocess
import time
import tomllib
import unittest

from study_test import StudyTest
from vsb_program import PROGRAM, ROOT, SCENES, vsb

TIMES = {"seconds", "ns_per_particle_step"}

# By hand: 9.5 m of cells of 1 m with 8 particles each; 200 of 10,000 ramp steps of 0.01 s to 1 Pa; nodes 9 and 10 around
# the end at 9.5 m.
GOOD = """\
title = "Short column"
scene = "SCENES/column.toml"
set = ["time.steps=200"]
source = "by hand"
published_source = "nobody"

[axis]
name = "variant"
labels = true

[[series]]
name = "one, two"

[[series.case]]
label = "a"
expect = { particles = { value = 76, tolerance = 0 }, steps = { value = 200, tolerance = 0 }, net_force_x = { value = -0.02, tolerance = 1e-4 } }
published = { e_u = 0.5 }

[[series.case]]
label = "b"
set = ["method.volume_update=exponential"]
expect = { boundary_nodes = { value = 2, tolerance = 0 }, time = { lowest = 1.99, highest = 2.01 } }
"""


def changed(old, new, text=GOOD):
    assert text.count(old) == 1, old
    return text.replace(old, new)


class Verdicts(StudyTest):
    def test_a_study_that_passes(self):
        done, table = self.study(GOOD)
        verdicts = {(row["case"], row["figure"]): row["verdict"] for row in table}
        self.assertEqual(verdicts, {
            ("a", "e_u"): "", ("a", "e_u_exact"): "", ("a", "e_sigma"): "", ("a", "particles"): "pass", ("a", "steps"): "pass",
            ("a", "net_force_x"): "pass", ("b", "e_u"): "", ("b", "e_u_exact"): "", ("b", "e_sigma"): "",
            ("b", "boundary_nodes"): "pass", ("b", "time"): "pass"})
        self.assertIn("mine: 5 pass, 0 fail", done.stdout)
        self.assertIn("case 2 of 2: one, two, b (76 particles", done.stdout)

        alone = self.run_scene("column", "--set", "time.steps=200")
        for row in (row for row in table if row["case"] == "a"):
            self.assertEqual((row["study"], row["series"]), ("mine", "one, two"))
            if row["figure"] in alone["errors"]:
                self.assertEqual(float(row["value"]), alone["errors"][row["figure"]])
            self.assertEqual(row["state_hash"], alone["state_hash"])
            self.assertEqual((row["particles"], row["steps"], row["particle_steps"]), ("76", "200", "15200"))
            self.assertAlmostEqual(float(row["seconds"]) / (15200e-9 * float(row["ns_per_particle_step"])), 1, delta=1e-9)
            self.assertTrue((self.folder / "out" / row["directory"] / "summary.json").is_file())
        self.assertNotEqual(self.line(table, "b", "e_u")["state_hash"], alone["state_hash"])
        force = self.line(table, "a", "net_force_x")
        self.assertEqual((float(force["expected"]), force["source"]), (-0.02, "by hand"))
        self.assertAlmostEqual(float(force["lowest"]), -0.020002, delta=1e-12)
        self.assertAlmostEqual(float(force["highest"]), -0.019998, delta=1e-12)
        self.assertAlmostEqual(float(force["deviation"]), float(force["value"]) / -0.02 - 1, delta=1e-12)
        self.assertEqual(self.line(table, "a", "e_u")["published"], "0.5")

        about = json.loads((self.folder / "out" / "mine.json").read_text())
        self.assertEqual((about["series"], about["errors"]), (["one, two"], ["e_u", "e_u_exact", "e_sigma"]))
        for kind in ("errors", "cost"):
            picture = (self.folder / "out" / f"mine_{kind}.png").read_bytes()
            self.assertEqual(picture[:8], b"\x89PNG\r\n\x1a\n")
            self.assertGreater(len(picture), 10_000)

    def test_a_missed_expectation_has_its_own_exit_code_and_line(self):
        for old, new in (("value = -0.02, tolerance = 1e-4", "value = -0.021, tolerance = 0.04"),
                         ("value = -0.02, tolerance = 1e-4", "lowest = -0.0199"),
                         ("value = -0.02, tolerance = 1e-4", "highest = -0.0201")):
            done, table = self.study(changed(old, new), "--quiet", code=6)
            failing = [row["figure"] for row in table if row["verdict"] == "fail"]
            self.assertEqual(failing, ["net_force_x"])
            self.assertEqual(len(done.stdout.splitlines()), 1, done.stdout)
            self.assertRegex(done.stdout, r"one, two, a:\s+FAIL net_force_x\s+-")
        self.study(changed("value = -0.02, tolerance = 1e-4", "value = -0.021, tolerance = 0.06"))

    def test_expected_failures(self):
        case = 'label = "{}"\nset = ["{}"]\nexpect_failure = "{}"\n'
        head = GOOD[:GOOD.index("[[series.case]]")]
        good = [("refused at reading", "time.dtt=1", "unknown key 'dtt' in time"),
                ("refused at set-up", "traction[0].surface={ box = { lower = [0.0], upper = [1.0] } }", "finds no boundary node"), ("diverged", "time.dt=0.06", "diverged at step")]
        head = head.replace("time.steps=200", "time.steps=20000")
        _, table = self.study(head + "".join("[[series.case]]\n" + case.format(*c) for c in good))
        self.assertEqual([(row["figure"], row["verdict"]) for row in table], [("outcome", "pass")] * 3)
        for row, (_, _, text) in zip(table, good):
            self.assertIn(text, row["note"])
        bad = [("another reason", "time.dt=0.06", "out of paper"), ("none at all", "time.steps=10", "diverged")]
        _, table = self.study(head + "".join("[[series.case]]\n" + case.format(*c) for c in bad), code=6)
        self.assertEqual([(row["figure"], row["verdict"]) for row in table], [("outcome", "fail")] * 2)
        self.assertIn("diverged at step", table[0]["note"])
        self.assertIn("ran without an error", table[1]["note"])

    def test_an_unexpected_failure_fails_and_the_study_goes_on(self):
        text = changed('label = "a"', 'label = "a"\nset = ["time.dt=0.06", "time.steps=20000"]')
        _, table = self.study(text, code=6)
        self.assertEqual(self.line(table, "a", "outcome")["verdict"], "fail")
        self.assertIn("diverged at step", self.line(table, "a", "outcome")["note"])
        self.assertEqual((self.line(table, "a", "particles")["verdict"], self.line(table, "a", "particles")["value"]), ("fail", ""))
        self.assertEqual(self.line(table, "b", "boundary_nodes")["verdict"], "pass")

    def test_sweep_rates_and_relations(self):
        text = """
            title = "Coarse cylinders"
            scene = "SCENES/cylinder.toml"
            set = ["time.until_static.max_steps=100"]
            expect_static = false
            rates = true
            axis = { name = "h", unit = "m", log = true }
            [[series]]
            name = "uniform"
            sweep = "grid.spacing"
            case = [{ axis = 0.5 }, { axis = 0.25, expect = { particles = { value = 4824, tolerance = 0 } } },
                    { axis = 0.125, fine = true }]
            """
        relation = """
            [[relation]]
            title = "t%d"
            figure = "particles"
            first = { series = "uniform", axis = %s }
            second = { series = "uniform", axis = %s }
            %s
            """
        coarse = int(self.run_scene("cylinder", "--set", "grid.spacing=0.5", "--set", "time.until_static.max_steps=1")["particles"])
        relations = [("0.25", "0.5", f"ratio = {{ value = {4824 / coarse}, tolerance = 1e-12 }}"),
                     ("0.25", "0.5", f"difference = {{ value = {4824 - coarse}, tolerance = 0 }}"),
                     ("0.50", "0.25", f"rate = {{ value = {math.log2(coarse / 4824)}, tolerance = 1e-12 }}"),
                     ("0.25", "0.5", "ratio = { highest = 1 }"), ("0.125", "0.5", "ratio = { lowest = 1 }")]
        done, table = self.study(text + "".join(relation % (i, *r) for i, r in enumerate(relations)), code=6)
        self.assertEqual([(row["case"], row["figure"], row["verdict"]) for row in table if row["series"] == "relation"],
                         [("t0", "ratio of particles", "pass"), ("t1", "difference of particles", "pass"),
                          ("t2", "rate of particles", "pass"), ("t3", "ratio of particles", "fail")])
        for error in ("e_rr", "e_tt", "e_u"):
            first, second = self.line(table, "0.5", error), self.line(table, "0.25", error)
            self.assertEqual(first["rate"], "")
            self.assertAlmostEqual(float(second["rate"]), math.log2(float(first["value"]) / float(second["value"])), delta=1e-9)
        self.assertNotIn("0.125", {row["case"] for row in table})
        self.assertIn("not static after max_steps = 100", self.line(table, "0.5", "e_rr")["note"])
        self.assertRegex(done.stdout, r"e_rr .* rate +-?\d")

        _, table = self.study(text.replace("max_steps=100", "max_steps=1"), "--fine")
        self.assertEqual({row["case"] for row in table}, {"0.5", "0.25", "0.125"})


    def test_a_case_that_is_not_static_fails_unless_expected(self):
        text = """
            title = "Too short"
            scene = "SCENES/cylinder.toml"
            set = ["grid.spacing=0.5", "time.until_static.max_steps=10"]
            axis = { name = "variant", labels = true }
            [[series]]
            name = "s"
            case = [{ label = "a", expect = { steps = { value = 10, tolerance = 0 } }%s }]
            """
        _, table = self.study(text % "", code=6)
        self.assertEqual((self.line(table, "a", "outcome")["verdict"], self.line(table, "a", "steps")["verdict"]), ("fail", "pass"))
        self.assertIn("not static after max_steps = 10", self.line(table, "a", "outcome")["note"])
        _, table = self.study(text % ", expect_static = false")
        self.assertEqual([row for row in table if row["figure"] == "outcome"], [])
        expected = (text % ', expect_failure = "not static"').replace("expect = { steps = { value = 10, tolerance = 0 } }, ", "")
        _, table = self.study(expected)
        self.assertEqual([(row["figure"], row["verdict"]) for row in table], [("outcome", "pass")])

    def test_target(self):
        """The cost of a level of error: between the cases a power law through both, beyond them extrapolated."""
        text = """
            title = "Coarse cylinders"
            scene = "SCENES/cylinder.toml"
            set = ["time.until_static.max_steps=100"]
            expect_static = false
            axis = { name = "h", unit = "m", log = true }
            [[series]]
            name = "uniform"
            sweep = "grid.spacing"
            case = [{ axis = 0.5 }, { axis = 0.25 }]
            """
        _, table = self.study(text)
        coarse, fine = ({"error": float(self.line(table, case, "e_u")["value"]),
                         "cost": float(self.line(table, case, "e_u")["particle_steps"])} for case in ("0.5", "0.25"))
        self.assertNotEqual(coarse["error"], fine["error"])
        better, worse = sorted((coarse["error"], fine["error"]))
        levels = {"between": math.sqrt(better * worse), "beyond": better / 1.01, "less": 1.01 * worse}
        for name, level in levels.items():
            _, table = self.study(text + f"[target]\nfigures = [\"e_u\"]\nlevel = {level!r}\n", out=name)
            line, = (row for row in table if row["series"] == "target" and row["figure"].startswith("particle-steps to e_u"))
            self.assertEqual(line["case"], "uniform")
            if name == "less":
                self.assertEqual(float(line["value"]), coarse["cost"])
                self.assertIn("at most", line["note"])
            elif fine["error"] < coarse["error"]:
                power = math.log(fine["cost"] / coarse["cost"]) / math.log(fine["error"] / coarse["error"])
                self.assertAlmostEqual(float(line["value"]), coarse["cost"] * (level / coarse["error"]) ** power,
                                       delta=1e-9 * coarse["cost"])
                self.assertEqual(line["note"], "" if name == "between" else "extrapolated")
            else:
                self.assertTrue(line["note"])


class BadStudies(StudyTest):
    def test_unknown_keys(self):
        self.refuse(changed("title =", "ttle ="), "unknown key 'ttle'", "did you mean 'title'", line=1)
        self.refuse(changed("labels = true", "labels = true\nlog = true"), "unknown key 'log' in axis", line=10)
        self.refuse(changed('label = "b"', 'label = "b"\nfein = true'), "unknown key 'fein' in series[0].case[1]",
                    "did you mean 'fine'", line=21)
        self.refuse(changed("highest = 2.01", "hihgest = 2.01"), "unknown key 'hihgest'", "did you mean 'highest'", line=22)

    def test_missing_scene(self):
        self.refuse(changed("SCENES/column.toml", "nowhere.toml"), "there is no file", "nowhere.toml", line=2)
        self.refuse(changed('scene = "SCENES/column.toml"\n', ""), "scene is missing", line=13)

    def test_overrides_that_the_scene_refuses(self):
        self.refuse(changed("volume_update=exponential", "volume_update=cubic"), "--set method.volume_update=cubic",
                    "the scene of this case is refused", line=20)
        self.refuse(changed('set = ["time.steps=200"]', 'set = [200]'), "set", "array of overrides", line=3)
        self.refuse(changed('set = ["time.steps=200"]', 'set = "time.steps=200"'), "set", "array of overrides", line=3)

    def test_bad_expectations(self):
        good = "value = -0.02, tolerance = 1e-4"
        self.refuse(changed(good, "value = -0.02, tolerance = -1e-4"), "tolerance", ">= 0", line=16)
        self.refuse(changed(good, 'value = -0.02, tolerance = "1 %"'), "tolerance", "(a string)", line=16)
        self.refuse(changed(good, "value = -0.02"), "tolerance is missing", line=16)
        self.refuse(changed(good, "value = 0.0, tolerance = 0.1"), "relative tolerance of zero", line=16)
        self.refuse(changed(good, "value = 0.02, highest = 1"), "either value and tolerance, or lowest and highest", line=16)
        self.refuse(changed(good, "lowest = 2, highest = 1"), "highest", ">= 2", line=16)
        self.refuse(changed("{ value = -0.02, tolerance = 1e-4 }", "-0.02"), "needs a tolerance", line=16)
        self.refuse(changed("net_force_x =", "net_force_y ="), "no such figure", "did you mean 'net_force_x'", line=16)
        self.refuse(changed("published = { e_u", "published = { e_v"), "no such figure", "did you mean 'e_u'", line=17)
        self.refuse(changed('label = "a"', 'label = "a"\nexpect_failure = "x"'), "expected to fail has no figures", line=17)

    def test_bad_axes_series_and_cases(self):
        self.refuse(changed('label = "b"', 'label = "A"'), "has this case already", line=20)
        self.refuse(changed('label = "b"', "axis = 2"), "label is missing", line=19)
        self.refuse(changed("labels = true\n", ""), "axis is missing", line=13)
        self.refuse(changed('name = "variant"\nlabels = true', 'name = "h"\nlog = true')
                    .replace('label = "a"', "axis = 0").replace('label = "b"', "axis = 1"), "axis", "> 0", line=15)
        self.refuse(GOOD.replace("title =", "rates = true\ntitle ="), "rates need a logarithmic axis", line=1)
        self.refuse(GOOD + '[[series]]\nname = "One  two"\ncase = [{ label = "a" }]\n', "another series has this name", line=24)
        self.refuse(GOOD[:GOOD.index("[[series]]")], "series is missing")
        self.refuse(GOOD[:GOOD.index("[[series.case]]")], "case is missing", line=11)

    def test_bad_relations(self):
        relation = '[[relation]]\ntitle = "t"\nfigure = "e_u"\nfirst = { series = "one, two", label = "a" }\n' \
                   'second = { series = "one, two", label = "b" }\nratio = { lowest = 0 }\n'
        self.study(GOOD + relation, out="good")
        for old, new, word, line in (('label = "b"', 'label = "c"', "no such case", 27), ('"one, two"', '"one"', "no series of this name", 26),
                                     ("ratio", "rate", "logarithmic axis", 28), ("e_u", "e_v", "no such figure", 25),
                                     ("ratio = { lowest = 0 }", "", "exactly one of ratio, difference and rate", 23)):
            self.refuse(GOOD + relation.replace(old, new), word, line=line)

    def test_bad_target(self):
        self.refuse(GOOD + "[target]\nfigures = [\"e_u\"]\nlevel = 0\n", "level", line=25)
        self.refuse(GOOD + "[target]\nfigures = [\"e_v\"]\nlevel = 1\n", "e_v", line=24)

    def test_unknown_studies(self):
        done = vsb("study", "colum", "--out", self.folder / "out")
        self.assertEqual(done.returncode, 2)
        for word in ("no study 'colum'", "did you mean 'column'", "cylinder-mesh"):
            self.assertIn(word, done.stderr)
        done = vsb("study", self.folder / "none.toml")
        self.assertEqual(done.returncode, 2)
        self.assertIn("none.toml", done.stderr)

    def test_the_studies_of_the_repository_are_good(self):
        for path in sorted((ROOT / "apps" / "studies").glob("*.toml")):
            text = path.read_text()
            self.assertIn(f"vsb study {path.stem}", text)
            # An axis that no study has: it is read, with all its scenes, up to there.
            broken = self.write(text.replace("../scenes", str(SCENES)) + "\n[[relation]]\ntitle = 1\n", path.name)
            done = vsb("study", broken, "--out", self.folder / "out")
            self.assertIn("relation[", done.stderr)
            self.assertIn("title = 1", done.stderr)


LONG = """\
title = "Three columns"
scene = "SCENES/column.toml"
axis = { name = "number of steps" }
[[series]]
name = "steps"
sweep = "time.steps"
case = [{ axis = 300 }, { axis = 600000, expect = { time = { value = 6000.0, tolerance = 1e-12 } } }, { axis = 400 }]
"""


class GoingOn(StudyTest):
    def case(self, number, file):
        return self.folder / "out" / "cases" / f"steps_{number}" / file

    def interrupt(self, *arguments):
        """Starts the study, interrupts it in the second case, returns exit code and output."""
        run = subprocess.Popen([PROGRAM, "study", str(self.file(LONG)), "--out", str(self.folder / "out"), *arguments],
                               stdout=subprocess.PIPE, text=True)
        output = ""
        while "case 2 of 3" not in output:
            output += run.stdout.readline()
        time.sleep(0.2)
        run.send_signal(signal.SIGINT)
        output += run.communicate(timeout=60)[0]
        return run.returncode, output

    def test_an_interrupted_study_goes_on(self):
        code, output = self.interrupt()
        self.assertEqual(code, 5, output)
        self.assertIn("the same command goes on", output)
        self.assertEqual({row["case"] for row in self.table()}, {"300"})
        self.assertTrue(self.case(600000, "column.checkpoint").is_file())
        self.assertFalse(self.case(600000, "summary.json").exists())
        self.assertFalse(self.case(400, "summary.json").exists())
        record = tomllib.loads(self.case(600000, "case.toml").read_text())
        self.assertEqual(record["state"], "running")
        self.assertTrue(0 < record["steps_timed"] < 600000)
        finished = self.case(300, "summary.json").stat().st_mtime_ns

        done, table = self.study(LONG)
        self.assertEqual(self.case(300, "summary.json").stat().st_mtime_ns, finished)
        self.assertEqual(done.stdout.count("done before"), 1)
        # A run from the start would have timed more steps than there are.
        self.assertFalse(self.case(600000, "column.checkpoint").exists())
        self.assertEqual(tomllib.loads(self.case(600000, "case.toml").read_text())["steps_timed"], 600000)

        _, whole = self.study(LONG, out="whole")
        self.assertEqual(len(whole), 10)
        without_times = [[{k: v for k, v in row.items() if k not in TIMES} for row in rows] for rows in (table, whole)]
        self.assertEqual(without_times[0], without_times[1])

    def test_only_what_changed_runs_again(self):
        self.study(GOOD)
        cases = {label: self.folder / "out" / "cases" / f"one-two_{label}" for label in "ab"}
        written = {label: (path / "summary.json").stat().st_mtime_ns for label, path in cases.items()}
        self.study(changed("value = 76, tolerance = 0", "value = 77, tolerance = 0"), code=6)  # no scene has changed
        self.assertEqual({label: (path / "summary.json").stat().st_mtime_ns for label, path in cases.items()}, written)
        damped = changed("volume_update=exponential", "damping=0.1")
        self.study(damped)
        self.assertEqual((cases["a"] / "summary.json").stat().st_mtime_ns, written["a"])
        self.assertNotEqual((cases["b"] / "summary.json").stat().st_mtime_ns, written["b"])
        (cases["a"] / "summary.json").unlink()
        (cases["b"] / "case.toml").write_text((cases["b"] / "case.toml").read_text()[:100])
        done, _ = self.study(damped)
        self.assertNotIn("done before", done.stdout)
        record = cases["a"] / "case.toml"
        record.write_text(record.read_text().replace("program = 'vsb ", "program = 'vsb 0.0.0 "))
        done, _ = self.study(damped)
        self.assertEqual(done.stdout.count("done before"), 1)

    def test_a_directory_that_cannot_be_written(self):
        (self.folder / "file").write_text("in the way")
        done = vsb("study", self.file(GOOD), "--out", self.folder / "file" / "out")
        self.assertEqual(done.returncode, 4)
        self.assertIn("file/out", done.stderr)


if __name__ == "__main__":
    unittest.main()
