#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws the pictures of a run: fields over the body, and profiles against the exact solution.

    python3 apps/plot/plot.py results/cylinder                       the last frame
    python3 apps/plot/plot.py results/cylinder --step 0              the frame of another step; --frame N: the Nth, from 0
    python3 apps/plot/plot.py results/cylinder --field von_mises     a field of your choice
    python3 apps/plot/plot.py results/cylinder --field displacement_x --animation     of all frames

Reads the particle frames and summary.json of a results directory; writes NAME_fields.png (2D and 3D scenes) and
NAME_profiles.png (1D scenes, and those with an exact solution) beside them and prints their paths; with --field NAME_FIELD.png,
of a frame that is asked for NAME_fields_STEP.png, with --animation NAME_FIELD.gif (and .mp4, with ffmpeg at hand). Of a run that was interrupted it draws the last frame that is
whole, and says so. Formulas of exact solutions are not repeated here: frames carry the exact fields.

Fields are those of the frames (vsb check: output.fields): a number per particle by its name (equivalent_plastic_strain), a
component with its axes (cauchy_stress_xy, displacement_x), the length of a vector by its name (displacement); and pressure,
mean_stress and von_mises.
"""
import argparse
import functools
import json
import pathlib
import shutil
import sys

try:
    import h5py
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    import numpy as np
    from matplotlib.animation import FFMpegWriter, FuncAnimation, PillowWriter
    from matplotlib.collections import PolyCollection
except ImportError as error:
    sys.exit(f"plot.py: {error}; on Debian: apt-get install python3-h5py python3-matplotlib, and use /usr/bin/python3")

from particle_boxes import boxes, middle_layer, particle_sizes
from plot_style import EXACT, OURS

AXES = {3: ["x", "y", "z"], 6: ["xx", "yy", "zz", "xy", "yz", "xz"]}
UNITS = {"cauchy_stress": "Pa", "recovered_stress": "Pa", "displacement": "m", "velocity": "m/s", "mass": "kg"}


class Run:
    """A results directory: its summary, {} where the run is not at its end, and its frames."""

    def __init__(self, directory):
        self.directory = pathlib.Path(directory)
        indices = sorted(i for i in self.directory.glob("*.hdf.series") if not i.name.endswith("_grid.hdf.series"))
        if len(indices) != 1:
            sys.exit(f"plot.py: {directory} must hold the results of one run; it has {len(indices)} frame indices")
        self.index = indices[0]
        self.name = self.index.name[: -len(".hdf.series")]
        self.files = json.loads(self.index.read_text())["files"]
        if not self.files:
            sys.exit(f"plot.py: {self.index} lists no frame")
        summary = self.directory / "summary.json"
        self.summary = json.loads(summary.read_text()) if summary.exists() else {}

    def step_of(self, file):
        return int(file["name"].rsplit("_", 1)[1][:-4])

    def frame(self, step=None, number=None):
        """The frame of a step, or the one of a number; the last that is whole where none is asked for."""
        if step is not None:
            found = [f for f in self.files if self.step_of(f) == step]
            if not found:
                steps = ", ".join(str(self.step_of(f)) for f in self.files)
                sys.exit(f"plot.py: {self.index} lists no frame of step {step} (of steps {steps})")
            return Frame(self, found[-1])
        if number is not None:
            if not -len(self.files) <= number < len(self.files):
                sys.exit(f"plot.py: {self.index} lists {len(self.files)} frames, 0 to {len(self.files) - 1}; there is no {number}")
            return Frame(self, self.files[number])
        for file in reversed(self.files):
            try:
                frame = Frame(self, file)
            except (OSError, KeyError) as error:
                print(f"plot.py: {file['name']} is not whole ({error})", file=sys.stderr)
                continue
            if not self.summary:
                print(f"plot.py: {self.directory} has no summary.json: the run is not at its end; this is step {frame.step}, the "
                      "last frame that is whole" + ("" if frame.step else ", the state it began in (for more: output.every)"),
                      file=sys.stderr)
            return frame
        sys.exit(f"plot.py: {self.directory} has no frame that is whole")


class Frame:
    """One frame: points, fields, and which run it is of."""

    def __init__(self, run, file):
        self.run, self.directory, self.name, self.summary = run, run.directory, run.name, run.summary
        self.time, self.step = file["time"], run.step_of(file)
        with h5py.File(self.directory / file["name"]) as data:
            self.position = data["VTKHDF/Points"][()]
            self.fields = {name: field[()] for name, field in data["VTKHDF/PointData"].items()}
        spread = np.ptp(self.position, axis=0)
        self.dimension = self.summary.get("dimension") or (1 if not spread[1:].any() else 2 if not spread[2] else 3)

    def has(self, *names):
        return all(name in self.fields for name in names)

    def needs(self, *names):
        """Ends the program unless the frame has what drawing takes, and these fields."""
        lacking = [name for name in ("displacement", "volume", *names) if name not in self.fields]
        if lacking:
            sys.exit(f"plot.py: the frames lack {', '.join(lacking)}; see output.fields of the scene")

    def title(self):
        state = "" if self.summary else ", run not at its end"
        return f"{self.name}: t = {self.time:.4g} s, {len(self.position)} particles{state}"

    @functools.cached_property
    def start(self):
        return (self.position - self.fields["displacement"])[:, : self.dimension]

    @functools.cached_property
    def sizes(self):
        """Edges of the particles' boxes."""
        return particle_sizes(self.start, self.fields["volume"], self.fields.get("mass"))

    def choices(self):
        """What --field can name."""
        names = ["pressure", "mean_stress", "von_mises"] if self.has("cauchy_stress") else []
        for name, values in self.fields.items():
            if values.ndim == 1 or values.shape[1] == 3:
                names.append(name)
            if values.ndim > 1:
                names += [f"{name}_{axes}" for axes in AXES.get(values.shape[1], [])]
        return names

    def field(self, name):
        """(values, unit) of a field by the name it has for --field."""
        if name not in self.choices():
            sys.exit(f"plot.py: the frames have no field '{name}'; there are {', '.join(self.choices())}")
        if name in ("pressure", "mean_stress", "von_mises"):
            stress = self.fields["cauchy_stress"]
            mean = stress[:, :3].mean(axis=1)
            return {"pressure": -mean, "mean_stress": mean}[name] if name != "von_mises" else von_mises(stress), "Pa"
        volume = {1: "m", 2: "m²", 3: "m³"}[self.dimension]
        whole = name if name in self.fields else name.rpartition("_")[0]
        unit = volume if whole == "volume" else UNITS.get(whole.removeprefix("exact_"), "")
        values = self.fields[whole]
        if name == whole:
            return values.astype(float) if values.ndim == 1 else np.linalg.norm(values, axis=1), unit
        return values[:, AXES[values.shape[1]].index(name.rpartition("_")[2])], unit


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


