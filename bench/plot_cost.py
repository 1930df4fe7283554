#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""plot_cost.py COST.json [PICTURE.png]: draws what `vsb_cost --json COST.json` measured: what imposing a traction on the
end face adds to a step, beside the paper's Table 3, and the time of the step itself."""
import json
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

# name | key of the paper's row | key of what was measured
METHODS = [("material points", "MP %", "end face: MP %"),
           ("boundary particles", "BP %", "end face: BP %"),
           ("original virtual stress", "ORIG %", "end face: ORIG %"),
           ("modified, with particle kernels", "MOD %", "kernels, end face: MOD %"),
           ("modified virtual stress", "MOD %", "end face: pressure %"),
           ("the same, all faces", None, "all faces: pressure %"),
           ("all faces, affine", None, "all faces: affine %"),
           ("all faces, any function", None, "all faces: function %"),
           ("nothing (null test)", None, "end face: null %")]


def draw_extras(axes, row):
    shown = [method for method in METHODS if row["found"].get(method[2]) is not None]
    for bar, (name, paper, ours) in enumerate(shown):
        value = row["found"][ours]
        axes.barh(bar - 0.2, value, 0.4, color="tab:blue", label="measured" if bar == 0 else None)
        axes.text(max(value, 0), bar - 0.2, f" {value:+.1f}", va="center", fontsize=7)
        if paper and row["paper"]:
            axes.barh(bar + 0.2, row["paper"][paper], 0.4, color="tab:orange",
                      label="paper, Table 3" if bar == 0 else None)
    axes.set_yticks(range(len(shown)), [method[0] for method in shown], fontsize=7)
    axes.invert_yaxis()
    axes.axvline(0, color="black", linewidth=0.5)
    axes.set_xlabel("extra cost, % of the step without traction", fontsize=7)
    axes.set_title(f"{row['size']}, {row['real']}: {row['particles']:,} particles, {row['found']['base ns']:.1f} ns",
                   fontsize=8)
    axes.tick_params(labelsize=7)


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    source = pathlib.Path(sys.argv[1])
    picture = pathlib.Path(sys.argv[2]) if len(sys.argv) == 3 else source.with_suffix(".png")
    cost = json.loads(source.read_text())
    rows = cost["rows"]
    columns = min(2, len(rows))
    lines = -(-len(rows) // columns)
    figure, axes = plt.subplots(lines, columns, figsize=(5.5 * columns, 2.6 * lines + 0.6), squeeze=False,
                                layout="constrained")
    for row, panel in zip(rows, axes.flat):
        draw_extras(panel, row)
    for panel in axes.flat[len(rows):]:
        panel.axis("off")
    axes.flat[0].legend(fontsize=7)
    context = cost["context"]
    figure.suptitle(f"Cost of a traction per particle and step; {context['CPU']}, {context['Kokkos']}, "
                    f"commit {context['git commit']}", fontsize=8)
    figure.savefig(picture, dpi=130)
    print(picture)


main()
