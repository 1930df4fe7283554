#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws the hoop stress over the wall of pressurised rings, one panel per results directory, as physics/fields.md shows it.

    python3 apps/plot/plot_rings.py ring.png "good choice=results/a" "bad choice=results/b"

Dots are particles, the line joins their means on circles, in units of the pressure; the exact stress is the frame's own.
"""
import argparse
import json
import pathlib
import sys

try:
    import h5py
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    import numpy as np
except ImportError as error:
    sys.exit(f"plot_rings.py: {error}; on Debian: apt-get install python3-h5py python3-matplotlib, and use /usr/bin/python3")

from plot_style import EXACT, OURS


def read_hoop_stress(directory):
    """Initial radius, hoop stress and exact hoop stress of the particles of the last frame, and hoop_ratio."""
    index = [i for i in directory.glob("*.hdf.series") if not i.name.endswith("_grid.hdf.series")]
    if len(index) != 1:
        sys.exit(f"plot_rings.py: {directory} must hold the results of one run; it has {len(index)} frame indices")
    frames = [directory / f["name"] for f in json.loads(index[0].read_text())["files"]]
    with h5py.File(frames[-1]) as file:
        data = file["VTKHDF/PointData"]
        for name in ("cauchy_stress", "displacement", "exact_cauchy_stress"):
            if name not in data:
                sys.exit(f"plot_rings.py: {frames[-1].name} has no field {name}")
        position = file["VTKHDF/Points"][()] - data["displacement"][()]
        stress, exact = data["cauchy_stress"][()], data["exact_cauchy_stress"][()]
    radius = np.hypot(position[:, 0], position[:, 1])
    c, s = position[:, 0] / radius, position[:, 1] / radius
    hoop = lambda t: t[:, 0] * s * s + t[:, 1] * c * c - 2 * t[:, 3] * s * c
    summary = json.loads((directory / "summary.json").read_text())
    if "hoop_ratio" not in summary.get("compared", {}):
        sys.exit(f"plot_rings.py: {directory}: the scene compares with no cylinder")
    return radius, hoop(stress), hoop(exact), summary["compared"]["hoop_ratio"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("picture", type=pathlib.Path)
    parser.add_argument("runs", nargs="+", metavar="TITLE=DIRECTORY")
    parser.add_argument("--pressure", type=float, default=1e5, help="Pa")
    options = parser.parse_args()
    runs = [run.rpartition("=")[::2] for run in options.runs]
    figure, panels = plt.subplots(1, len(runs), figsize=(2.6 * len(runs), 2.8), sharey=True, layout="constrained", squeeze=False)
    for panel, (title, directory) in zip(panels[0], runs):
        radius, hoop, exact, ratio = read_hoop_stress(pathlib.Path(directory))
        rings, ring = np.unique(np.round(radius, 4), return_inverse=True)
        mean = lambda values: np.bincount(ring, values / options.pressure) / np.bincount(ring)
        panel.plot(radius, hoop / options.pressure, ".", color=OURS, alpha=0.25, markersize=3, markeredgewidth=0)
        panel.plot(rings, mean(hoop), "o-", color=OURS, markersize=3.5, linewidth=1.2, label="mean on a circle")
        panel.plot(rings, mean(exact), "--", color=EXACT, linewidth=1.2, label="exact")
        panel.text(0.97, 0.45, f"mean {ratio:.3f} of the exact one", transform=panel.transAxes, ha="right", fontsize=8)
        panel.set(title=title, xlabel="r (m)")
        panel.axhline(0, color="0.8", linewidth=0.6, zorder=0)
    panels[0][0].set_ylabel("hoop stress / pressure")
    panels[0][-1].legend(frameon=False, loc="lower right", bbox_to_anchor=(1, 0.12))
    figure.savefig(options.picture, dpi=130)
    print(options.picture)


if __name__ == "__main__":
    main()
