# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of the program share: running it, reading its results. VSB_PROGRAM names the program."""
import json
import os
import pathlib
import re
import signal
import subprocess
import tempfile
import time
import unittest

import h5py

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENES = ROOT / "apps" / "scenes"
PROGRAM = os.environ["VSB_PROGRAM"]


def vsb(*arguments, program=PROGRAM, timeout=600, environment=None):
    """Runs the program; returns the finished process with its texts."""
    return subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, timeout=timeout,
                          env={**os.environ, **(environment or {})})


class ProgramTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="vsb-test-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_scene(self, scene, *arguments, out=None, **options):
        """Runs a scene of the repository (by name) or a file; returns its summary. It must end well, or at the
        max_steps that the arguments give a run until static (exit code 7)."""
        path = scene if isinstance(scene, pathlib.Path) else SCENES / f"{scene}.toml"
        out = self.folder / (out or path.stem)
        done = vsb("run", path, "--out", out, "--quiet", *arguments, **options)
        summary = json.loads((out / "summary.json").read_text()) if done.returncode in (0, 7) else {}
        cut_short = any("until_static.max_steps=" in str(a) for a in arguments) and not summary.get("static")
        self.assertEqual(done.returncode, 7 if cut_short else 0, done.stderr + done.stdout)
        return summary

    def interrupt(self, out, scene, *arguments, pause):
        """Runs, interrupts after a pause; returns the step it ended in, None if it was over before."""
        run = subprocess.Popen([PROGRAM, "run", str(SCENES / f"{scene}.toml"), "--out", str(out), *arguments],
                               stdout=subprocess.PIPE, text=True)
        run.stdout.readline()  # the head line: the run has begun
        time.sleep(pause)
        run.send_signal(signal.SIGINT)
        output, _ = run.communicate(timeout=60)
        step = re.search(r"interrupted at step (\d+)", output)
        self.assertIn(run.returncode, (5,) if step else (0, 7), output)
        return int(step[1]) if step else None

    def resume(self, scene, *arguments, pause=0.7):
        """Runs in one go; runs, interrupts, resumes: the same bits. Machines differ in speed: an interrupt that comes
        after the last step, or before the first, is tried again sooner, or later."""
        whole = self.run_scene(scene, *arguments, out="whole")
        for attempt in range(20):
            out = self.folder / f"parts-{attempt}"
            step = self.interrupt(out, scene, *arguments, pause=pause)
            if step is not None and 0 < step < whole["steps"]:
                break
            pause *= 1.5 if step == 0 else 0.5
        self.assertIsNotNone(step, "it was over before it could be interrupted")
        self.assertTrue(0 < step < whole["steps"], step)
        parts = self.run_scene(scene, "--resume", *arguments, out=out)
        self.assertEqual(parts["state_hash"], whole["state_hash"])
        return step, whole

    def write(self, text, name="scene.toml"):
        path = self.folder / name
        path.write_text(text)
        return path


def frames(directory):
    """(file, time) of all particle frames, as the index lists them."""
    index = [i for i in pathlib.Path(directory).glob("*.hdf.series") if not i.name.endswith("_grid.hdf.series")]
    assert len(index) == 1, index
    return [(index[0].parent / f["name"], f["time"]) for f in json.loads(index[0].read_text())["files"]]


def last_fields(directory):
    """The fields of the last frame, the points as `position`."""
    with h5py.File(frames(directory)[-1][0]) as file:
        fields = {name: data[()] for name, data in file["VTKHDF/PointData"].items()}
        fields["position"] = file["VTKHDF/Points"][()]
    return fields
