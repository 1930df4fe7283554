# SPDX-License-Identifier: BSD-3-Clause
"""Cut lattices, the recovered stress and the error norms at cell means, as a user meets them."""
import math
import re
import unittest

import h5py
import numpy as np
from vsb_program import SCENES, ProgramTest, last_fields, vsb

QUARTER = """
name = "s"
dimension = 2
grid = { lower = [0.0, 0.0], upper = [3.0, 3.0], spacing = 0.5 }
faces = { x_min = "roller", y_min = "roller" }
[[body]]
shape = { disc = { center = [0.0, 0.0], radius = 2.0 } }
particles_per_cell = 2
boundary = "cut"
density = 1000.0
material = { youngs_modulus = 1e6, poisson_ratio = 0.3 }
[[traction]]
pressure = 1e3
[time]
kappa = 0.5
steps = 20
"""
MORE = ("--set", "compare.recovered=true", "--set", "compare.cell_means=true")


class CutLattices(ProgramTest):
    def changed(self, old, new, text=QUARTER):
        self.assertEqual(text.count(old), 1, old)
        return self.write(text.replace(old, new))

    def refuse(self, path, *words):
        done = vsb("run", path, "--out", self.folder / "refused")
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        for word in words:
            self.assertIn(word, done.stderr)
        self.assertRegex(done.stderr, r"scene\.toml:\d+:\d+: ")
        self.assertFalse((self.folder / "refused").exists())

    def test_volumes_masses_and_centroids_of_a_quarter_disc(self):
        for boundary in ("cut", "cut2x2"):
            summary = self.run_scene(self.changed('"cut"', f'"{boundary}"'), out="s")
            with h5py.File(self.folder / "s" / "s_000000.hdf") as file:
                x, V = file["VTKHDF/Points"][:], file["VTKHDF/PointData/volume"][:]
                mass = file["VTKHDF/PointData/mass"][:]
            self.assertAlmostEqual(V.sum() / math.pi, 1, delta=1e-3)
            np.testing.assert_allclose((V[:, None] * x).sum(0)[:2] / V.sum(), 8 / (3 * math.pi), rtol=1e-3)
            np.testing.assert_allclose(mass, 1000 * V, rtol=1e-15)
            cut = summary["cut_bodies"]
            self.assertAlmostEqual(cut["particle_volume"] / V.sum(), 1, delta=1e-13)
            self.assertAlmostEqual(cut["volume"] / math.pi, 1, delta=1e-5)
            self.assertLess(V.min(), 0.5 * V.max())
            self.assertGreater(V.min(), 0.02 * 0.25**2 / (4 if boundary == "cut2x2" else 1))

    def test_check_tells_the_volumes_and_keep_says_nothing(self):
        number = r"[\d.e+-]+"
        done = vsb("check", self.write(QUARTER))
        self.assertRegex(done.stdout, rf"# volume of bodies with cut lattices 3\.1416\d*, of their particles 3\.14\d*: {number} of it in")
        done = vsb("check", self.changed('"cut"', '"keep"'))
        self.assertNotIn("volume of bodies", done.stdout)
        self.assertNotIn("cut_bodies", self.run_scene(self.changed('"cut"', '"keep"'), out="s"))

    def test_keep_is_the_default_bit_by_bit(self):
        hashes = {self.run_scene(self.changed('boundary = "cut"', line), out="s")["state_hash"]
                  for line in ("", 'boundary = "keep"')}
        self.assertEqual(len(hashes), 1)
        self.assertNotIn(self.run_scene(self.write(QUARTER), out="s")["state_hash"], hashes)

    def test_the_resolved_scene_parses_back_to_itself(self):
        text = QUARTER.replace("[time]", "[compare]\nsolution = \"cylinder\"\ninner_radius = 1\nouter_radius = 2\n"
                               "pressure = 1e3\nrecovered = true\ncell_means = true\n[output]\n"
                               "fields = [\"id\", \"recovered_stress\"]\n[time]").replace('"cut"', '"cut2x2"')
        texts = []
        for source in (text, None):
            done = vsb("check", self.write(source or texts[0]))
            self.assertEqual(done.returncode, 0, done.stderr)
            texts.append(re.sub(r"^#.*\n", "", done.stdout, flags=re.MULTILINE))
        self.assertEqual(*texts)
        for line in ("boundary = 'cut2x2'", "recovered = true", "cell_means = true"):
            self.assertIn(line, texts[0])

    def test_bad_values(self):
        self.refuse(self.changed('"cut"', '"cut3x3"'), "body[0].boundary", "one of 'keep', 'cut', 'cut2x2'")
        self.refuse(self.changed('"cut"', "2"), "body[0].boundary")
        self.refuse(self.changed("boundary", "bondary"), "did you mean 'boundary'")
        self.refuse(self.changed('"cut"', '"cut"\njitter = 0.1'), "body[0].jitter", 'is for boundary = "keep"')
        self.refuse(self.changed("grid = { lower = [0.0, 0.0], upper = [3.0, 3.0], spacing = 0.5 }",
                                 "grid = { x = [0.0, 1.0, 2.0, 3.0], y = [0.0, 1.0, 3.0] }"),
                    "body[0].boundary", 'only "keep" here')
        rings = "lattice.concentric = { center = [0.0, 0.0], radii = [0.5, 2.0], rings = 4, per_ring = 9, angles = [0, 90] }"
        self.refuse(self.changed("particles_per_cell = 2", rings), "body[0].boundary", "not for rings")
        compare = '[compare]\nsolution = "cylinder"\ninner_radius = 1\nouter_radius = 2\npressure = 1\n'
        for line, word in (("recovered = 1", "compare.recovered"), ("recoverd = true", "did you mean 'recovered'"),
                           ("cell_means = \"yes\"", "compare.cell_means")):
            self.refuse(self.changed("[time]", compare + line + "\n[time]"), word)
        self.refuse(self.changed("[time]", '[output]\nfields = ["recovered"]\n[time]'), "recovered_stress")

    def test_the_recovered_stress_is_a_field_of_the_frames_where_it_is_asked_for(self):
        fields = '[output]\nfields = ["cauchy_stress", "recovered_stress"]\n[time]'
        self.run_scene(self.changed("[time]", fields), out="s")
        fields = last_fields(self.folder / "s")
        self.assertEqual(fields["recovered_stress"].shape, fields["cauchy_stress"].shape)
        raw, recovered = fields["cauchy_stress"], fields["recovered_stress"]
        self.assertGreater(np.abs(raw).max(), 0)
        self.assertLess(np.abs(raw - recovered).max(), np.abs(raw).max())
        self.assertFalse(np.array_equal(raw, recovered))
        self.run_scene(self.write(QUARTER), out="s")
        self.assertNotIn("recovered_stress", last_fields(self.folder / "s"))

    def test_the_cylinder_at_h_05(self):
        summary = self.run_scene("cylinder", "--set", "grid.spacing=0.5", "--set", "body[0].boundary=cut", *MORE)
        self.assertEqual(list(summary["errors"]), sorted(summary["errors"]))
        for name, expected, tolerance in (("e_rr", 3.9e-2, 0.02), ("e_tt", 3.8e-2, 0.02), ("e_rr_recovered", 2.3e-2, 0.05),
                                          ("e_tt_recovered", 1.5e-2, 0.15)):
            self.assertAlmostEqual(summary["errors"][name] / expected, 1, delta=tolerance, msg=name)
        self.assertLess(summary["errors"]["e_rr_cell_mean"], 0.3 * summary["errors"]["e_rr"])
        keep = self.run_scene("cylinder", "--set", "grid.spacing=0.5", *MORE)
        self.assertLess(summary["errors"]["e_rr_cell_mean"], 0.6 * keep["errors"]["e_rr_cell_mean"])
        self.assertLess(summary["errors"]["e_tt_cell_mean"], 0.7 * keep["errors"]["e_tt_cell_mean"])

    def test_the_norms_are_printed_raw_first_and_figures_of_studies(self):
        out = self.folder / "p"
        done = vsb("run", SCENES / "cylinder.toml", "--out", out, "--set", "time.until_static.max_steps=100", *MORE)
        names = re.findall(r"^(e_\w+) ", done.stdout, flags=re.MULTILINE)
        self.assertEqual(names, ["e_rr", "e_tt", "e_u", "e_rr_recovered", "e_tt_recovered", "e_rr_cell_mean",
                                 "e_tt_cell_mean"])
        study = self.folder / "my.toml"
        study.write_text(f"""
            title = "norms"
            scene = "{SCENES / 'ellipse.toml'}"
            set = ["grid.spacing=1.0", "compare.recovered=true", "compare.cell_means=true", "time.until_static.max_steps=5"]
            expect_static = false
            axis = {{ name = "n" }}
            [[series]]
            name = "one"
            case = [{{ axis = 1, expect = {{ e_xx_recovered = {{ lowest = 0 }}, e_xy_cell_mean = {{ lowest = 0 }} }} }}]
            """)
        done = vsb("study", study, "--out", self.folder / "study")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("e_xy_cell_mean", done.stdout)


if __name__ == "__main__":
    unittest.main()
