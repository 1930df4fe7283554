#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws the pictures of a run: fields over the body, and profiles against the exact solution.

    python3 apps/plot.py results/cylinder            the last frame
    python3 apps/plot.py results/cylinder --step 0   another one

Reads the particle frames and summary.json of a results directory; writes NAME_fields.png (2D and 3D scenes) and
NAME_profiles.png (1D scenes, and those with an exact solution) beside them and prints their paths. Formulas of exact solutions are not repeated here: frames carry the
exact fields.
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
    from matplotlib.collections import PolyCollection
except ImportError as error:
    sys.exit(f"plot.py: {error}; on Debian: apt-get install python3-h5py python3-matplotlib, and use /usr/bin/python3")

from plot_style import EXACT, OURS


class Frame:
    """One frame: points, fields, and which scene it is of."""

    def __init__(self, directory, step):
        self.directory = pathlib.Path(directory)
        indices = sorted(i for i in self.directory.glob("*.hdf.series") if not i.name.endswith("_grid.hdf.series"))
        if len(indices) != 1:
            sys.exit(f"plot.py: {directory} must hold the results of one run; it has {len(indices)} frame indices")
        self.name = indices[0].name[: -len(".hdf.series")]
        files = json.loads(indices[0].read_text())["files"]
        if step is not None:
            files = [f for f in files if int(f["name"].rsplit("_", 1)[1][:-4]) == step]
            if not files:
                sys.exit(f"plot.py: {indices[0]} lists no frame of step {step}")
        self.time = files[-1]["time"]
        self.file_name = files[-1]["name"]
        with h5py.File(self.directory / self.file_name) as file:
            self.position = file["VTKHDF/Points"][()]
            self.fields = {name: data[()] for name, data in file["VTKHDF/PointData"].items()}
        summary = self.directory / "summary.json"
        self.summary = json.loads(summary.read_text()) if summary.exists() else {}
        spread = np.ptp(self.position, axis=0)
        self.dimension = self.summary.get("dimension") or (1 if not spread[1:].any() else 2 if not spread[2] else 3)

    def has(self, *names):
        return all(name in self.fields for name in names)


