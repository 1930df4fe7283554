# SPDX-License-Identifier: BSD-3-Clause
"""Long runs: what a run that is over, stopped, killed or out of disk leaves, and how another goes on from it."""
import hashlib
import json
import os
import re
import resource
import shutil
import signal
import subprocess
import time
import unittest

import h5py
import numpy as np
from vsb_program import PROGRAM, SCENES, ProgramTest, frames, last_fields, vsb

SEAL = 40  # bytes


def step_of(checkpoint):
    with h5py.File(checkpoint) as file:
        return int(file["checkpoint"].attrs["step"][0])


def seal(path):
    """Seals a file whose last seal has been taken off."""
    data = path.read_bytes()
    path.write_bytes(data + b"vsb-seal" + hashlib.sha256(data).digest())


class CheckpointTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.out = self.folder / "column"
        self.checkpoint = self.out / "column.checkpoint"

    def column(self, steps, *more, code=0, **options):
        done = vsb("run", SCENES / "column.toml", "--out", self.out, "--set", f"time.steps={steps}", *more, **options)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done

    def hash(self, out=None):
        return json.loads(((out or self.out) / "summary.json").read_text())["state_hash"]

    def contents(self, *patterns):
        """Names and bytes of the files in the results' directory."""
        return {p.name: p.read_bytes() for pattern in patterns or ("*",) for p in self.out.glob(pattern)}


