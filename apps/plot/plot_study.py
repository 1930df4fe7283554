#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws the pictures of a study: its errors over the axis, and over what they cost; or the figures that the study names.

    python3 apps/plot/plot_study.py results/column-study/column.csv

Reads NAME.csv and the NAME.json beside it, as `vsb study` writes them (and calls this script); writes NAME_errors.png and
NAME_cost.png beside them, or NAME_figures.png or NAME_distribution.png for a study with a [chart], and prints their paths.
Expected and published figures are open markers in the colour of their series.
"""
import argparse
import csv
import json
import math
import pathlib
import sys

try:
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from matplotlib.colors import to_rgba
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch
    from matplotlib.ticker import FixedLocator, FuncFormatter, LogLocator, NullLocator
except ImportError as error:
    sys.exit(f"plot_study.py: {error}; on Debian: apt-get install python3-matplotlib, and use /usr/bin/python3")

from plot_style import EXACT as MISSED
from plot_style import MARKERS, SERIES

QUANTITIES = {"e_u": "displacement", "e_u_exact": "displacement, exact solution", "e_sigma": "stress", "e_rr": "radial stress",
              "e_tt": "hoop stress", "e_xx": "stress xx", "e_yy": "stress yy", "e_xy": "stress xy"}
QUANTITIES.update({f"{e}_recovered": f"{name}, recovered" for e, name in QUANTITIES.items() if not e.startswith("e_u")})
QUANTITIES.update({f"{e}_cell_mean": f"{name}, cell means" for e, name in list(QUANTITIES.items())
                   if not e.startswith("e_u") and not e.endswith("recovered")})


QUANTITIES.update({"hoop_ratio": "mean hoop stress over the exact one", "net_force_share": "net force / load",
                   "net_torque_share": "net torque / (load x half width)", "largest_displacement": "largest displacement",
                   "strain_energy": "strain energy", "kinetic_energy": "kinetic energy",
                   "largest_von_mises": "largest von Mises stress", "largest_principal_stress": "largest principal stress",
                   "smallest_principal_stress": "smallest principal stress",
                   "largest_equivalent_plastic_strain": "largest plastic strain"})
# Of figures that have one; in 2D forces and energies are per metre of thickness.
UNITS = {"largest_displacement": "m", "strain_energy": "J", "kinetic_energy": "J", "largest_von_mises": "Pa",
         "largest_principal_stress": "Pa", "smallest_principal_stress": "Pa", "time": "s", "load": "N"}
UNITS.update({f"{kind}_{what}_{axis}": unit for kind in ("net", "exact") for what, unit in (("force", "N"), ("torque", "N m"))
              for axis in "xyz"})
FLOOR = 1e-17  # where a distribution on a logarithmic axis has its zeros


def number(text):
    """The number in a cell; None where it is empty or cannot stand on a logarithmic axis."""
    value = finite(text)
    return value if value is not None and value > 0 else None


def finite(text):
    """The number in a cell; None where it is empty or not finite."""
    value = float(text) if text else math.nan
    return value if math.isfinite(value) else None


class Study:
    """The lines of the figures that a study's charts show, its errors unless it says otherwise, by series and figure."""

    def __init__(self, path):
        self.path = pathlib.Path(path)
        self.about = json.loads(self.path.with_suffix(".json").read_text())
        self.chart = self.about["chart"]
        with self.path.open(newline="") as file:
            self.lines = [line for line in csv.DictReader(file) if line["figure"] in self.chart["figures"]]
        self.logarithmic = {figure: self.log(figure) for figure in self.chart["figures"]}
        drawn = {line["series"] for line in self.lines if self.drawn(line)}
        self.series = [name for name in self.about["series"] if name in drawn]
        self.errors = [e for e in self.chart["figures"] if any(l["figure"] == e and self.drawn(l) for l in self.lines)]
        self.labels = list(dict.fromkeys(line["case"] for line in self.lines)) if self.about["axis"]["labels"] else []

    def log(self, figure):
        """Whether a figure has a logarithmic scale: where the chart asks for it and no value is negative, nor all of them 0."""
        values = [finite(l["value"]) for l in self.lines if l["figure"] == figure and finite(l["value"]) is not None]
        return self.chart["log"] and all(v >= 0 for v in values) and any(values)

    def value(self, line, column="value"):
        """A number that can stand on the axis of the line's figure."""
        return (number if self.logarithmic[line["figure"]] else finite)(line[column])

    def drawn(self, line):
        """Whether a line is in the charts; a distribution has its zeros at the floor."""
        return (finite(line["value"]) if self.chart["distribution"] else self.value(line)) is not None

    def abscissa(self, line):
        return self.labels.index(line["case"]) if self.labels else float(line["case"])

    def of(self, series, error):
        """The lines of a series for an error that have a value, along the axis."""
        found = [l for l in self.lines if l["series"] == series and l["figure"] == error and self.drawn(l)]
        return sorted(found, key=self.abscissa)

    def style(self, series):
        index = self.about["series"].index(series)
        return SERIES[index % len(SERIES)], MARKERS[index % len(MARKERS)]