def scaled(values, unit):
    """Values and unit with a prefix that keeps the numbers readable."""
    largest = np.nanmax(np.abs(values)) if len(values) else 0
    for factor, prefix in ((1e9, "G"), (1e6, "M"), (1e3, "k"), (1, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n")):
        if largest >= factor:
            return factor, prefix + unit
    return 1, unit


def polar(stress, x, y):
    """Radial and hoop components of in-plane stresses (columns xx, yy, zz, xy, ...)."""
    r = np.hypot(x, y)
    c, s = x / r, y / r
    xx, yy, xy = stress[:, 0], stress[:, 1], stress[:, 3]
    return c * c * xx + s * s * yy + 2 * c * s * xy, s * s * xx + c * c * yy - 2 * c * s * xy


def von_mises(s):
    xx, yy, zz, xy, yz, xz = s.T
    return np.sqrt(0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3 * (xy**2 + yz**2 + xz**2))


def errors_of(frame):
    return frame.summary.get("errors", {})


def compared_quantities(frame):
    """(label, unit, ours, exact, error name) for everything a comparison knows; exact is None without one."""
    x, y, _ = frame.position.T
    stress, exact = frame.fields["cauchy_stress"], frame.fields.get("exact_cauchy_stress")
    u, exact_u = frame.fields["displacement"], frame.fields.get("exact_displacement")
    errors = errors_of(frame)
    if "e_rr" in errors:
        rr, tt = polar(stress, x, y)
        exact_rr, exact_tt = polar(exact, x, y)
        r = np.hypot(x, y)
        return [(r"$\sigma_{rr}$", "Pa", rr, exact_rr, "e_rr"), (r"$\sigma_{\theta\theta}$", "Pa", tt, exact_tt, "e_tt"),
                (r"$u_r$", "m", (u[:, 0] * x + u[:, 1] * y) / r, np.hypot(exact_u[:, 0], exact_u[:, 1]), "e_u")]
    if "e_xx" in errors:
        return [(rf"$\sigma_{{{name}}}$", "Pa", stress[:, c], exact[:, c], f"e_{name}")
                for name, c in (("xx", 0), ("yy", 1), ("xy", 3))]
    if "e_sigma" in errors:
        return [(r"$u_x$", "m", u[:, 0], exact_u[:, 0], "e_u" if "e_u" in errors else "e_u_exact"),
                (r"$\sigma_{xx}$", "Pa", stress[:, 0], exact[:, 0], "e_sigma")]
    mean = stress[:, :3].mean(axis=1)
    return [("mean stress", "Pa", mean, None, None), ("von Mises stress", "Pa", von_mises(stress), None, None),
            *[(rf"$u_{'xyz'[i]}$", "m", u[:, i], None, None) for i in range(frame.dimension)]]


def particle_sizes(frame):
    """Edge lengths of the particles: the lattice's intervals where they lie on one, a cube of the same volume otherwise."""
    volume, d = frame.fields["volume"], frame.dimension
    start = (frame.position - frame.fields["displacement"])[:, :d]
    intervals = []
    for x in start.T:
        places = np.unique(np.round(x / max(np.ptp(x), 1e-300), 9)) * max(np.ptp(x), 1e-300)
        intervals.append(np.diff(places).min() if len(places) > 1 else np.nan)
    if np.isfinite(intervals).all() and abs(np.prod(intervals) / np.median(volume) - 1) < 0.05:
        return np.tile(intervals, (len(volume), 1))
    return np.tile(volume[:, None] ** (1 / d), (1, d))


def rectangles(frame, keep, axes):
    """A rectangle per particle, of its size in the plane drawn."""
    half = 0.5 * particle_sizes(frame)[keep][:, axes]
    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    return frame.position[keep][:, axes][:, None, :] + half[:, None, :] * corners[None]


def draw_fields(frame):
    """A row per source (exact, this run, difference), a column per quantity."""
    keep = np.ones(len(frame.position), bool)
    axes, names = [0, 1], "xy"
    if frame.dimension == 3:  # the layer of particles nearest to the middle of the thinnest direction
        thin = int(np.argmin(np.ptp(frame.position, axis=0)))
        z = frame.position[:, thin]
        sizes = particle_sizes(frame)
        volume = frame.fields["volume"]
        whole = np.flatnonzero(volume > 0.99 * volume.max())  # what a surface cuts has a place of its own
        middle = 0.5 * (z.min() + z.max())
        level = z[whole[np.argmin(np.abs(z[whole] - middle))]]
        keep = np.abs(z - level) < 0.499 * sizes[:, thin]
        axes = [i for i in range(3) if i != thin]
        names = "".join("xyz"[i] for i in axes)
    quantities = compared_quantities(frame)
    rows = ["exact", "this run", "difference"] if quantities[0][3] is not None else ["this run"]
    polygons = rectangles(frame, keep, axes)
    low, high = polygons.min(axis=(0, 1)), polygons.max(axis=(0, 1))
    aspect = (high[1] - low[1]) / (high[0] - low[0])
    flat = aspect < 0.6  # colour bars below, not beside
    width = 4.2 if flat else 3.1
    height = width * aspect + 1.15 if flat else 0.72 * width * aspect + 0.5
    figure, panels = plt.subplots(len(rows), len(quantities), squeeze=False, layout="constrained",
                                  figsize=(width * len(quantities), height * len(rows)))
    for column, (label, unit, ours, exact, error) in enumerate(quantities):
        reference = ours if exact is None else exact
        factor, unit = scaled(reference[keep], unit)
        for row, source in enumerate(rows):
            values = {"exact": exact, "this run": ours}.get(source)
            if source == "difference":
                values = ours - exact
            values = values[keep] / factor
            if source == "difference":
                bound = np.percentile(np.abs(values), 99.5) or 1
                limits, colours = (-bound, bound), "RdBu_r"
            else:
                limits, colours = np.percentile(reference[keep] / factor, [0.2, 99.8]), "viridis"
                if limits[1] - limits[0] <= 1e-6 * np.abs(limits).max():
                    limits = (limits[0] - 0.5 * abs(limits[0]), limits[1] + 0.5 * abs(limits[1]))
            panel = panels[row][column]
            panel.add_collection(PolyCollection(polygons, array=values, cmap=colours, clim=limits, edgecolors="face",
                                                linewidths=0.4, rasterized=True))
            panel.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal", xlabel=f"{names[0]} (m)",
                      ylabel=f"{names[1]} (m)")
            text = f"{label}, {source}"
            if source == "this run" and error in errors_of(frame):
                text += f"  ({error} = {errors_of(frame)[error]:.2e})"
            panel.set_title(text)
            if flat:
                panel.yaxis.set_major_locator(plt.MaxNLocator(2))
            place = dict(location="bottom", aspect=40) if flat else dict(shrink=0.9)
            figure.colorbar(panel.collections[0], ax=panel, label=unit, pad=0.02, **place)
    figure.suptitle(f"{frame.name}: t = {frame.time:.4g} s, {len(frame.position)} particles")
    return figure


def draw_profiles(frame):
    """Every quantity over the coordinate it varies along: radius for the cylinder, x otherwise."""
    x, y, _ = frame.position.T
    radial = "e_rr" in errors_of(frame)
    along, name = (np.hypot(x, y), "r") if radial else (x, "x")
    quantities = compared_quantities(frame)
    exact_known = quantities[0][3] is not None
    rows = 2 if exact_known else 1
    figure, panels = plt.subplots(rows, len(quantities), squeeze=False, layout="constrained", sharex="col",
                                  figsize=(3.3 * len(quantities), 2.5 * rows),
                                  gridspec_kw={"height_ratios": [1.6, 1][:rows]})
    order = np.argsort(along)
    marks = dict(marker="o" if len(along) < 400 else ".", linestyle="none", markeredgewidth=0, rasterized=True,
                 alpha=1 if len(along) < 400 else 0.35)
    for column, (label, unit, ours, exact, error) in enumerate(quantities):
        factor, scaled_unit = scaled(ours if exact is None else exact, unit)
        panel = panels[0][column]
        if exact_known and (radial or "e_sigma" in errors_of(frame)):
            panel.plot(along[order], exact[order] / factor, color=EXACT, linewidth=1.2, label="exact", zorder=3)
        elif exact_known:
            panel.plot(along, exact / factor, color=EXACT, label="exact", **marks)
        panel.plot(along, ours / factor, color=OURS, label="this run", **marks)
        panel.set(title=label, ylabel=f"{label} ({scaled_unit})")
        if np.ptp(ours) < 1e-6 * np.abs(ours).max():  # a constant: show it as one, not its round-off
            centre = ours.mean() / factor
            panel.set_ylim(centre - 0.1 * abs(centre), centre + 0.1 * abs(centre))
        legend = panel.legend(frameon=False)
        for handle in legend.get_lines():
            handle.set_alpha(1)
        if exact_known:
            below = panels[1][column]
            scale = np.abs(exact).max()
            below.semilogy(along, np.maximum(np.abs(ours - exact) / scale, 1e-18), color=OURS, **marks)
            below.set(ylabel="|difference| / max", xlabel=f"{name} (m)")
            if error in errors_of(frame):
                below.set_title(f"{error} = {errors_of(frame)[error]:.3e}", fontsize=8)
        else:
            panel.set_xlabel(f"{name} (m)")
    figure.suptitle(f"{frame.name}: t = {frame.time:.4g} s, {len(frame.position)} particles")
    return figure


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("directory", help="results directory of one run")
    parser.add_argument("--step", type=int, help="step of the frame to draw (default: the last)")
    parser.add_argument("--dpi", type=int, default=200, help="dots per inch of the pictures (default: 200)")
    arguments = parser.parse_args()
    frame = Frame(arguments.directory, arguments.step)
    if not frame.has("cauchy_stress", "displacement", "volume"):
        sys.exit("plot.py: the frames lack cauchy_stress, displacement or volume; see output.fields of the scene")
    drawings = {}
    if frame.dimension == 1 or errors_of(frame):
        drawings["profiles"] = draw_profiles
    if frame.dimension > 1:
        drawings["fields"] = draw_fields
    for kind, draw in drawings.items():
        path = frame.directory / f"{frame.name}_{kind}.png"
        figure = draw(frame)
        figure.savefig(path, dpi=arguments.dpi, bbox_inches="tight")
        plt.close(figure)
        print(path)


if __name__ == "__main__":
    main()