def plane_of(frame):
    """The plane drawn, in 3D across the thinnest direction: which particles meet it, and the axes in it."""
    if frame.dimension < 3:
        return np.ones(len(frame.position), bool), [0, 1]
    thin = int(np.argmin(np.ptp(frame.position, axis=0)))
    amount = frame.fields.get("mass", frame.fields["volume"])
    return middle_layer(frame.start, frame.sizes, amount, thin), [i for i in range(3) if i != thin]


def rectangles(frame, keep, axes):
    """A rectangle per particle, of its size in the plane drawn."""
    return boxes(frame.position[keep], frame.sizes[keep], axes)


def limits_of(values):
    """Ends of a range of colours."""
    low, high = np.percentile(values, [0.2, 99.8])
    if high - low <= 1e-6 * max(abs(low), abs(high)):
        return low - 0.5 * abs(low), high + 0.5 * abs(high)
    return low, high


def panel_size(aspect, flat, alone=False):
    """Inches for a panel of this height over its width. Flat ones have their colour bars below, not beside; `alone`: nothing is
    drawn beside them."""
    if not flat:
        return 3.1, 0.72 * 3.1 * aspect + 0.5
    width = 6.5 if alone else 4.2
    return width, 0.88 * width * aspect + 1.5


def drawn_quantities(frame, field):
    """What a picture shows: the field that was asked for, or what is compared."""
    if field is None:
        return compared_quantities(frame)
    values, unit = frame.field(field)
    return [(field, unit, values, None, None)]


def draw_fields(frame, field=None):
    """A row per source (exact, this run, difference), a column per quantity."""
    keep, axes = plane_of(frame)
    names = "".join("xyz"[i] for i in axes)
    quantities = drawn_quantities(frame, field)
    rows = ["exact", "this run", "difference"] if quantities[0][3] is not None else ["this run"]
    polygons = rectangles(frame, keep, axes)
    low, high = polygons.min(axis=(0, 1)), polygons.max(axis=(0, 1))
    aspect = (high[1] - low[1]) / (high[0] - low[0])
    flat = aspect < 0.6
    stacked = flat and len(rows) == 1  # one below the other, being wide
    width, height = panel_size(aspect, flat, stacked)
    shape = (len(quantities), 1) if stacked else (len(rows), len(quantities))
    figure, panels = plt.subplots(*shape, squeeze=False, layout="constrained",
                                  figsize=(width * shape[1], height * shape[0] + 0.3))
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
                limits, colours = limits_of(reference[keep] / factor), "viridis"
            panel = panels[column][0] if stacked else panels[row][column]
            panel.add_collection(PolyCollection(polygons, array=values, cmap=colours, clim=limits, edgecolors="face",
                                                linewidths=0.4, rasterized=True))
            panel.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal", xlabel=f"{names[0]} (m)",
                      ylabel=f"{names[1]} (m)")
            text = f"{label}, {source}"
            if source == "this run" and error in errors_of(frame):
                text += f"  ({error} = {errors_of(frame)[error]:.2e})"
            panel.set_title(text)
            if flat:
                panel.yaxis.set_major_locator(plt.MaxNLocator(2 if aspect > 0.15 else 1))
            bar_options = dict(location="bottom", aspect=40) if flat else dict(shrink=0.9)
            figure.colorbar(panel.collections[0], ax=panel, label=unit, pad=0.02, **bar_options)
    figure.suptitle(frame.title())
    return figure