def panels_for(study, rows):
    """Rows of panels, one column per error."""
    width = max(3.1 * len(study.errors), 4.5)
    figure, panels = plt.subplots(rows, len(study.errors), squeeze=False, layout="constrained",
                                  figsize=(width, 2.7 * rows + 0.3))
    figure.suptitle(study.about["title"] or study.about["study"])
    return figure, panels


def legend_below(figure, study, extra):
    """Series first, then what the other marks mean."""
    handles = [Line2D([], [], color=study.style(s)[0], marker=study.style(s)[1], markersize=5, label=s,
                      linestyle="none" if study.labels else "-") for s in study.series]
    strip_below(figure, handles + extra)


def strip_below(figure, handles):
    """A legend in a strip that is added below the panels."""
    width, height = figure.get_size_inches()
    letters = 17 * width  # in a line
    columns = max(1, min(len(handles), int(letters / (8 + max(len(h.get_label()) for h in handles)))))
    strip = 0.19 * math.ceil(len(handles) / columns) + 0.1
    figure.set_size_inches(width, height + strip)
    share = strip / (height + strip)
    figure.get_layout_engine().set(rect=(0, share, 1, 1 - share))
    figure.legend(handles=handles, loc="lower center", ncols=columns, frameon=False)


def other_marks(study):
    """Legend entries of the open markers that occur."""
    handles = []
    grey = dict(color="0.35", linestyle="none", markerfacecolor="none")
    for column, marker, size in (("expected", "s", 8), ("published", "D", 6)):
        if any(study.value(line, column) is not None for line in study.lines):
            names = dict.fromkeys(l["source"] or "expected" for l in study.lines if study.value(l, "expected") is not None)
            name = ", ".join(names) if column == "expected" else study.about["published_source"]
            handles.append(Line2D([], [], marker=marker, markersize=size, label=name, **grey))
    if any(finite(line["extrapolated"]) is not None for line in study.lines):
        handles.append(Line2D([], [], color="0.35", linestyle="--", linewidth=0.9, label="extrapolated"))
    if any(line["verdict"] == "fail" for line in study.lines):
        handles.append(Line2D([], [], marker="o", markersize=12, label="misses its tolerance", **{**grey, "color": MISSED}))
    return handles


def draw_slopes(panel, points):
    """Reference slopes 1 and 2 in the lower right corner, below all points there."""
    xs = [x for x, _ in points]
    low, high = min(xs), max(xs)
    if not high > 1.5 * low:
        return
    left, right = low * (high / low) ** 0.6, low * (high / low) ** 0.95
    above = [y for x, y in points if x >= left / 1.05]
    bottom = 0.55 * min(above) / (right / left) ** 2
    for slope in (1, 2):
        panel.plot([left, right], [bottom, bottom * (right / left) ** slope], color="0.6", linewidth=0.9, zorder=1)
        panel.annotate(str(slope), (right, bottom * (right / left) ** slope), xytext=(3, 0), textcoords="offset points",
                       va="center", fontsize=7, color="0.45")
    panel.plot([left, right], [bottom, bottom], color="0.85", linewidth=0.7, zorder=1)


