# SPDX-License-Identifier: BSD-3-Clause
"""The static solution: the explicit run's figures, closed forms, every dimension and grid, and what it refuses."""
import json
import signal
import subprocess
import time
import unittest

import numpy as np
from vsb_program import PROGRAM, SCENES, ProgramTest, last_fields, vsb

# A block of 4 x 3 x 2 m on rollers under a pressure from above and its own weight.
BLOCK = """
dimension = 3
gravity = [0.0, 0.0, -10.0]
faces = { x_min = "roller", x_max = "roller", y_min = "roller", y_max = "roller", z_min = "roller" }
grid = { lower = [0.0, 0.0, 0.0], upper = [2.0, 1.5, 3.0], spacing = 0.5 }
time = { kappa = 0.5, steps = 1 }
[[body]]
shape = { box = { lower = [0.0, 0.0, 0.0], upper = [2.0, 1.5, 2.0] } }
particles_per_cell = 2
density = 1000.0
material = { youngs_modulus = 1e8, poisson_ratio = 0.25 }
[[traction]]
pressure = 1e4
time = { ramp = 0.1 }
"""

# A disc between two pressures that do or do not balance.
FREE = """
dimension = 2
grid = { lower = [-3.1, -3.2], upper = [2.9, 2.8], spacing = 0.25 }
time = { kappa = 0.5, steps = 1 }
[[body]]
shape = { disc = { center = [0.0, 0.0], radius = 2.0 } }
particles_per_cell = 2
density = 1000.0
material = { youngs_modulus = 1e8, poisson_ratio = 0.25 }
[[traction]]
pressure = 1e4
"""


class StaticTest(ProgramTest):
    def static(self, scene, *arguments, **options):
        summary = self.run_scene(scene, "--static", *arguments, **options)
        self.assertEqual((summary["solution"], summary["static"], summary["steps"]), ("static", True, 0))
        return summary

    def refuse(self, code, scene, *arguments):
        """The message with which a static solution is refused; nothing is written."""
        out = self.folder / "refused"
        done = vsb("run", scene, "--static", "--quiet", "--out", out, *arguments)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        self.assertEqual((done.stdout, done.stderr.count("\n")), ("", 1), done.stderr)
        self.assertFalse(out.exists())
        return done.stderr


