# SPDX-License-Identifier: BSD-3-Clause
"""Every scene of the repository on cell lanes and on particle kernels: the same particles after a hundred steps."""
import json
import re
import tomllib
import unittest

import numpy as np

from vsb_program import SCENES, ProgramTest, last_fields, vsb

# What a scene has that the cell lanes do not: the reason that vsb check must give.
REASONS = {
    "column-graded": "its grid is mapped",
    "cylinder-exact": None,
    "cylinder-polar": "its grid is mapped",
    "cylinder-voids": "method.void_filter is on",
}

# Of large scenes a few layers of cells, in double precision.
PARTS = {
    "wellbore": ("--set", "grid.upper=[0.084,0.084,0.006]", "--set", "precision=double"),
    "wellbore-quarter": ("--set", "grid.upper=[0.084,0.084,0.006]"),
}


OTHER_IMPOSITIONS = ("virtual_stress_original", "boundary_particles", "material_points", "nodal")


def hundred_steps(scene):
    """Undamped: where a node is at rest but for round-off, Cundall's damping takes its sign from round-off."""
    text = (SCENES / f"{scene}.toml").read_text()
    steps = "time.until_static.max_steps=100" if "until_static" in text else "time.steps=100"
    return "--set", steps, "--set", "method.damping=0", *PARTS.get(scene, ())


def scales(scene, fields, dt):
    """What round-off of a field is relative to. The velocity's goes into the strain of a step, and vice versa."""
    spec = tomllib.loads((SCENES / f"{scene}.toml").read_text())
    body, spacing = spec["body"][0], np.min(spec["grid"]["spacing"])
    modulus, density = body["material"]["youngs_modulus"], body["density"]
    largest = {name: np.abs(values).max() for name, values in fields.items() if values.dtype.kind == "f"}
    largest["cauchy_stress"] = max(largest["cauchy_stress"], modulus * largest["velocity"] * dt / spacing)
    largest["velocity"] = max(largest["velocity"], largest["cauchy_stress"] / np.sqrt(modulus * density))
    return largest