def draw_errors(study):
    axis = study.about["axis"]
    figure, panels = panels_for(study, 1)
    for panel, error in zip(panels[0], study.errors):
        points = []
        for k, series in enumerate(study.series):
            colour, marker = study.style(series)
            lines = study.of(series, error)
            shift = 0.7 * ((k + 0.5) / len(study.series) - 0.5) if study.labels else 0
            for line in lines:
                x, y = study.abscissa(line) + shift, study.value(line)
                points.append((x, y))
                for column, mark, size in (("expected", "s", 8), ("published", "D", 6)):
                    if study.value(line, column) is not None:
                        points.append((x, study.value(line, column)))
                        panel.plot(x, study.value(line, column), mark, color=colour, markerfacecolor="none", markersize=size,
                                   markeredgewidth=0.8, zorder=4)
                if line["verdict"] == "fail":
                    panel.plot(x, y, "o", color=MISSED, markerfacecolor="none", markersize=12, markeredgewidth=1.2, zorder=5)
            panel.plot([study.abscissa(l) + shift for l in lines], [study.value(l) for l in lines], color=colour,
                       marker=marker, markersize=4, linewidth=1.2, linestyle="none" if study.labels else "-", zorder=3)
            found = [study.value(l, "extrapolated") for l in lines if study.value(l, "extrapolated") is not None]
            if found:  # from the last three cases
                panel.axhline(found[-1], color=colour, linestyle="--", linewidth=0.9, zorder=2)
        log = study.logarithmic[error]
        if log:
            panel.set_yscale("log")
        panel.set(title=QUANTITIES.get(error, ""), ylabel=f"{error} ({UNITS.get(error, '-')})")
        panel.grid(axis="y", color="0.92", linewidth=0.6)
        panel.set_axisbelow(True)
        if study.labels:
            panel.set_xlim(-0.5, len(study.labels) - 0.5)
            panel.set_xticks(range(len(study.labels)), study.labels,
                             **(dict(rotation=30, ha="right") if max(map(len, study.labels)) > 8 else {}))
            panel.tick_params(axis="x", length=0)
            panel.set_xlabel(axis["name"])
        else:
            panel.set_xlabel(axis["name"] + (f" ({axis['unit']})" if axis["unit"] else ""))
            if axis["log"]:
                panel.set_xscale("log")
                if log and error in study.about["errors"]:
                    draw_slopes(panel, points)
            abscissae = {line["case"]: float(line["case"]) for line in study.lines}
            if len(abscissae) <= 7:
                panel.xaxis.set_major_locator(FixedLocator(sorted(abscissae.values())))
                panel.xaxis.set_minor_locator(NullLocator())
                panel.set_xticks(sorted(abscissae.values()), sorted(abscissae, key=abscissae.get))
            panel.margins(x=0.08)
            # All panels have the axis of the study, also where an error exists, or a scene runs, in a part of it alone.
            span = max(abscissae.values()) - min(abscissae.values())
            if not axis["log"] and span > 0:
                panel.set_xlim(min(abscissae.values()) - 0.06 * span, max(abscissae.values()) + 0.06 * span)
        if log:
            readable(panel.yaxis)
    sloping = axis["log"] and any(study.logarithmic[e] and e in study.about["errors"] for e in study.errors)
    slopes = [Line2D([], [], color="0.6", linewidth=0.9, label="slopes 1 and 2")] if sloping else []
    legend_below(figure, study, other_marks(study) + slopes)
    return figure


def draw_distribution(study):
    """How many cases of every series have which value."""
    width = 3.6 * len(study.errors)
    figure, panels = plt.subplots(1, len(study.errors), squeeze=False, sharex=True, sharey=True, layout="constrained",
                                  figsize=(width, 2.9))
    figure.suptitle(study.about["title"] or study.about["study"])
    log = any(study.logarithmic[e] for e in study.errors) and all(
        finite(l["value"]) >= 0 for l in study.lines if finite(l["value"]) is not None)

    def look(series):
        colour, _ = study.style(series)
        return dict(facecolor=to_rgba(colour, 0.25), edgecolor=colour, linewidth=1.2)

    values = {(s, e): [max(FLOOR, finite(l["value"])) if log else finite(l["value"]) for l in study.of(s, e)]
              for s in study.series for e in study.errors}
    everything = [x for some in values.values() for x in some]
    if log:  # three bins to a decade
        low, high = math.floor(3 * math.log10(min(everything))), math.ceil(3 * math.log10(max(everything)))
        bins = [10 ** (k / 3) for k in range(low, max(high, low + 1) + 1)]
    else:
        bins = 40
        low, high = min(everything), max(everything)
    for panel, error in zip(panels[0], study.errors):
        for series in study.series:
            panel.hist(values[series, error], bins=bins, range=None if log else (low, high), histtype="stepfilled",
                       **look(series))
        if log:
            panel.set_xscale("log")
        panel.set_xlabel(f"{QUANTITIES.get(error, error)} ({UNITS.get(error, '-')})")
    panels[0][0].set_ylabel("cases")
    strip_below(figure, [Patch(**look(series), label=series) for series in study.series])
    return figure