class GoingOn(CheckpointTest):
    def test_a_run_that_is_over_goes_on_to_a_later_end(self):
        whole = self.run_scene("column", "--set", "time.steps=730", "--set", "output.every=100", out="whole")
        self.column(350, "--set", "output.every=100")
        self.assertEqual(step_of(self.checkpoint), 350)
        earlier = self.contents("column_*.hdf")
        self.assertEqual(len(earlier), 5)
        done = self.column(730, "--set", "output.every=100", "--resume")
        self.assertIn("resumed at step 350\n", done.stdout)
        self.assertEqual(self.hash(), whole["state_hash"])
        self.assertEqual(json.loads((self.out / "summary.json").read_text())["errors"], whole["errors"])
        later = self.contents("column_*.hdf")
        self.assertEqual({name: later[name] for name in earlier}, earlier)
        self.assertEqual([file.name for file, _ in frames(self.out)],
                         [f"column_{n:06d}.hdf" for n in (0, 100, 200, 300, 350, 400, 500, 600, 700, 730)])
        self.assertEqual(step_of(self.checkpoint), 730)

    def test_resumed_with_nothing_to_do_it_stays_as_it_is(self):
        self.column(120)
        earlier, before = self.contents("column*"), self.hash()
        done = self.column(120, "--resume")
        self.assertIn("resumed at step 120", done.stdout)
        self.assertTrue(self.contents("column*") == earlier)
        self.assertEqual(self.hash(), before)

    def test_output_may_change(self):
        self.column(100)
        self.column(200, "--resume", "--set", "output.every=50", "--set", 'output.fields=["id","mass"]', "--set", "title=longer")
        self.assertEqual([file.name for file, _ in frames(self.out)], [f"column_{n:06d}.hdf" for n in (0, 100, 150, 200)])
        self.assertEqual(set(last_fields(self.out)), {"position", "id", "mass", "exact_displacement", "exact_cauchy_stress"})
        self.assertEqual(self.hash(), self.run_scene("column", "--set", "time.steps=200", out="whole")["state_hash"])

    def test_nothing_else_may(self):
        self.column(100)
        earlier = self.contents()
        for override, here, there in (("body[0].density=1.5", "1.5", "1.0"), ("traction[0].pressure=2.0", "2.0", "1.0"),
                                      ("time.dt=0.005", "0.005", "0.01"), ("method.damping=0.0", "0.0", "0.05"),
                                      ("precision=float", "'float'", "'double'"), ("grid.upper=[13.0]", "13.0", "12.0"),
                                      ("gravity=[1.0]", "1.0", "0.0"), ("method.engine=particles", "'particles'", "'auto'")):
            key = override.partition("=")[0]
            done = self.column(200, "--resume", "--set", override, code=4)
            self.assertRegex(done.stderr, rf"column\.checkpoint: written for another scene: {re.escape(key)}(\[0\])? is "
                                          rf"{there} there, and {here} here \(a resumed run may change title, output,")
            self.assertEqual(self.contents(), earlier)

    def test_an_end_before_the_checkpoint_is_refused(self):
        self.column(100)
        earlier = self.contents()
        done = self.column(60, "--resume", code=2)
        self.assertIn("the checkpoint is of step 100, and time.steps = 60 ends the run before it", done.stderr)
        self.assertEqual(self.contents(), earlier)

    COARSE = ("--set", "grid.spacing=0.5")

    def test_a_static_run_goes_on_to_a_stricter_criterion(self):
        strict = ("--set", "time.until_static.force_ratio=1e-8", "--set", "output.every=0")
        whole = self.run_scene("cylinder", *self.COARSE, *strict, out="whole")
        first = self.run_scene("cylinder", *self.COARSE, "--set", "time.until_static.force_ratio=1e-4")
        again = self.run_scene("cylinder", *self.COARSE, "--set", "time.until_static.force_ratio=1e-4", "--resume")
        self.assertEqual((again["steps"], again["state_hash"], again["static"]), (first["steps"], first["state_hash"], True))
        parts = self.run_scene("cylinder", *self.COARSE, *strict, "--resume")
        self.assertLess(first["steps"], parts["steps"])
        for key in ("steps", "state_hash", "force_ratio", "errors"):
            self.assertEqual(parts[key], whole[key])

    def test_one_that_was_not_static_goes_on_with_more_steps(self):
        limit = lambda n: (*self.COARSE, "--set", f"time.until_static.max_steps={n}")
        whole = self.run_scene("cylinder", *limit(650), out="whole")
        self.run_scene("cylinder", *limit(250))
        self.assertEqual(self.run_scene("cylinder", *limit(650), "--resume")["state_hash"], whole["state_hash"])
        # Steps in place of rest are another end, too.
        summary = self.run_scene("cylinder", *self.COARSE, "--set", "time={kappa=0.2,steps=700}", out="steps")
        again = vsb("run", SCENES / "cylinder.toml", "--out", self.folder / "cylinder", *self.COARSE, "--resume", "--set",
                    "time={kappa=0.2,steps=700}")
        self.assertEqual((again.returncode, self.hash(self.folder / "cylinder")), (0, summary["state_hash"]), again.stderr)

    def test_a_removal_that_is_over_goes_on_to_more_stages(self):
        stages = lambda n: ("--set", f"removal.max_stages={n}")
        whole = self.run_scene("wellbore-slice", *stages(2), out="whole")
        self.run_scene("wellbore-slice", *stages(1), out="parts")
        parts = self.run_scene("wellbore-slice", *stages(2), "--resume", out="parts")
        self.assertEqual(parts["state_hash"], whole["state_hash"])
        timeless = lambda s: [{k: v for k, v in stage.items() if k != "seconds"} for stage in s["removal"]["stage"]]
        self.assertEqual(timeless(parts), timeless(whole))
        self.assertEqual([t for _, t in frames(self.folder / "parts")], [t for _, t in frames(self.folder / "whole")])

    def test_a_checkpoint_of_another_name_is_not_passed_over(self):
        self.column(100)
        for rest in (("column.checkpoint", "column.checkpoint.before"), ("column.checkpoint.before",)):
            self.checkpoint.rename(self.out / rest[0]) if len(rest) > 1 else self.checkpoint.rename(self.out / rest[-1])
            earlier = self.contents()
            done = self.column(200, "--resume", "--set", "name=foo", code=4)
            self.assertIn(f"{self.out}: there is no foo.checkpoint to resume from, but column.checkpoint: ", done.stderr)
            self.assertEqual(self.contents(), earlier)
        self.column(200, "--resume")
        self.assertEqual(step_of(self.checkpoint), 200)
        self.column(50, "--set", "name=foo")  # without --resume it is another run

    def test_a_run_that_begins_anew_keeps_the_checkpoint_aside(self):
        self.column(150)
        kept = self.out / "column.checkpoint.step-150"
        for _ in range(2):  # the second time it is the same one
            done = self.column(150, "--quiet")
            self.assertIn(f"keeping the checkpoint that was there as {kept} (with --resume", done.stderr)
        self.assertEqual([p.name for p in self.out.glob("*.checkpoint*")], ["column.checkpoint", kept.name])
        self.column(150, "--set", "traction[0].pressure=2.0")
        self.column(150, "--set", "traction[0].pressure=3.0")  # of the same step, but not the same
        self.assertTrue((self.out / "column.checkpoint.step-150-2").exists())
        kept.rename(self.checkpoint)
        self.column(300, "--resume")
        self.assertEqual(self.hash(), self.run_scene("column", "--set", "time.steps=300", out="whole")["state_hash"])