class BothEngines(ProgramTest):
    def engine_of(self, scene, *arguments):
        notes = vsb("check", SCENES / f"{scene}.toml", *arguments)
        self.assertEqual(notes.returncode, 0, notes.stderr)
        return re.search(r"^# steps on (.*)$", notes.stdout, re.MULTILINE)[1]

    def fields_on(self, engine, scene, *more):
        out = self.folder / f"{scene}-{engine}"
        done = vsb("run", SCENES / f"{scene}.toml", *hundred_steps(scene), "--set", f"method.engine={engine}", *more,
                   "--out", out)
        self.assertIn(done.returncode, (0, 7), done.stderr)
        return last_fields(out), json.loads((out / "summary.json").read_text())["dt"]

    def assert_same_fields(self, scene, *more):
        (lanes, dt), (particles, _) = (self.fields_on(kind, scene, *more) for kind in ("cell_lanes", "particles"))
        scale = scales(scene, particles, dt)
        for name in ("position", "velocity", "cauchy_stress", "volume", "mass"):
            np.testing.assert_allclose(lanes[name], particles[name], rtol=0, atol=1e-12 * scale[name],
                                       err_msg=f"{scene}, {name}")
        return lanes

    def test_every_scene(self):
        compared = 0
        for path in sorted(SCENES.glob("*.toml")):
            scene = path.stem
            engine = self.engine_of(scene)
            with self.subTest(scene=scene):
                if REASONS.get(scene):
                    self.assertEqual(engine, f"particle kernels: {REASONS[scene]}")
                    refused = vsb("check", path, "--set", "method.engine=cell_lanes")
                    self.assertEqual(refused.returncode, 2)
                    self.assertIn(REASONS[scene], refused.stderr)
                    continue
                self.assertEqual(engine, "cell lanes")
                self.assert_same_fields(scene)
                compared += 1
        self.assertGreaterEqual(compared, 10)

    def test_quadratic_bsplines(self):
        # Scenes of all dimensions, loads and supports with B-splines, cylinder-accurate.toml beside them.
        splines = ("--set", 'method.basis="quadratic_bspline"')
        for scene, more in {"column": (), "column-2d": (), "column-3d": (), "column-large-strain": (), "closed-body": (),
                            "closed-body-3d": (), "cylinder": ("--set", "grid.spacing=0.5"),
                            "cylinder-concentric": ("--set", "grid.spacing=0.5"), "cylinder-free": (), "ellipse-exact": (),
                            "yield-cylinder": (), "wellbore-slice": ()}.items():
            with self.subTest(scene=scene):
                self.assertEqual(self.engine_of(scene, *splines, *more), "cell lanes")
                self.assert_same_fields(scene, *splines, *more)

    def test_a_resumed_run_with_quadratic_bsplines_has_the_same_bits(self):
        # Half a pressurised ring is pushed over the grid along its rollers: cells turn void and filled all the time.
        _, whole = self.resume("cylinder", "--set", 'method.basis="quadratic_bspline"', "--set", "grid.upper=[16.0,12.0]",
                               "--set", "faces.x_min=open", "--set", "grid.lower=[-12.0,0.0]", "--set", "grid.spacing=0.5",
                               "--set", "body[0].velocity=[0.4,0.0]", "--set", "method.damping=0",
                               "--set", "time.until_static.max_steps=4000", "--set", "time.until_static.energy_ratio=1e-30",
                               pause=0.15)
        self.assertEqual(whole["steps"], 4000)

    def test_every_imposition(self):
        coarse = ("--set", "grid.spacing=0.5")
        for scene, more in {"column": (), "column-2d": (), "column-3d": (), "cylinder": coarse,
                            "cylinder-concentric": coarse, "cylinder-free": coarse, "ellipse-exact": ()}.items():
            stresses = []
            for by in ("virtual_stress", *OTHER_IMPOSITIONS):
                imposed = ("--set", f'traction[0].imposition="{by}"')
                with self.subTest(scene=scene, by=by):
                    self.assertEqual(self.engine_of(scene, *imposed), "cell lanes")
                    stresses.append(self.assert_same_fields(scene, *more, *imposed)["cauchy_stress"])
            for k, stress in enumerate(stresses):  # each imposition is one of its own
                for other in stresses[:k]:
                    self.assertGreater(np.abs(stress - other).max(), 1e-9 * np.abs(stress).max(), scene)

    def test_impositions_side_by_side(self):
        # One traction by each of two methods: the sweeps take the one, kernels of their own the other.
        for first, second in (("virtual_stress", "virtual_stress_original"), ("virtual_stress", "boundary_particles"),
                              ("virtual_stress_original", "virtual_stress"), ("material_points", "virtual_stress_original")):
            self.assert_same_fields("ellipse-exact", "--set", f'traction[0].imposition="{first}"',
                                    "--set", f'traction[1].imposition="{second}"')

    def test_single_precision(self):
        # Positions are relative to the cell, so single precision loses less there than with the particle kernels.
        def fields(engine, precision):
            out = self.folder / f"{engine}-{precision}"
            done = vsb("run", SCENES / "cylinder.toml", "--set", f"precision={precision}", *hundred_steps("cylinder"),
                       "--set", f"method.engine={engine}", "--out", out)
            self.assertIn(done.returncode, (0, 7), done.stderr)
            return last_fields(out)
        exact = fields("particles", "double")
        lanes, particles = (fields(engine, "float") for engine in ("cell_lanes", "particles"))
        for name in ("velocity", "cauchy_stress", "volume"):
            scale = np.abs(exact[name]).max()
            off = np.abs(lanes[name] - exact[name]).max() / scale
            self.assertLess(off, 1e-5, name)
            self.assertLessEqual(off, np.abs(particles[name] - exact[name]).max() / scale, name)

    def test_reasons(self):
        for settings, reason in {
            ("method.scatter=atomic",): 'method.scatter = "atomic" is a way of the particle kernels',
            ("method.fill_criterion=0.5",): "method.fill_criterion is on",
            ("method.engine=particles",): "method.engine asks for them",
        }.items():
            arguments = [part for setting in settings for part in ("--set", setting)]
            self.assertIn(reason, self.engine_of("cylinder", *arguments))
        self.assertIn("its basis is ugimp", self.engine_of("cylinder", "--set", "method.basis=ugimp"))
        self.assertIn("its basis is quadratic_bspline, and traction",
                      self.engine_of("cylinder", "--set", "method.basis=quadratic_bspline",
                                     "--set", 'traction[0].imposition="boundary_particles"'))
        self.assertIn("is self-balanced", self.engine_of("closed-body", "--set", "traction[0].self_balanced=true"))

    def test_an_unknown_engine(self):
        done = vsb("check", SCENES / "cylinder.toml", "--set", "method.engine=fast")
        self.assertEqual(done.returncode, 2)
        self.assertIn("method.engine", done.stderr)


if __name__ == "__main__":
    unittest.main()