class Agreement(StaticTest):
    def test_the_cylinder_has_the_errors_of_the_explicit_run(self):
        for h in (0.5, 0.25):
            at = ("--set", f"grid.spacing={h}")
            explicit = self.run_scene("cylinder", *at, out="explicit")
            static = self.static("cylinder", *at, out="static")
            print(f"h = {h}: explicit {explicit['errors']}, {explicit['steps']} steps in {explicit['seconds']:.3f} s; "
                  f"static {static['errors']}, {static['iterations']} iterations in {static['seconds']:.3f} s")
            for name in ("e_rr", "e_tt"):
                self.assertAlmostEqual(static["errors"][name] / explicit["errors"][name], 1, delta=1e-3)
            # The same particles carry the same stress, up to strains of 1e-4.
            fields = [last_fields(self.folder / out) for out in ("explicit", "static")]
            for name, scale in (("cauchy_stress", 1e5), ("displacement", 1.5e-4)):
                difference = np.abs(fields[0][name] - fields[1][name]).max() / scale
                print(f"  largest difference of {name} {difference:.2e}")
                self.assertLess(difference, 2e-3)
            self.assertLess(static["force_ratio"], 1e-8)
            self.assertEqual(static["particles"], explicit["particles"])
            self.assertEqual(static["boundary_nodes"], explicit["boundary_nodes"])

    def test_every_imposition_and_the_mapped_grid(self):
        # The two differ by the order of the strain; a hundredth of the load leaves strains of 1e-6.
        light = [s for key in ("traction[0].pressure=1e3", "compare.pressure=1e3", "method.damping=0.2",
                               "time.until_static.force_ratio=1e-9", "time.until_static.energy_ratio=1e-16") for s in ("--set", key)]
        short = (*light, "--set", "grid.spacing=0.5")
        cases = [("cylinder", (*short, "--set", f'traction[0].imposition="{i}"', *more)) for i, more in
                 (("virtual_stress", ()), ("virtual_stress_original", ()), ("boundary_particles", ()),
                  ("material_points", ("--set", "traction[0].layer.disc={center=[0.0,0.0],radius=1.3}")))]
        cases.append(("cylinder-polar", (*light, "--set", "time.kappa=1.0")))
        for scene, arguments in cases:
            with self.subTest(scene=scene, arguments=arguments):
                explicit = self.run_scene(scene, *arguments, out="explicit")
                static = self.static(scene, *arguments, out="static")
                for name, error in static["errors"].items():
                    self.assertAlmostEqual(error / explicit["errors"][name], 1, delta=2e-4, msg=name)

    def test_columns(self):
        for scene in ("column", "column-2d", "column-3d", "column-graded"):
            summary = self.static(scene)
            # sigma = -t in every particle; u = -t x / E, where the exact one has strain 1 - exp(-t / E).
            self.assertLess(summary["errors"]["e_sigma"], 1e-9, scene)
            fields = last_fields(self.folder / scene)
            u, x = fields["displacement"][:, 0], fields["position"][:, 0] - fields["displacement"][:, 0]
            np.testing.assert_allclose(u, -1e-3 * x, rtol=1e-8, err_msg=scene)
            np.testing.assert_array_equal(fields["velocity"], 0)

    def test_a_block_under_pressure_and_its_own_weight(self):
        self.static(self.write(BLOCK))
        fields = last_fields(self.folder / "scene")
        u, z = fields["displacement"], (fields["position"] - fields["displacement"])[:, 2]
        # Linear cells carry the mean weight over a layer of half a metre: exact at the middles of their layers.
        middle = (np.floor(z / 0.5) + 0.5) * 0.5
        np.testing.assert_allclose(fields["cauchy_stress"][:, 2], -1e4 - 1e4 * (2 - middle), rtol=1e-8)
        np.testing.assert_allclose(fields["cauchy_stress"][:, 0], fields["cauchy_stress"][:, 2] / 3, rtol=1e-8)
        self.assertLess(np.abs(u[:, :2]).max(), 1e-12)
        self.assertTrue((u[:, 2] < 0).all())

    def test_initial_stress_counts(self):
        free = self.write(FREE)
        for spacing in (0.25, 0.24):  # without and with round-off in what is left of the forces
            summary = self.static(free, "--set", "body[0].stress=[-1e4,-1e4,-1e4,0,0,0]", "--set", f"grid.spacing={spacing}")
            self.assertEqual(summary["iterations"], 0)
            np.testing.assert_array_equal(last_fields(self.folder / "scene")["displacement"], 0)

    def test_any_number_of_threads_gives_the_same_bits(self):
        if "OpenMP" not in [line.split()[-1] for line in vsb("info").stdout.splitlines() if "backend" in line]:
            self.skipTest("a backend without threads")
        passive = {"OMP_WAIT_POLICY": "passive"}
        runs = [self.static("cylinder", "--threads", n, environment=passive) for n in (1, 3)]
        self.assertEqual(*[(run["state_hash"], run["iterations"], run["force_ratio"]) for run in runs])


class Output(StaticTest):
    def test_frames_summary_and_report(self):
        out = self.folder / "cylinder"
        self.run_scene("cylinder", "--set", "time.until_static.max_steps=100")  # leaves frames 0 and 100
        done = vsb("run", SCENES / "cylinder.toml", "--static", "--out", out, "--set", "output.grid=true", "--set", "output.every=10")
        self.assertEqual(done.returncode, 0)
        self.assertRegex(done.stderr, r"\Avsb: keeping the checkpoint that was there as \S*/cylinder\.checkpoint\.step-100 \(.*\)\n\Z")
        self.assertIn("static solution under the loads at 0.2 s", done.stdout)
        self.assertRegex(done.stdout, r"iteration \d+, relative residual \d\.\d\de-1[0-9]\n")
        self.assertRegex(done.stdout, r"\d+ iterations in [\d.e-]+ s: [\d.]+ ns per particle and iteration")
        self.assertIn("independent prototype", done.stdout)
        self.assertEqual(sorted(p.name for p in out.glob("*.hdf")), ["cylinder_000000.hdf", "cylinder_grid_000000.hdf"])
        summary = json.loads((out / "summary.json").read_text())
        self.assertGreater(summary["iterations"], 10)
        self.assertAlmostEqual(summary["ns_per_particle_step"],
                               1e9 * summary["seconds"] / summary["particles"] / summary["iterations"], delta=1e-6)
        self.assertIn("exact_cauchy_stress", last_fields(out))
        # The quarter hole of 1 m under 0.1 MPa.
        for i in range(2):
            self.assertAlmostEqual(summary["exact_force"][i], 1e5, delta=2e3)
            self.assertLess(abs(summary["net_force"][i] - 1e5), 0.1e5)

    def test_advice_on_steps_is_not_given(self):
        undamped = ("--set", "method.damping=0.0", "--set", "grid.spacing=0.5", "--set", "time.until_static.max_steps=1")
        run = lambda *more: vsb("run", SCENES / "cylinder.toml", "--quiet", "--out", self.folder / "c", *undamped, *more).stderr
        self.assertIn("damping = 0", run())
        self.assertNotIn("damping", run("--static"))

    def test_large_strains_are_warned_about(self):
        soft = ("--set", "body[0].material.youngs_modulus=1e6")
        done = vsb("run", self.write(BLOCK), "--static", "--out", self.folder / "soft", "--quiet", *soft)
        self.assertEqual(done.returncode, 0)
        self.assertRegex(done.stderr, r"^vsb: warning: strains up to 0\.02\d*, rotations .*: --static is linear.* 2\.\d %")
        self.assertEqual(vsb("run", self.write(BLOCK), "--static", "--out", self.folder / "stiff", "--quiet").stderr, "")

    def test_a_checkpoint_is_not_discarded_without_a_word(self):
        self.static("column")
        (self.folder / "column" / "column.checkpoint").write_text("nothing that can be read")
        self.assertEqual(vsb("run", SCENES / "column.toml", "--static", "--quiet", "--out", self.folder / "column").returncode, 0)
        self.assertFalse((self.folder / "column" / "column.checkpoint").exists())


    def test_an_interrupt_leaves_nothing(self):
        out = self.folder / "out"
        run = subprocess.Popen([PROGRAM, "run", str(SCENES / "cylinder.toml"), "--static", "--out", str(out), "--set", "grid.spacing=0.05",
                                "--set", "static.residual=1e-300"], stdout=subprocess.PIPE, text=True)
        run.stdout.readline()  # the head line: it has begun
        time.sleep(0.5)
        run.send_signal(signal.SIGINT)
        output, _ = run.communicate(timeout=60)
        self.assertEqual(run.returncode, 5)
        self.assertRegex(output, r"interrupted at iteration \d+; a static solution begins anew\n$")
        self.assertFalse(out.exists())


