# SPDX-License-Identifier: BSD-3-Clause
"""What a run leaves behind, and how it ends: frames for VTK, summary, checkpoints, exit codes."""
import json
import os
import pathlib
import signal
import subprocess
import time
import unittest

import h5py
import numpy as np
from vsb_program import PROGRAM, SCENES, ProgramTest, frames, last_fields, vsb


class Frames(ProgramTest):
    def test_vtk_reads_a_frame_back(self):
        import vtk
        from vtk.util.numpy_support import vtk_to_numpy

        self.run_scene("cylinder", "--set", "time.until_static.max_steps=200", "--set", "output.every=100")
        listed = frames(self.folder / "cylinder")
        dt = json.loads((self.folder / "cylinder" / "summary.json").read_text())["dt"]
        self.assertEqual([file.name for file, _ in listed],
                         ["cylinder_000000.hdf", "cylinder_000100.hdf", "cylinder_000200.hdf"])
        np.testing.assert_allclose([t for _, t in listed], [0, 100 * dt, 200 * dt], rtol=1e-15)

        reader = vtk.vtkHDFReader()
        reader.SetFileName(str(listed[-1][0]))
        reader.Update()
        grid = reader.GetOutput()
        self.assertEqual(grid.GetNumberOfPoints(), 4824)
        self.assertEqual(grid.GetNumberOfCells(), 4824)
        self.assertEqual(grid.GetCellType(0), vtk.VTK_VERTEX)
        expected = last_fields(self.folder / "cylinder")
        np.testing.assert_array_equal(vtk_to_numpy(grid.GetPoints().GetData()), expected.pop("position"))
        data = grid.GetPointData()
        names = {data.GetArrayName(i) for i in range(data.GetNumberOfArrays())}
        self.assertEqual(names, {"id", "displacement", "velocity", "cauchy_stress", "volume", "mass", "in_boundary",
                                 "exact_displacement", "exact_cauchy_stress"})
        for name in names:
            np.testing.assert_array_equal(vtk_to_numpy(data.GetArray(name)), expected[name], err_msg=name)
        self.assertEqual(data.GetArray("cauchy_stress").GetNumberOfComponents(), 6)

    def test_vtk_reads_a_grid_frame_back(self):
        import vtk
        from vtk.util.numpy_support import vtk_to_numpy

        self.run_scene("cylinder", "--set", "time.until_static.max_steps=100", "--set", "output.grid=true")
        reader = vtk.vtkHDFReader()
        reader.SetFileName(str(self.folder / "cylinder" / "cylinder_grid_000100.hdf"))
        reader.Update()
        grid = reader.GetOutput()
        self.assertEqual((grid.GetNumberOfPoints(), grid.GetNumberOfCells()), (25 * 25, 24 * 24))
        self.assertEqual(grid.GetCellType(0), vtk.VTK_QUAD)
        self.assertEqual(grid.GetCell(24 * 24 - 1).GetBounds()[:4], (5.75, 6.0, 5.75, 6.0))
        self.assertEqual(grid.GetPoint(25 * 3 + 7), (7 * 0.25, 3 * 0.25, 0))
        mass = vtk_to_numpy(grid.GetPointData().GetArray("mass"))
        particles = last_fields(self.folder / "cylinder")
        self.assertAlmostEqual(mass.sum() / particles["mass"].sum(), 1, delta=1e-13)
        # Node (i, j) is value 25 j + i: the body covers the middle, not the far corner.
        self.assertGreater(mass[25 * 1 + 12], 0)
        self.assertEqual(mass[25 * 24 + 24], 0)

    def test_grid_frames_of_lines_and_hexahedra(self):
        import vtk

        for scene, cells, kind in (("column", 12, vtk.VTK_LINE), ("column-3d", 12, vtk.VTK_HEXAHEDRON)):
            self.run_scene(scene, "--set", "time.steps=2", "--set", "output.grid=true")
            reader = vtk.vtkHDFReader()
            reader.SetFileName(str(self.folder / scene / f"{scene}_grid_000002.hdf"))
            reader.Update()
            self.assertEqual(reader.GetOutput().GetNumberOfCells(), cells)
            self.assertEqual(reader.GetOutput().GetCellType(0), kind)
            if kind == vtk.VTK_HEXAHEDRON:
                size = vtk.vtkCellSizeFilter()
                size.SetInputConnection(reader.GetOutputPort())
                size.Update()
                self.assertAlmostEqual(size.GetOutput().GetCellData().GetArray("Volume").GetValue(5), 1.0, delta=1e-12)

    def test_only_the_wanted_fields_are_written(self):
        self.run_scene("column", "--set", "time.steps=10", "--set", 'output.fields=["id","volume"]', "--set", "name=few")
        with h5py.File(self.folder / "column" / "few_000010.hdf") as file:
            self.assertEqual(set(file["VTKHDF/PointData"]), {"id", "volume", "exact_displacement", "exact_cauchy_stress"})

    def test_boundary_particles_are_those_of_the_last_two_cells(self):
        self.run_scene("column", "--set", "time.steps=1")
        fields = last_fields(self.folder / "column")
        np.testing.assert_array_equal(fields["in_boundary"], fields["position"][:, 0] > 8)

    def test_summary_says_everything(self):
        summary = self.run_scene("column", "--set", "time.steps=100")
        for key in ("errors", "particles", "steps", "seconds", "ns_per_particle_step", "net_force", "boundary_nodes",
                    "peak_bytes", "provenance", "state_hash"):
            self.assertIn(key, summary)
        self.assertEqual(summary["steps"], 100)
        self.assertAlmostEqual(summary["net_force"][0], -0.01, delta=1e-6)  # 100 of 10,000 ramp steps
        self.assertIn("steps = 100", summary["provenance"]["scene"])

    def test_deviations_that_round_to_zero_have_no_sign(self):
        run = lambda *more: vsb("run", SCENES / "column.toml", "--out", self.folder / "column", "--set", "time.steps=100", *more)
        run()
        e_u = json.loads((self.folder / "column" / "summary.json").read_text())["errors"]["e_u"]
        for factor, text in ((1 + 1e-6, "(  +0.00 %)"), (1 - 1e-6, "(  +0.00 %)"), (1 + 1e-4, "(  -0.01 %)")):
            self.assertIn(text, run("--set", f"published[0].e_u={e_u * factor!r}").stdout)

    def test_a_second_run_replaces_the_frames_of_the_first(self):
        self.run_scene("column", "--set", "time.steps=20", "--set", "output.every=5")
        self.run_scene("column", "--set", "time.steps=7")
        self.assertEqual(sorted(p.name for p in (self.folder / "column").glob("column_*.hdf")),
                         ["column_000000.hdf", "column_000007.hdf"])


