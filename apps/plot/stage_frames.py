# SPDX-License-Identifier: BSD-3-Clause
"""The frames of a run that removes particles in stages, for the scripts that draw them."""
import collections
import json
import pathlib
import sys

import numpy as np

from particle_boxes import particle_sizes

FIELD = "equivalent_plastic_strain"

# Of every particle: position, position at the start, equivalent plastic strain, edges of its box, mass.
State = collections.namedtuple("State", "x start strain sizes mass")


class StagedRun:
    """A results directory with a summary of stages."""

    def __init__(self, directory, program):
        self.directory, self.program = pathlib.Path(directory), program
        if not (self.directory / "summary.json").exists():
            self.fail("has no summary.json: is the run at its end?")
        summary = json.loads((self.directory / "summary.json").read_text())
        if "removal" not in summary:
            self.fail("is of a scene without a table 'removal'")
        self.name, self.dimension = summary["name"], summary["dimension"]
        self.stages, self.outcome = summary["removal"]["stage"], summary["removal"]["outcome"]
        index = json.loads((self.directory / f"{self.name}.hdf.series").read_text())["files"]
        self.steps = [int(f["name"].rsplit("_", 1)[1][:-4]) for f in index]

    def fail(self, what):
        sys.exit(f"{self.program}: {self.directory} {what}")

    def stages_with_frames(self):
        """(number, report) of the stages that left a frame: all but one that diverged."""
        return [(n, s) for n, s in enumerate(self.stages, 1) if s["last_step"] in self.steps]

    def stage_of(self, step):
        return next((n for n, s in enumerate(self.stages, 1) if step <= s["last_step"]), len(self.stages))

    def read(self, step):
        """The state at a step, a quarter or a half made whole by mirror images."""
        import h5py  # late: who only wants the stages needs no HDF5

        with h5py.File(self.directory / f"{self.name}_{step:06d}.hdf") as file:
            data = file["VTKHDF/PointData"]
            needed = [FIELD, "displacement", "volume", "mass"]
            lacking = [name for name in needed if name not in data]
            if lacking:
                self.fail(f"has frames without {', '.join(lacking)} (output.fields)")
            x, (strain, moved, volume, mass) = file["VTKHDF/Points"][()], (data[name][()] for name in needed)
        start = x - moved
        sizes = np.ones_like(x)
        sizes[:, : self.dimension] = particle_sizes(start[:, : self.dimension], volume, mass)
        for axis in (0, 1):
            if start[:, axis].min() > 0:
                mirror = np.ones(3)
                mirror[axis] = -1
                x, start = np.vstack([x, x * mirror]), np.vstack([start, start * mirror])
                strain, mass, sizes = np.tile(strain, 2), np.tile(mass, 2), np.tile(sizes, (2, 1))
        return State(x, start, strain, sizes, mass)