def pareto(points):
    """The points that no other one beats in both cost and error, by cost."""
    front = []
    for cost, error, case in sorted(points):
        if not front or error < front[-1][1]:
            front.append((cost, error, case))
    return front


def draw_cost(study):
    costs = [("seconds", "wall time (s)"), ("particle_steps", "particle-steps (-)")]
    figure, panels = panels_for(study, len(costs))
    for row, (cost, name) in zip(panels, costs):
        for panel, error in zip(row, study.errors):
            points = []
            for series in study.series:
                colour, marker = study.style(series)
                lines = [l for l in study.of(series, error) if number(l[cost])]
                xs, ys = [number(l[cost]) for l in lines], [number(l["value"]) for l in lines]
                points += zip(xs, ys, (l["case"] for l in lines))
                panel.plot(xs, ys, color=colour, marker=marker, markersize=4, linewidth=0 if study.labels else 0.9, zorder=3)
            front = pareto(points)
            # A step: what is in reach for a given cost.
            panel.step([x for x, _, _ in front], [y for _, y, _ in front], where="post", color="0.75", linewidth=4, alpha=0.6,
                       solid_capstyle="round", zorder=1, marker="o", markersize=9, markeredgewidth=0)
            panel.set(xscale="log", yscale="log", xlabel=name, ylabel=f"{error} (-)")
            panel.margins(0.15)
            for axis in (panel.xaxis, panel.yaxis):
                readable(axis)
            name_front(panel, front)
            if row is panels[0]:
                panel.set_title(QUANTITIES.get(error, ""))
    front = Line2D([], [], color="0.75", linewidth=4, alpha=0.6, marker="o", markersize=9,
                   label=f"best in reach (Pareto front), with {study.about['axis']['name']}")
    legend_below(figure, study, [front])
    return figure


def name_front(panel, front):
    """The cases on the front, to its lower left, where nothing else is; names that would overlap are left out."""
    spans = [math.log(high / low) for low, high in (panel.get_xlim(), panel.get_ylim())]
    last = None
    for x, y, case in front:
        if last and math.log(x / last[0]) < 0.2 * spans[0] and math.log(last[1] / y) < 0.07 * spans[1]:
            continue
        panel.annotate(case, (x, y), xytext=(-5, -4), textcoords="offset points", ha="right", va="top", fontsize=6.5,
                       color="0.3")
        last = (x, y)


def readable(axis):
    """A logarithmic axis with at least a decade, so that round-off does not look like a trend, and with enough numbers."""
    low, high = axis.get_view_interval()
    if high < 10 * low:
        middle = math.sqrt(low * high)
        low, high = middle / 3.3, middle * 3.3
        axis.set_view_interval(low, high, ignore=True)
    if high < 300 * low:
        axis.set_major_locator(LogLocator(subs=(1, 2, 5) if high < 30 * low else (1, 3)))
        axis.set_minor_locator(NullLocator())
        axis.set_major_formatter(FuncFormatter(lambda value, _: power_text(value)))


def power_text(value):
    exponent = math.floor(math.log10(value) + 1e-9)
    digit = round(value / 10**exponent)
    if -2 <= exponent <= 2:
        return f"{value:g}"
    return rf"$10^{{{exponent}}}$" if digit == 1 else rf"${digit}\times10^{{{exponent}}}$"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("table", help="NAME.csv of a study")
    parser.add_argument("--dpi", type=int, default=200, help="dots per inch of the pictures (default: 200)")
    arguments = parser.parse_args()
    study = Study(arguments.table)
    if not study.errors:
        print("plot_study.py: no case has a figure to draw")
        return
    if study.chart["distribution"]:
        kinds = [("distribution", draw_distribution)]
    elif study.chart["cost"]:
        kinds = [("errors", draw_errors), ("cost", draw_cost)]
    else:
        kinds = [("figures", draw_errors)]
    for kind, draw in kinds:
        path = study.path.with_name(f"{study.path.stem}_{kind}.png")
        figure = draw(study)
        figure.savefig(path, dpi=arguments.dpi)
        plt.close(figure)
        print(path)


if __name__ == "__main__":
    main()