class Refusals(StaticTest):
    def test_loads_without_support(self):
        free = self.write(FREE)
        self.assertGreater(self.static(free)["iterations"], 0)  # in balance
        pushed = self.refuse(2, free, "--set", "traction[0].surface.box={lower=[-9.0,-9.0],upper=[0.0,9.0]}")
        # 10 kPa on a diameter of 4 m; the lattice is not symmetric about y = 0, so there is some torque.
        self.assertRegex(pushed, r"--static: there is no static state: no support takes up a force of \(4e\+04, [^)]*\) N and a torque of \(0, 0, -?\d[^)]*\) N m")
        self.assertRegex(pushed, r"\d+ % of the sum of the forces .* at its nodes: hold it along x and against turning by a face .*'faces'")
        self.refuse(2, free, "--set", "gravity=[0.0,-9.81]")
        self.static(free, "--set", "gravity=[0.0,-9.81]", "--set", "faces.y_min=\"fixed\"", "--set", "grid.lower=[-3.1,-1.9]",
                    "--set", "grid.upper=[2.9,2.85]")
        # The paper's load on the free ring leaves a resultant.
        self.assertIn('may be what the cells at the boundary leave of loads that balance, and nodes = "all"',
                      self.refuse(2, SCENES / "cylinder-free.toml"))

    def test_an_explicit_run_of_a_body_that_nothing_holds_is_warned_of(self):
        free = self.write(FREE)
        until_static = ("--set", "time={kappa=0.5,until_static={max_steps=20}}", "--set", "method.damping=0.5")
        weight = ("--set", "gravity=[0.0,-9.81]")
        warning = r"warning: at the start, and at full load, no support takes up a force of \([^)]*, -1\.\d+e\+05\) N"
        for command in ("check", "run"):
            out = ("--out", self.folder / "free") if command == "run" else ()
            self.assertRegex(vsb(command, free, *until_static, *weight, *out).stderr, warning)
        self.assertNotIn("no support", vsb("check", free, *until_static).stderr)  # in balance
        self.assertNotIn("no support", vsb("check", free, *weight).stderr)  # it is to move
        block = self.write(BLOCK)
        self.assertNotIn("no support", vsb("check", block, *until_static).stderr)

    def test_scenes_that_move(self):
        block = self.write(BLOCK)
        self.assertIn("traction 'traction 1' is a sine", self.refuse(2, block, "--set", "traction[0].time={sine={period=1.0}}"))
        self.assertIn("body 'body 1' has an initial velocity", self.refuse(2, block, "--set", "body[0].velocity=[0.0,0.0,1.0]"))
        self.assertIn('precision = "double"', self.refuse(2, block, "--set", "precision=\"float\""))

    def test_not_found(self):
        message = self.refuse(7, SCENES / "cylinder.toml", "--set", "static.max_iterations=5")
        self.assertRegex(message, r"^vsb: not static after 5 iterations of at most 5 \(relative residual [\d.e-]+, wanted 1\.00e-10\)")

    def test_residual(self):
        runs = [self.static("cylinder", "--set", f"static.residual={r}") for r in ("1e-3", "1e-12")]
        self.assertLess(runs[0]["iterations"], runs[1]["iterations"])
        self.assertLess(runs[1]["force_ratio"], runs[0]["force_ratio"])

    def test_bad_keys_and_command_lines(self):
        for value, word in (("residual=0", "> 0"), ("residual=1.0", "< 1"), ("residual=\"small\"", "(a string)"),
                            ("max_iterations=0", "from 1 to"), ("max_iterations=1.5", "integer"), ("residuum=1e-8", "did you mean 'residual'")):
            for command in (("check",), ("run",)):
                done = vsb(*command, SCENES / "column.toml", "--set", f"static.{value}")
                self.assertEqual(done.returncode, 2, value)
                self.assertIn("static", done.stderr)
                self.assertIn(word, done.stderr)
        done = vsb("run", SCENES / "column.toml", "--static", "--resume")
        self.assertEqual(done.returncode, 2)
        self.assertEqual(done.stderr, "vsb: --static takes no steps, so there is none to --resume from; give one of the two\n")
        self.assertEqual(vsb("check", SCENES / "column.toml", "--static").returncode, 2)

    def test_check_prints_the_keys(self):
        resolved = vsb("check", SCENES / "column.toml", "--set", "static.residual=1e-7").stdout
        self.assertRegex(resolved, r"(?s)\[static\]\nresidual = 1e-07.*max_iterations = 20000")