class Stopped(CheckpointTest):
    LONG = ("--set", "time.steps=800000")

    def start(self, *arguments):
        run = subprocess.Popen([PROGRAM, "run", str(SCENES / "column.toml"), "--out", str(self.out), *self.LONG, *arguments],
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(run.stdout.close)
        self.addCleanup(run.stderr.close)
        self.addCleanup(run.kill)
        run.stdout.readline()  # the head line: the run has begun
        return run

    def test_hanging_up_stops_with_a_checkpoint(self):
        run = self.start()
        run.send_signal(signal.SIGHUP)
        run.communicate(timeout=60)
        self.assertEqual(run.returncode, 5)
        self.assertTrue(0 <= step_of(self.checkpoint) < 800000)

    def test_so_does_an_output_that_nobody_reads(self):
        """Of a run with something to print: the end of a stage."""
        out = self.folder / "slice"
        arguments = ["--out", str(out), "--set", "removal.max_stages=2"]
        run = subprocess.Popen([PROGRAM, "run", str(SCENES / "wellbore-slice.toml"), *arguments], stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, text=True)
        run.stdout.readline()
        run.stdout.close()
        told = run.communicate(timeout=120)[1]
        self.assertEqual(run.returncode, 5, told)
        self.assertIn("vsb: standard output cannot be written (Broken pipe): stopping\n", told)
        parts = self.run_scene("wellbore-slice", *arguments[2:], "--resume", out="slice")
        whole = self.run_scene("wellbore-slice", *arguments[2:], out="whole")
        self.assertEqual(parts["state_hash"], whole["state_hash"])

    def test_a_second_run_in_a_directory_is_refused(self):
        run = self.start()
        while not (self.out / "column.hdf.series").exists():
            time.sleep(0.01)
        earlier = sorted(p.name for p in self.out.iterdir())
        done = vsb("run", SCENES / "column.toml", "--out", self.out)
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertRegex(done.stderr, rf"{self.out}: process {run.pid} on \S+ is writing results there; .*--out")
        self.assertEqual(sorted(p.name for p in self.out.iterdir()), earlier)
        run.kill()
        run.wait()
        self.assertTrue((self.out / "vsb.lock").exists())  # of nobody
        self.column(50)
        self.assertFalse((self.out / "vsb.lock").exists())

    def test_the_last_two_checkpoints_are_kept(self):
        soon = ("--set", "output.checkpoint_minutes=1e-9")
        self.column(300, *soon)
        before = self.out / "column.checkpoint.before"
        self.assertEqual((step_of(before), step_of(self.checkpoint)), (200, 300))
        whole = self.hash()
        self.checkpoint.write_bytes(self.checkpoint.read_bytes()[:700])
        done = self.column(300, *soon, "--resume")
        self.assertRegex(done.stderr, r"column\.checkpoint: .*damaged.*; going on from the checkpoint before it, of step 200\n")
        self.assertEqual(self.hash(), whole)
        self.checkpoint.unlink()  # killed between two renames
        self.assertIn("of step 200", self.column(300, *soon, "--resume").stderr)
        for file in (self.checkpoint, before):
            file.write_bytes(b"no checkpoint")
        self.assertIn("has no seal", self.column(300, *soon, "--resume", code=4).stderr)


class Damaged(CheckpointTest):
    def test_a_flipped_bit_anywhere_is_noticed(self):
        self.column(100)
        good = self.checkpoint.read_bytes()
        offsets = sorted({*range(0, len(good), len(good) // 40), len(good) - SEAL - 1, len(good) - SEAL, len(good) - 1})
        for n, at in enumerate(offsets):
            bad = bytearray(good)
            bad[at] ^= 1 << n % 8
            self.checkpoint.write_bytes(bad)
            done = vsb("run", SCENES / "column.toml", "--out", self.out, "--resume")
            self.assertEqual(done.returncode, 4, f"byte {at}: {done.stdout}{done.stderr}")
            self.assertIn("column.checkpoint: ", done.stderr)
        for size in (0, 1, SEAL, len(good) // 2, len(good) - 1):
            self.checkpoint.write_bytes(good[:size])
            self.column(100, "--resume", code=4)

    def test_counts_are_checked_under_a_seal_too(self):
        """A file that is whole but not what the scene needs is refused before anything is made of its numbers."""
        scene = ("wellbore-slice", "--set", "removal.max_stages=1", "--set", "time.until_static.max_steps=200")
        self.assertEqual(vsb("run", SCENES / "wellbore-slice.toml", "--out", self.out, *scene[1:]).returncode, 0)
        checkpoint = self.out / "wellbore-slice.checkpoint"
        good = checkpoint.read_bytes()

        def shorten(name, count):
            def change(file):
                data = file[name][()]
                del file[name]
                file[name] = data[:count]
            return change

        def put(at, value):
            def change(file):
                data = file["checkpoint/particles"][()]
                data[at:at + 4] = np.frombuffer(np.int32(value).tobytes(), np.uint8)
                file["checkpoint/particles"][...] = data
            return change

        changes = [shorten("checkpoint/particles", n) for n in (0, 3, 40, 1000)] + [shorten("staged/present", n) for n in (0, 5)]
        changes += [shorten("staged/stages", 0)]
        # The counts that open the particles of cell lanes: width; behind the box of cells: groups, slots, nodes.
        changes += [put(at, value) for at in (0, 20, 24, 28) for value in (-1, 2**31 - 1, 12345)]
        for change in changes:
            checkpoint.write_bytes(good[:-SEAL])
            with h5py.File(checkpoint, "r+") as file:
                change(file)
            seal(checkpoint)
            done = vsb("run", SCENES / "wellbore-slice.toml", "--out", self.out, *scene[1:], "--resume")
            self.assertIn(done.returncode, (2, 4), done.stdout + done.stderr)
            self.assertNotIn("internal", done.stderr)

    def test_the_seal_is_that_of_hashlib(self):
        self.column(10)
        data = self.checkpoint.read_bytes()
        self.assertEqual(data[-SEAL:], b"vsb-seal" + hashlib.sha256(data[:-SEAL]).digest())


class NoSpace(CheckpointTest):
    def test_a_limit_of_file_size_leaves_what_was_there(self):
        self.column(100)
        earlier = self.contents("column*")
        for limit in (0, 1000, 4096, 8000, 12000, 16000):
            def before(limit=limit):
                resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

            done = subprocess.run([PROGRAM, "run", str(SCENES / "column.toml"), "--out", str(self.out), "--set", "time.steps=200",
                                   "--resume"], capture_output=True, text=True, preexec_fn=before)
            self.assertEqual(done.returncode, 4, f"{limit}: {done.returncode} {done.stderr}")
            self.assertRegex(done.stderr, r"\A(vsb: warning: .*\n)?vsb: .*column\S*: .*File too large\)?\n\Z")
            now = self.contents("column*")
            self.assertEqual({name: now[name] for name in earlier if not name.endswith(".series")},
                             {name: data for name, data in earlier.items() if not name.endswith(".series")})
            for name in now:
                self.assertFalse(name.endswith(".part"), name)
        self.column(200, "--resume")
        self.assertEqual(self.hash(), self.run_scene("column", "--set", "time.steps=200", out="whole")["state_hash"])

    def test_a_full_disk_leaves_what_was_there(self):
        disk = self.folder / "disk"
        disk.mkdir()
        script = ('mount -t tmpfs -o size=512k tmpfs "$1" || exit 77\nshift\n"$@" --set time.steps=100 || exit 78\n'
                  'cp -r "$DISK" "$KEPT"\ni=0\nwhile [ $i -lt 300 ]; do dd if=/dev/zero of="$DISK/fill$i" bs=1k count=4 2>/dev/null || break; '
                  'i=$((i+1)); done\nrm -f "$DISK/fill1" "$DISK/fill2"\n"$@" --set time.steps=200 --set output.every=10 --resume\n'
                  'code=$?\nrm -f "$DISK"/fill*\ncp -r "$DISK" "$LEFT"\nexit $code\n')
        kept, left = self.folder / "kept", self.folder / "left"
        unshare = shutil.which("unshare")
        if not unshare:
            self.skipTest("no unshare, to mount a small disk in")
        done = subprocess.run([unshare, "-rm", "sh", "-c", script, "sh", disk, PROGRAM, "run", SCENES / "column.toml", "--out", disk,
                               "--quiet"], capture_output=True, text=True,
                              env={**os.environ, "DISK": str(disk), "KEPT": str(kept), "LEFT": str(left)})
        if done.returncode in (1, 77):
            self.skipTest("no small disk can be mounted here: " + done.stderr)
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertRegex(done.stderr, r"\A(vsb: warning: .*\n)*vsb: .*No space left on device\)?\n\Z")
        self.assertEqual((left / "column.checkpoint").read_bytes(), (kept / "column.checkpoint").read_bytes())
        self.assertEqual(list(left.glob("*.part")), [])
        whole = sorted(left.glob("column_*.hdf"))
        self.assertLess(len(whole), 12)
        for frame in whole:
            with h5py.File(frame) as file:
                self.assertEqual(len(file["VTKHDF/Points"]), 76)


class Large(ProgramTest):
    def bodies(self, count):
        text = ("dimension = 1\ngrid = { lower = [0.0], upper = [%d.0], spacing = 1.0 }\n"
                "time = { kappa = 0.5, steps = 20 }\n" % (2 * count + 4))
        for n in range(count):
            text += ("[[body]]\nname = \"a body with quite a long name, number %d\"\nshape = { box = { lower = [%d.0], upper = [%d.0] } }\n"
                     "particles_per_cell = 2\ndensity = 1000.0\nvelocity = [0.001]\nmaterial = { youngs_modulus = 1e6, "
                     "poisson_ratio = 0.3 }\n" % (n, 2 * n + 1, 2 * n + 2))
        return self.write(text, "bodies.toml")

    def goes_on(self, scene, *arguments):
        whole = self.run_scene(scene, *arguments, "--set", "time.steps=40", out="whole")
        self.assertGreater(len(whole["provenance"]["scene"]), 1 << 16)
        self.run_scene(scene, *arguments, "--set", "time.steps=20", out="parts")
        parts = self.run_scene(scene, *arguments, "--set", "time.steps=40", "--resume", out="parts")
        self.assertEqual(parts["state_hash"], whole["state_hash"])
        for file in (frames(self.folder / "parts")[-1][0], *(self.folder / "parts").glob("*.checkpoint")):
            with h5py.File(file) as stored:
                self.assertEqual(stored["provenance/scene"][0].decode(), parts["provenance"]["scene"])

    def test_many_bodies(self):
        self.goes_on(self.bodies(150))

    def test_a_long_table_of_a_load(self):
        table = ", ".join(f"[{0.001 * n}, {n / 5000}]" for n in range(5000))
        text = (SCENES / "column.toml").read_text().replace("time = { ramp_steps = 10000 }", f"time = {{ table = [{table}] }}")
        self.goes_on(self.write(text, "table.toml"))


class Names(ProgramTest):
    def run_as(self, name, code):
        text = f"name = {name}\n" + (SCENES / "column.toml").read_text()
        done = vsb("run", self.write(text), "--out", self.folder / "named", "--set", "time.steps=10")
        self.assertEqual(done.returncode, code, done.stderr)
        return done

    def test_any_printable_name_gives_a_good_index(self):
        for n, name in enumerate(("""'a"b'""", """"a'b" """, """'{}%s'""", """'säule'""")):
            self.run_as(name, 0)
            listed = frames(self.folder / "named")
            self.assertEqual(len(listed), 2)
            for file, _ in listed:
                self.assertTrue(file.is_file(), file)
            shutil.rmtree(self.folder / "named")

    def test_names_that_are_none_are_refused(self):
        for name in (r'"a\u0000b"', r'"a\u0007b"', r'"a\u007fb"', r'"a\rb"', r'"a/b"', r'"a\\b"', '"%s"' % ("x" * 300)):
            done = self.run_as(name, 2)
            self.assertIn("name", done.stderr)
            self.assertIn("file name", done.stderr)
            self.assertFalse((self.folder / "named").exists())


class LostOutput(ProgramTest):
    FULL = "vsb: standard output cannot be written (No space left on device)"

    def into(self, path, *arguments):
        with open(path, "w") as out:
            return subprocess.run([PROGRAM, *map(str, arguments)], stdout=out, stderr=subprocess.PIPE, text=True)

    def test_a_full_device_is_told_by_every_command(self):
        scene, out = SCENES / "column.toml", self.folder / "out"
        study = self.write("title = 'a column'\nscene = '%s'\naxis = { name = 'E', unit = 'Pa' }\nseries = [{ name = 'one', case = [{ axis = 1, "
                           "set = ['time.steps=10'] }] }]\n" % scene, "mine.toml")
        for arguments in (("info",), ("check", scene), ("--help",), ("run", "--help")):
            done = self.into("/dev/full", *arguments)
            self.assertEqual(done.returncode, 4, (arguments, done.stderr))
            self.assertIn(self.FULL + "\n", done.stderr)
        for arguments in (("run", scene, "--out", out, "--set", "time.steps=100000"), ("study", study, "--out", self.folder / "study")):
            done = self.into("/dev/full", *arguments)
            self.assertEqual(done.returncode, 5, (arguments, done.stderr))
            self.assertIn(self.FULL + ": stopping\n", done.stderr)
        self.assertEqual(self.into("/dev/full", "run", scene, "--out", out, "--quiet", "--set", "time.steps=100").returncode, 0)

    def test_a_reader_that_has_read_enough_is_no_news(self):
        run = subprocess.Popen([PROGRAM, "check", str(SCENES / "column.toml")], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        run.stdout.close()
        told = run.communicate(timeout=60)[1]
        self.assertEqual((run.returncode, told), (4, ""))


class Threads(ProgramTest):
    def test_more_than_there_can_be_are_refused(self):
        if "OpenMP" not in [line.split()[-1] for line in vsb("info").stdout.splitlines() if "backend" in line]:
            self.skipTest("a backend without threads")
        run = lambda *more, **options: vsb("run", SCENES / "column.toml", "--out", self.folder / "c", "--quiet", "--set",
                                           "time.steps=10", *more, **options)
        for name, done in (("--threads", run("--threads", 600)), ("OMP_NUM_THREADS", run(environment={"OMP_NUM_THREADS": "600"}))):
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertRegex(done.stderr, rf"vsb: {name}: 600 threads; this machine has \d+ cores?, and at most \d+ threads")
        self.assertFalse((self.folder / "c").exists())
        self.assertEqual(run("--threads", 512).returncode, 0)

    def test_the_screen_says_how_many_and_why(self):
        one = vsb("run", SCENES / "column.toml", "--out", self.folder / "c", "--set", "time.steps=10", environment={"OMP_NUM_THREADS": ""})
        self.assertRegex(one.stdout.splitlines()[1], r"^1 thread: ")
        two = vsb("run", SCENES / "column.toml", "--out", self.folder / "d", "--set", "time.steps=10", "--threads", 2)
        self.assertRegex(two.stdout.splitlines()[1], r"^2 threads, by --threads(; \d+\.\d of \d+ cores? are idle, so that fewer may be faster)?$")


class Expected(ProgramTest):
    # A block that rests on its weight: its force ratio stands at what the particles leave.
    STANDS = """
dimension = 1
grid = { lower = [0.0], upper = [6.0], spacing = 1.0 }
faces.x_min = "fixed"
gravity = [-10.0]
[[body]]
shape.box = { lower = [0.0], upper = [4.0] }
particles_per_cell = 2
density = 1.0
material = { youngs_modulus = 1e6, poisson_ratio = 0.0 }
[[traction]]
pressure = 1.0
surface.box = { lower = [3.0], upper = [6.0] }
time = { ramp = %s }
[method]
damping = 0.2
[time]
kappa = 0.5
until_static = { max_steps = 20000, force_ratio = 1e-30, check_every = 10 }
"""

    def test_a_force_ratio_that_stands_is_told(self):
        scene = self.write(self.STANDS % 0.001)
        done = vsb("run", scene, "--out", self.folder / "s")
        self.assertEqual(done.returncode, 7)
        ratio, since = re.search(r"vsb: not static after max_steps = 20000 \(.*\): the force ratio stands at (\S+) since about step (\d+), ",
                                 done.stderr).groups()
        self.assertLess(float(ratio), 1e-12)
        self.assertTrue(10 <= int(since) < 14000, since)
        for remedy in ("the static solver (--static)", "a larger time.until_static.force_ratio"):
            self.assertIn(remedy, done.stderr)
        self.assertNotIn('body.boundary = "cut"', done.stderr)  # the body's surface runs along boxes of the lattice
        done = vsb("run", scene, "--out", self.folder / "t", "--set", "time.until_static.max_steps=100")
        self.assertEqual(done.returncode, 7)
        self.assertNotIn("stands", done.stderr)

    def test_a_ramp_longer_than_the_run_is_told(self):
        scene = self.write(self.STANDS % 0.5)
        for key in ("time.until_static.max_steps", "time.steps"):
            steps = ("--set", "time={kappa=0.5,steps=400}") if key == "time.steps" else ("--set", "time.until_static.max_steps=400")
            end = json.loads(json.dumps(self.run_scene(scene, *steps, out=key)))["time"] if key == "time.steps" else None
            for done in (vsb("check", scene, *steps), vsb("run", scene, "--out", self.folder / "o", "--quiet", *steps)):
                share, until = re.search(r"warning: traction 'traction 1' is at (\S+) % of its final value at the last possible step: "
                                         + re.escape(key) + r" = 400 ends the run at (\S+) s, and traction\[0\]\.time is constant "
                                         r"from 0\.5 s on", done.stderr).groups()
                self.assertAlmostEqual(float(share) / (100 * float(until) / 0.5), 1, delta=0.01)
                if end:
                    self.assertAlmostEqual(float(until) / end, 1, delta=1e-5)
        told = vsb("check", scene, "--set", "traction[0].time.ramp=1e6")
        self.assertIn("of its final value at the last possible step", told.stderr)
        self.assertIn("# rest is not expected by step 20000: the loads are not constant before", told.stdout)
        for time in ("traction[0].time.ramp=0.01", 'traction[0].time={sine={period=1e9,amplitude=1.0}}'):
            steps = ("--set", "time={kappa=0.5,steps=20000}")
            self.assertNotIn("last possible step", vsb("check", scene, *steps, "--set", time).stderr)
        # A static solution takes the final load.
        self.assertNotIn("last possible step", vsb("run", scene, "--static", "--out", self.folder / "s").stderr)

    def test_check_foresees_the_step_of_rest(self):
        for scene, *more in (("cylinder", "--set", "grid.spacing=0.5"), ("yield-cylinder",)):
            text = vsb("check", SCENES / f"{scene}.toml", *more).stdout
            loaded = int(re.search(r"# estimated time \S.* to step (\d+), from which on the loads are constant", text)[1])
            first, last = (float(x) for x in re.search(r"# rest is expected from step (\S+) to (\S+) \(", text).groups())
            self.assertIn("# time.until_static.max_steps = ", text)
            steps = self.run_scene(scene, *more)["steps"]
            self.assertTrue(loaded < first < steps < last < 20 * steps, (scene, loaded, first, steps, last))
        short = vsb("check", SCENES / "yield-cylinder.toml", "--set", "time.until_static.max_steps=100")
        self.assertRegex(short.stdout, r"# rest is not expected by step 100: ")
        self.assertNotIn("rest is expected", short.stdout)
        self.assertIn("cannot be known: method.damping = 0", vsb("check", SCENES / "cylinder.toml", "--set", "method.damping=0.0").stdout)


if __name__ == "__main__":
    unittest.main()
