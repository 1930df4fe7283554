# SPDX-License-Identifier: BSD-3-Clause
"""The look that all drawings share; import it after matplotlib's backend is chosen."""
import matplotlib.pyplot as plt

plt.rcParams.update({
    "font.size": 9, "axes.titlesize": 10, "axes.labelsize": 9, "legend.fontsize": 8, "figure.dpi": 100,
    "savefig.dpi": 200, "axes.spines.top": False, "axes.spines.right": False, "lines.markersize": 2.5,
})
OURS, EXACT = "#1f5fa8", "#c8102e"
# Told apart by colour-blind readers too, and by their markers in grey.
SERIES = ["#1f5fa8", "#e08214", "#2a8a57", "#8e3a9d", "#4d4d4d", "#a6761d", "#0aa1b8", "#d6568c"]
MARKERS = ["o", "^", "v", "s", "D", "P", "X", "*"]
