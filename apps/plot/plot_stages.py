#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws the equilibrium states of a run that removes particles in stages (Algorithm 2), as Figure 19 does: a slice
across the hole for each of them, coloured by the equivalent plastic deviatoric strain.

    /usr/bin/python3 apps/plot/plot_stages.py results/wellbore-slice              NAME_stages.png
    /usr/bin/python3 apps/plot/plot_stages.py results/wellbore-slice --animation  NAME_stages.gif too, of all frames

An animation is worth while with frames in between: vsb run SCENE --set output.every=100. With ffmpeg at hand it is
written as NAME_stages.mp4 as well.
"""
import argparse
import shutil
import sys

try:
    import h5py  # noqa: F401, missing here and not in the middle
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    import numpy as np
    from matplotlib.animation import FFMpegWriter, FuncAnimation, PillowWriter
    from matplotlib.collections import PolyCollection
except ImportError as error:
    sys.exit(f"plot_stages.py: {error}; on Debian: apt-get install python3-h5py python3-matplotlib, and use /usr/bin/python3")

import plot_style  # noqa: F401
from particle_boxes import boxes, middle_layer
from stage_frames import StagedRun

MAP = "inferno_r"


class Slice:
    """The layer of particles next to the middle, as rectangles in mm."""

    def __init__(self, run, panel, highest):
        self.run, self.panel = run, panel
        panel.set(aspect="equal", xticks=[], yticks=[])
        for side in panel.spines.values():
            side.set_visible(False)
        self.squares = PolyCollection([], cmap=MAP, edgecolors="face", linewidths=0.1)
        self.squares.set_clim(0, highest)
        panel.add_collection(self.squares)

    def show(self, step):
        state = self.run.read(step)
        chosen = np.ones(len(state.x), bool)
        if self.run.dimension == 3:
            chosen = middle_layer(state.start, state.sizes, state.mass, 2)
        corners = 1e3 * boxes(state.x[chosen], state.sizes[chosen], [0, 1])
        self.squares.set_verts(corners)
        self.squares.set_array(state.strain[chosen])
        return corners


def title_of(number, stage, outcome, last):
    if last and outcome == "collapse":
        return f"stage {number}\ntotal failure"
    rows = f", {stage['rows']:.1f} rows" if stage["rows"] > 0 else ""
    return f"stage {number}\n{stage['failed']} beyond the threshold{rows}"


def draw_stages(run, highest):
    stages = run.stages_with_frames()
    figure, panels = plt.subplots(1, len(stages), figsize=(2.7 * len(stages) + 0.6, 3.0), layout="constrained", squeeze=False)
    limit = 0
    for panel, (number, stage) in zip(panels[0], stages):
        part = Slice(run, panel, highest)
        limit = max(limit, np.abs(part.show(stage["last_step"])).max())
        panel.set_title(title_of(number, stage, run.outcome, number == len(run.stages)))
    for panel in panels[0]:
        panel.set(xlim=(-1.02 * limit, 1.02 * limit), ylim=(-1.02 * limit, 1.02 * limit))
    figure.colorbar(part.squares, ax=panels[0], label="equivalent plastic strain", extend="max", shrink=0.8)
    name = run.directory / f"{run.name}_stages.png"
    figure.savefig(name)
    print(name)


def animate(run, highest):
    figure, panel = plt.subplots(figsize=(4.2, 3.6), layout="constrained")
    part = Slice(run, panel, highest)
    first = np.abs(part.show(run.steps[0])).max()
    panel.set(xlim=(-1.15 * first, 1.15 * first), ylim=(-1.15 * first, 1.15 * first))
    figure.colorbar(part.squares, label="equivalent plastic strain", extend="max", shrink=0.8)
    ends = {s["last_step"] for s in run.stages}
    steps = [s for step in run.steps for s in [step] * (8 if step in ends else 1)]  # a rest where a stage ends

    def show(step):
        part.show(step)
        panel.set_title(f"stage {run.stage_of(step)}, step {step}")

    film = FuncAnimation(figure, show, frames=steps)
    writers = [("gif", PillowWriter(fps=12))] + ([("mp4", FFMpegWriter(fps=12))] if shutil.which("ffmpeg") else [])
    for ending, writer in writers:
        name = run.directory / f"{run.name}_stages.{ending}"
        film.save(name, writer=writer, dpi=110)
        print(name)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("directory")
    parser.add_argument("--animation", action="store_true", help="write NAME_stages.gif, of all frames")
    parser.add_argument("--highest", type=float, default=0.006, help="strain at the end of the colours (default: %(default)s)")
    options = parser.parse_args()
    run = StagedRun(options.directory, "plot_stages.py")
    draw_stages(run, options.highest)
    if options.animation:
        animate(run, options.highest)


if __name__ == "__main__":
    main()
