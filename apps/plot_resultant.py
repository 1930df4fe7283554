#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws the net force of a uniform pressure on random closed bodies, at the boundary nodes and at all of them.

    VSB_RESULTANT_CSV=resultant.csv build/openmp/tests/vsb_kernels_tests --filenames-as-tags "[#resultant]"
    python3 apps/plot_resultant.py resultant.csv

Writes resultant.png beside the table and prints its path.
"""
import argparse
import csv
import pathlib
import sys

try:
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
except ImportError as error:
    sys.exit(f"plot_resultant.py: {error}; on Debian: apt-get install python3-matplotlib, and use /usr/bin/python3")

from plot_style import EXACT, OURS

FLOOR = 1e-17  # what is smaller is drawn here


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("table", type=pathlib.Path)
    table = parser.parse_args().table
    with open(table, newline="") as file:
        rows = list(csv.DictReader(file))
    figure, axes = plt.subplots(1, 2, figsize=(7.2, 2.8), sharey=True, layout="constrained")
    bins = [10 ** (k / 3) for k in range(-51, 1)]
    for axis, dimension in zip(axes, ("2", "3")):
        of = [row for row in rows if row["dimension"] == dimension]
        for column, name, colour in (("all_force", 'nodes = "all"', OURS), ("boundary_force", 'nodes = "boundary"', EXACT)):
            values = [max(FLOOR, float(row[column])) for row in of]
            axis.hist(values, bins=bins, color=colour, alpha=0.85,
                      label=f"{name}: largest {max(values):.0e}")
        axis.set_xscale("log")
        axis.set_title(f"{len(of)} bodies in {dimension}D")
        axis.set_xlabel("|net force| / (pressure x area)")
        axis.legend(frameon=False, loc="upper center")
    axes[0].set_ylabel("bodies")
    axes[0].set_ylim(top=1.35 * axes[0].get_ylim()[1])
    picture = table.with_suffix(".png")
    figure.savefig(picture)
    print(picture)


if __name__ == "__main__":
    main()