class Ends(ProgramTest):
    def interrupt(self, out, number, *arguments):
        """Starts a long run, or goes on with it, interrupts it, returns its exit code."""
        run = subprocess.Popen([PROGRAM, "run", str(SCENES / "column.toml"), "--out", str(out), "--set",
                                "time.steps=800000", *arguments], stdout=subprocess.PIPE, text=True)
        run.stdout.readline()  # the head line: the run has begun
        time.sleep(0.2)
        run.send_signal(number)
        output, _ = run.communicate(timeout=60)
        self.assertRegex(output, r"interrupted at step \d+; the same command with --resume")
        return run.returncode

    def test_interrupt_writes_a_checkpoint_and_resuming_changes_no_bit(self):
        out = self.folder / "column"
        self.assertEqual(self.interrupt(out, signal.SIGINT), 5)
        self.assertTrue((out / "column.checkpoint").exists())
        with h5py.File(out / "column.checkpoint") as file:
            step = int(file["checkpoint"].attrs["step"][0])
        self.assertTrue(0 < step < 800000, step)
        resumed = self.run_scene("column", "--resume", "--set", "time.steps=800000")
        with h5py.File(out / "column.checkpoint") as file:
            self.assertEqual(int(file["checkpoint"].attrs["step"][0]), 800000)  # the end, from which more steps may go on
        whole = self.run_scene("column", "--set", "time.steps=800000", out="whole")
        self.assertEqual(resumed["steps"], whole["steps"])
        self.assertEqual(resumed["state_hash"], whole["state_hash"])

    def test_terminate_does_the_same(self):
        self.assertEqual(self.interrupt(self.folder / "column", signal.SIGTERM), 5)

    def test_the_index_of_the_frames_outlives_a_second_interrupt(self):
        out = self.folder / "column"
        self.assertEqual(self.interrupt(out, signal.SIGINT), 5)
        self.assertEqual(len(frames(out)), 1)
        self.assertEqual(self.interrupt(out, signal.SIGINT, "--resume"), 5)
        self.assertEqual(len(frames(out)), 1)

    def test_resuming_another_scene_is_refused(self):
        self.assertEqual(self.interrupt(self.folder / "column", signal.SIGINT), 5)
        done = vsb("run", SCENES / "column.toml", "--out", self.folder / "column", "--resume", "--set", "time.steps=800000",
                   "--set", "body[0].density=2.0")
        self.assertEqual(done.returncode, 4)
        self.assertIn("another scene: body[0].density is 1.0 there, and 2.0 here", done.stderr)

    def test_damaged_checkpoint_is_refused(self):
        out = self.folder / "column"
        self.assertEqual(self.interrupt(out, signal.SIGINT), 5)
        (out / "column.checkpoint").write_bytes((out / "column.checkpoint").read_bytes()[:700])
        done = vsb("run", SCENES / "column.toml", "--out", out, "--resume", "--set", "time.steps=800000")
        self.assertEqual(done.returncode, 4)
        self.assertIn("column.checkpoint", done.stderr)

    def test_a_checkpoint_is_not_discarded_without_a_word(self):
        out = self.folder / "column"
        again = lambda *more: vsb("run", SCENES / "column.toml", "--out", out, "--set", "time.steps=800000", *more)
        first = vsb("run", SCENES / "column.toml", "--out", out, "--set", "time.steps=10", "--resume")
        self.assertEqual(first.returncode, 0)
        self.assertTrue(first.stderr.startswith(f"vsb: no checkpoint in {out}; starting from step 0\n"), first.stderr)
        (out / "column.checkpoint").unlink()
        self.assertEqual(self.interrupt(out, signal.SIGINT), 5)
        with h5py.File(out / "column.checkpoint") as file:
            step = int(file["checkpoint"].attrs["step"][0])
        done = again("--quiet")
        self.assertEqual(done.returncode, 0)
        self.assertIn(f"keeping the checkpoint that was there as {out}/column.checkpoint.step-{step} (with --resume", done.stderr)

    def test_not_static_has_its_own_exit_code(self):
        run = lambda *more: vsb("run", SCENES / "cylinder.toml", "--out", self.folder / "c", "--quiet", *more)
        done = run("--set", "time.until_static.max_steps=100")
        self.assertEqual(done.returncode, 7)
        self.assertRegex(done.stderr, r"\n?vsb: not static after max_steps = 100 \(force ratio [\d.e+-]+, energy ratio [\d.e+-]+\)\n$")
        self.assertFalse(json.loads((self.folder / "c" / "summary.json").read_text())["static"])
        self.assertIn("7 not static", vsb("--help").stdout)

    def test_divergence_by_a_modulus_in_the_wrong_unit_says_so(self):
        done = vsb("run", SCENES / "cylinder.toml", "--out", self.folder / "c", "--quiet", "--set",
                   "body[0].material.youngs_modulus=10", "--set", "traction[0].time.ramp=0")
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertRegex(done.stderr, r"diverged at step .*; largest load / smallest Young's modulus = 1e\+05 Pa / 10 Pa = 1e\+04: check")

    def test_divergence_names_step_particle_and_field(self):
        done = vsb("run", SCENES / "column.toml", "--out", self.folder / "column", "--set", "time.dt=0.06")
        self.assertEqual(done.returncode, 3, done.stdout + done.stderr)
        self.assertRegex(done.stderr, r"diverged at step \d+, time [\d.e+-]+ s: \w+ of particle \d+")

    def test_results_that_cannot_be_written(self):
        (self.folder / "file").write_text("in the way")
        done = vsb("run", SCENES / "column.toml", "--out", self.folder / "file" / "results")
        self.assertEqual(done.returncode, 4)
        self.assertIn("file/results", done.stderr)

    def test_usage_errors(self):
        for arguments in ([], ["run"], ["run", "x.toml", "--threads", "0"], ["fly"], ["run", "x.toml", "--bogus"]):
            self.assertEqual(vsb(*arguments).returncode, 2, arguments)