class Studies(StaticTest):
    STUDY = """
        title = "Explicit and static"
        scene = "SCENES/cylinder.toml"
        set = ["grid.spacing=0.5", "method.damping=0.2"]
        axis = { name = "solver", labels = true }
        [[series]]
        name = "s"
        case = [{ label = "explicit", expect = { iterations = { lowest = 0, highest = 0 } } },
                { label = "static", static = true, expect = { steps = { lowest = 0, highest = 0 }, iterations = { lowest = 10 } } },
                { label = "too short", static = true, set = ["static.max_iterations=3"], expect_failure = "not static after 3 iterations" },
                { label = "no support", static = true, set = ["faces.x_min=\\"open\\"", "grid.lower=[-6.0,0.0]", "traction[0].surface={box={lower=[0.0,0.0],upper=[3.0,3.0]}}"], expect_failure = "no support" }]
        [[relation]]
        title = "the same hoop stress"
        figure = "e_tt"
        first = { series = "s", label = "explicit" }
        second = { series = "s", label = "static" }
        ratio = { value = 1.0, tolerance = 1e-3 }
        """

    def test_static_cases_stand_beside_explicit_ones(self):
        study = self.write(self.STUDY.replace("SCENES", str(SCENES)), "mine.toml")
        out = self.folder / "out"
        done = vsb("study", study, "--out", out)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("mine: 6 pass, 0 fail", done.stdout)
        summary = json.loads((out / "cases" / "s_static" / "summary.json").read_text())
        self.assertEqual(summary["solution"], "static")
        rows = [line.split(",") for line in (out / "mine.csv").read_text().splitlines()]
        head, static = rows[0], next(row for row in rows if row[2:4] == ["static", "e_rr"])
        cell = dict(zip(head, static))
        self.assertEqual(float(cell["particle_steps"]), summary["particles"] * summary["iterations"])
        self.assertAlmostEqual(float(cell["seconds"]) / summary["seconds"], 1, delta=1e-9)
        # Done is done; another way to solve is another case.
        self.assertEqual(vsb("study", study, "--out", out).stdout.count("done before"), 4)
        turned = self.write(self.STUDY.replace("SCENES", str(SCENES)).replace('"explicit", expect', '"explicit", static = true, expect'),
                            "mine.toml")
        done = vsb("study", turned, "--out", out)
        self.assertEqual(done.stdout.count("done before"), 3)
        self.assertEqual(done.returncode, 6)  # it has iterations now

    def test_a_bad_value(self):
        study = self.write(self.STUDY.replace("SCENES", str(SCENES)).replace("static = true", 'static = "yes"', 1), "mine.toml")
        done = vsb("study", study, "--out", self.folder / "out")
        self.assertEqual(done.returncode, 2)
        self.assertRegex(done.stderr, r"mine\.toml:9:\d+: .*static")


if __name__ == "__main__":
    unittest.main()
