# SPDX-License-Identifier: BSD-3-Clause
"""The pictures of a run, apps/plot/plot.py and apps/plot/plot_stages.py: what is drawn where, and which frame."""
import json
import subprocess
import sys
import unittest

import h5py
import matplotlib.image
import numpy as np
from PIL import Image
from vsb_program import ROOT, SCENES, ProgramTest, frames, last_fields, vsb

PLOT = ROOT / "apps" / "plot"
sys.path.insert(0, str(PLOT))
import particle_boxes  # noqa: E402
import plot  # noqa: E402


def script(name, *arguments):
    return subprocess.run([sys.executable, PLOT / name, *map(str, arguments)], capture_output=True, text=True, timeout=300)


def coloured(picture):
    """The share of the pixels of a picture that are neither grey nor white."""
    rgb = matplotlib.image.imread(picture)[:, :, :3]
    return float((np.ptp(rgb, axis=2) > 0.1).mean())


def film_length(path):
    with Image.open(path) as film:
        return film.n_frames


BEAM = """\
dimension = 2
setting = "paper"
gravity = [0.0, -9.81]
grid = { lower = [0.0, -1.0], upper = [20.5, 1.5], spacing = 0.25 }
faces = { x_min = "fixed" }
time = { kappa = 0.5, steps = 40 }
output = { every = 10 }
[[body]]
shape = { box = { lower = [0.0, 0.0], upper = [20.0, 0.5] } }
particles_per_cell = 2
density = 2000.0
material = { youngs_modulus = 1e8, poisson_ratio = 0.3 }
"""


class Boxes(ProgramTest):
    def start(self, *overrides):
        self.run_scene("cylinder", "--set", "time.until_static.max_steps=1", "--set", "grid.spacing=0.5",
                       *(a for o in overrides for a in ("--set", o)))
        fields = last_fields(self.folder / "cylinder")
        return fields, (fields["position"] - fields["displacement"])[:, :2]

    def test_whole_boxes_are_the_lattices_and_cut_ones_have_their_volume(self):
        for boundary in ("keep", "cut", "cut2x2"):
            fields, start = self.start(f"body[0].boundary={boundary}", "body[0].particles_per_cell=[2, 4]")
            sizes = particle_boxes.particle_sizes(start, fields["volume"], fields["mass"])
            whole = particle_boxes.whole_particles(fields["mass"])
            self.assertGreater(whole.mean(), 0.5)
            np.testing.assert_allclose(sizes[whole], np.tile([0.25, 0.125], (whole.sum(), 1)), rtol=1e-5)
            np.testing.assert_allclose(sizes[~whole].prod(axis=1), fields["volume"][~whole], rtol=1e-5)
            self.assertEqual(whole.all(), boundary == "keep")

    def test_particles_on_no_lattice_are_squares(self):
        fields, start = self.start("body[0].jitter=0.2")
        sizes = particle_boxes.particle_sizes(start, fields["volume"], fields["mass"])
        np.testing.assert_allclose(sizes, np.sqrt(fields["volume"])[:, None] * [1, 1], rtol=1e-3)

    def test_the_layer_in_the_middle_is_whole(self):
        """A round bar along z: its section, whether boxes at the surface are kept, cut, or split."""
        text = """
            dimension = 3
            grid = { lower = [-2.0, -2.0, 0.0], upper = [2.0, 2.0, 2.0], spacing = 0.25 }
            faces = { z_min = "roller", z_max = "roller" }
            time = { kappa = 0.5, steps = 1 }
            [[body]]
            shape = { cylinder = { center = [0.0, 0.0, 0.0], radius = 1.6 } }
            particles_per_cell = 2
            boundary = "%s"
            density = 2000.0
            velocity = [0.0, 0.0, 0.0]
            material = { youngs_modulus = 1e8, poisson_ratio = 0.3 }
            """
        for boundary in ("keep", "cut", "cut2x2"):
            self.run_scene(self.write(text % boundary), out=boundary)
            fields = last_fields(self.folder / boundary)
            start = fields["position"] - fields["displacement"]
            sizes = particle_boxes.particle_sizes(start, fields["volume"], fields["mass"])
            layer = particle_boxes.middle_layer(start, sizes, fields["mass"], 2)
            self.assertEqual(len(np.unique(np.round(start[layer, 2], 6))), 2 if boundary == "cut2x2" else 1)
            area = sizes[layer, 0] * sizes[layer, 1]
            self.assertAlmostEqual(area.sum() / (np.pi * 1.6**2), 1, delta=0.03, msg=boundary)


class Stages(ProgramTest):
    def test_bodies_with_cut_particles_are_drawn(self):
        shares = {}
        for boundary in ("keep", "cut", "cut2x2"):
            out = self.folder / boundary
            done = vsb("run", SCENES / "wellbore-slice.toml", "--quiet", "--out", out, "--set", f"body[0].boundary={boundary}", "--set",
                       "removal.max_stages=1", "--set", "time.until_static.max_steps=2500", "--set", "output.every=1000")
            self.assertEqual(done.returncode, 0, done.stderr)
            drawn = script("plot_stages.py", out, "--highest", "1e-5")
            self.assertEqual(drawn.returncode, 0, drawn.stderr)
            shares[boundary] = coloured(out / "wellbore-slice_stages.png")
        self.assertGreater(shares["keep"], 0.2)
        for boundary in ("cut", "cut2x2"):
            self.assertAlmostEqual(shares[boundary] / shares["keep"], 1, delta=0.1, msg=str(shares))
        film = script("plot_stages.py", self.folder / "cut2x2", "--animation")
        self.assertEqual(film.returncode, 0, film.stderr)
        self.assertGreater(film_length(self.folder / "cut2x2" / "wellbore-slice_stages.gif"), 3)