class SameBits(ProgramTest):
    def hash(self, *arguments, **options):
        return self.run_scene("cylinder", "--set", "time.until_static.max_steps=1500", *arguments, **options)["state_hash"]

    def test_any_number_of_threads(self):
        passive = {"OMP_WAIT_POLICY": "passive"}  # more threads than cores must not spin
        if "OpenMP" not in [line.split()[-1] for line in vsb("info").stdout.splitlines() if "backend" in line]:
            self.skipTest("a backend without threads")
        hashes = {n: self.hash("--threads", n, environment=passive) for n in (1, 2, 4, 8)}
        self.assertEqual(len(set(hashes.values())), 1, hashes)

    def test_serial_build_and_openmp_build(self):
        other = os.environ.get("VSB_SERIAL_PROGRAM", "")
        if not pathlib.Path(other).is_file():
            self.skipTest("the preset bits is not built; ./check builds it")
        self.assertIn("Serial", vsb("info", program=other).stdout)
        self.assertEqual(self.hash("--threads", 2), self.hash(program=other))
        mine = last_fields(self.folder / "cylinder")
        self.run_scene("column-3d", "--set", "time.steps=500", out="mine")
        self.run_scene("column-3d", "--set", "time.steps=500", out="other", program=other)
        self.assertGreater(len(mine["id"]), 0)
        for name, values in last_fields(self.folder / "mine").items():
            np.testing.assert_array_equal(values, last_fields(self.folder / "other")[name], err_msg=name)


if __name__ == "__main__":
    unittest.main()