def draw_profiles(frame, field=None):
    """Every quantity over the coordinate it varies along: radius for the cylinder, x otherwise."""
    x, y, _ = frame.position.T
    radial = "e_rr" in errors_of(frame)
    along, name = (np.hypot(x, y), "r") if radial else (x, "x")
    quantities = drawn_quantities(frame, field)
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
    figure.suptitle(frame.title())
    return figure


def animate(run, field):
    """A film of a field over all frames that are whole, with the same colours in all of them."""
    frames = []
    for file in run.files:
        try:
            frames.append(Frame(run, file))
        except (OSError, KeyError) as error:
            print(f"plot.py: {file['name']} is left out ({error})", file=sys.stderr)
    if len(frames) < 2:
        sys.exit(f"plot.py: an animation needs two frames; {run.index} has {len(frames)} that are whole (for more: output.every)")
    flat = frames[0].dimension == 1
    positions, values = [], []
    for frame in frames:
        frame.needs()
        of_all, unit = frame.field(field)
        keep, axes = plane_of(frame)
        values.append(of_all[keep])
        positions.append(frame.position[:, 0] if flat else rectangles(frame, keep, axes))
    factor, unit = scaled(np.concatenate(values), unit)
    values = [v / factor for v in values]
    limits = limits_of(np.concatenate(values))
    flattened = np.concatenate([p.reshape(-1, p.shape[-1]) if p.ndim > 1 else p[:, None] for p in positions])
    low, high = flattened.min(axis=0), flattened.max(axis=0)
    label = f"{field} ({unit})" if unit else field
    if flat:
        figure, panel = plt.subplots(figsize=(4.6, 3), layout="constrained")
        marks, = panel.plot([], [], ".", color=OURS)
        margin = 0.05 * (limits[1] - limits[0])
        panel.set(xlim=(low[0], high[0]), ylim=(limits[0] - margin, limits[1] + margin), xlabel="x (m)", ylabel=label)
    else:
        aspect = (high[1] - low[1]) / (high[0] - low[0])
        wide = aspect < 0.6
        figure, panel = plt.subplots(figsize=panel_size(aspect, wide, True), layout="constrained")
        marks = PolyCollection([], cmap="viridis", clim=limits, edgecolors="face", linewidths=0.4)
        panel.add_collection(marks)
        panel.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal", xlabel=f"{'xyz'[axes[0]]} (m)",
                  ylabel=f"{'xyz'[axes[1]]} (m)")
        figure.colorbar(marks, ax=panel, label=label, **(dict(location="bottom", aspect=40) if wide else {}))

    def show(number):
        if flat:
            marks.set_data(positions[number], values[number])
        else:
            marks.set_verts(positions[number])
            marks.set_array(values[number])
        panel.set_title(f"t = {frames[number].time:.4g} s, step {frames[number].step}", fontsize=9)

    film = FuncAnimation(figure, show, frames=len(frames))
    for ending, writer in [("gif", PillowWriter(fps=12))] + ([("mp4", FFMpegWriter(fps=12))] if shutil.which("ffmpeg") else []):
        path = run.directory / f"{run.name}_{field}.{ending}"
        film.save(path, writer=writer, dpi=110)
        print(path)
    plt.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("directory", help="results directory of one run")
    which = parser.add_mutually_exclusive_group()
    which.add_argument("--step", type=int, help="step of the frame to draw (default: the last frame)")
    which.add_argument("--frame", type=int, help="number of the frame to draw, from 0; -1 is the last")
    which.add_argument("--animation", action="store_true", help="a film of all frames (default field: von_mises)")
    parser.add_argument("--field", help="field to draw, such as von_mises, pressure or displacement_x")
    parser.add_argument("--dpi", type=int, default=200, help="dots per inch of the pictures (default: 200)")
    arguments = parser.parse_args()
    run = Run(arguments.directory)
    if arguments.animation:
        animate(run, arguments.field or "von_mises")
        return
    frame = run.frame(arguments.step, arguments.frame)
    frame.needs(*([] if arguments.field else ["cauchy_stress"]))
    of_frame = "" if arguments.step is None and arguments.frame is None else f"_{frame.step:06d}"
    drawings = {}
    if frame.dimension == 1 or (errors_of(frame) and not arguments.field):
        drawings["profiles"] = draw_profiles
    if frame.dimension > 1:
        drawings["fields"] = draw_fields
    for kind, draw in drawings.items():
        path = frame.directory / f"{frame.name}_{arguments.field or kind}{of_frame}.png"
        figure = draw(frame, arguments.field)
        figure.savefig(path, dpi=arguments.dpi, bbox_inches="tight")
        plt.close(figure)
        print(path)


if __name__ == "__main__":
    main()