class Frames(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        import pathlib
        import tempfile
        cls.shared = tempfile.TemporaryDirectory(prefix="vsb-test-")
        cls.addClassCleanup(cls.shared.cleanup)
        cls.out = pathlib.Path(cls.shared.name) / "beam"
        scene = pathlib.Path(cls.shared.name) / "beam.toml"
        scene.write_text(BEAM)
        done = vsb("run", scene, "--quiet", "--out", cls.out)
        assert done.returncode == 0, done.stderr

    def plot(self, *arguments):
        done = script("plot.py", self.out, "--dpi", "80", *arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done

    def test_titles_do_not_overlap(self):
        run = plot.Run(self.out)
        frame = run.frame()
        for aspect in (1, 0.05):  # a square body, and one that is still flatter
            frame.position[:, 1] *= aspect
            for field in (None, "von_mises"):
                figure = plot.draw_fields(frame, field)
                figure.canvas.draw()
                titles = [figure._suptitle] + [panel.title for panel in figure.axes if panel.get_title()]
                boxes = [t.get_window_extent() for t in titles]
                self.assertGreaterEqual(len(boxes), 2)
                whole = figure.bbox
                for i, box in enumerate(boxes):
                    self.assertTrue(whole.x0 <= box.x0 and box.x1 <= whole.x1, titles[i].get_text())
                    for other in boxes[:i]:
                        self.assertFalse(box.overlaps(other), [t.get_text() for t in titles])
                    for panel in figure.axes:
                        if panel is not titles[i].axes and panel.get_title():
                            self.assertFalse(box.overlaps(panel.get_window_extent()), titles[i].get_text())
                plot.plt.close(figure)

    def test_fields(self):
        frame = plot.Run(self.out).frame()
        s = frame.fields["cauchy_stress"]
        mean = s[:, :3].mean(axis=1)
        deviator = s - np.outer(mean, [1, 1, 1, 0, 0, 0])
        squares = (deviator**2 * [1, 1, 1, 2, 2, 2]).sum(axis=1)
        for name, values, unit in (("pressure", -mean, "Pa"), ("von_mises", np.sqrt(1.5 * squares), "Pa"),
                                   ("cauchy_stress_xy", s[:, 3], "Pa"), ("displacement_y", frame.fields["displacement"][:, 1], "m"),
                                   ("velocity", np.linalg.norm(frame.fields["velocity"], axis=1), "m/s"),
                                   ("mass", frame.fields["mass"], "kg")):
            ours, of = frame.field(name)
            np.testing.assert_allclose(ours, values, rtol=1e-9, atol=1e-9 * np.abs(values).max())
            self.assertEqual(of, unit)
        self.assertEqual(self.plot("--field", "cauchy_stress_xy").stdout.strip(), str(self.out / "beam_cauchy_stress_xy.png"))
        self.assertGreater(coloured(self.out / "beam_cauchy_stress_xy.png"), 0.01)
        done = script("plot.py", self.out, "--field", "von_misses")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("von_mises", done.stderr)

    def test_the_frame_that_is_asked_for(self):
        run = plot.Run(self.out)
        self.assertEqual([run.frame(number=n).step for n in (0, 1, -1)], [0, 10, 40])
        self.assertEqual(run.frame(step=20).step, 20)
        self.plot()
        last = {p.name: p.read_bytes() for p in self.out.glob("*.png")}
        self.assertEqual(self.plot("--frame", "1").stdout.strip(), str(self.out / "beam_fields_000010.png"))
        self.assertEqual(self.plot("--step", "20", "--field", "von_mises").stdout.strip(), str(self.out / "beam_von_mises_000020.png"))
        self.assertEqual({name: (self.out / name).read_bytes() for name in last}, last)
        for arguments, words in ((("--frame", "5"), "5 frames, 0 to 4"), (("--step", "7"), "of steps 0, 10, 20, 30, 40")):
            done = script("plot.py", self.out, *arguments)
            self.assertNotEqual(done.returncode, 0)
            self.assertIn(words, done.stderr)

    def test_animation(self):
        for field in ("von_mises", "displacement_y"):
            self.plot("--animation", "--field", field)
            self.assertEqual(film_length(self.out / f"beam_{field}.gif"), 5)
        self.run_scene("column", "--set", "time.steps=300", "--set", "output.every=100")
        done = script("plot.py", self.folder / "column", "--animation", "--field", "displacement_x")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(film_length(self.folder / "column" / "column_displacement_x.gif"), 4)

    def test_an_interrupted_run_shows_its_last_whole_frame(self):
        out = self.folder / "results"
        self.run_scene(self.write(BEAM, "beam.toml"), out="results")
        (out / "summary.json").unlink()  # an interrupted run has none
        done = script("plot.py", out)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("this is step 40, the last frame that is whole", done.stderr)
        last = frames(out)[-1][0]
        last.write_bytes(last.read_bytes()[:1000])
        done = script("plot.py", out)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("beam_000040.hdf is not whole", done.stderr)
        self.assertIn("this is step 30, the last frame that is whole", done.stderr)
        self.assertIn("run not at its end", plot.Run(out).frame().title())
        self.assertNotIn("run not at its end", plot.Run(self.out).frame().title())


if __name__ == "__main__":
    unittest.main()
