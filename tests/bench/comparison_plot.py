"""Plots comparison.json to docs/images/comparison.svg. Requires matplotlib:

pip install matplotlib==3.11.2 && python tests/bench/comparison_plot.py
"""

from __future__ import annotations

import hashlib
import pathlib

import comparison
import matplotlib.pyplot as plt
from comparison import FIGURES, SIZES, TOOLS, Key

PLOT = pathlib.Path(__file__).parents[2] / "docs" / "images" / "comparison.svg"
PANELS = ("open", "keystroke, syntax", "keystroke + completion", "formatting")

# Those of the pictures of paths (crates/picture/src/style.rs).
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#b0508f")
MARKERS = ("o", "s", "^", "D")
INK, QUIET, GRID, AXIS, PAPER = "#24292f", "#6e7781", "#e4e8ec", "#c3cad1", "#ffffff"


def main() -> None:
    """Writes the plot."""
    digest = hashlib.sha256(FIGURES.read_bytes()).hexdigest()
    plt.rcParams.update(
        {
            "font.family": "DejaVu Sans",
            "font.size": 10,
            "svg.fonttype": "path",
            "svg.hashsalt": "pydslrep",
            "text.color": INK,
            "axes.labelcolor": QUIET,
            "axes.edgecolor": AXIS,
            "xtick.color": QUIET,
            "ytick.color": QUIET,
            "figure.facecolor": PAPER,
            "axes.facecolor": PAPER,
        }
    )
    found = comparison.read([FIGURES])
    figure, panels = plt.subplots(2, 2, figsize=(9, 6.6), sharex=True, sharey=True)
    for panel, name in zip(panels.flat, PANELS, strict=True):
        for tool, colour, marker in zip(TOOLS, COLOURS, MARKERS, strict=True):
            known = [size for size in SIZES if Key(name, size, tool) in found]
            if known:
                values = [found[Key(name, size, tool)] for size in known]
                panel.loglog(
                    known, values, color=colour, marker=marker, label=tool, linewidth=2
                )
        panel.set_title(comparison.LABELS[name], loc="left", weight="bold")
        panel.grid(color=GRID)
        panel.set_axisbelow(True)
        panel.spines[["top", "right"]].set_visible(False)
        panel.minorticks_off()
        panel.yaxis.set_major_formatter("{x:g}")
    for panel in panels[1]:
        panel.set_xlabel("lines of the program")
        panel.set_xticks(SIZES, [f"{size:,}".replace(",", " ") for size in SIZES])
    for panel in panels[:, 0]:
        panel.set_ylabel("processor time, ms")
    handles, labels = panels[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="upper center", ncols=len(labels), frameon=False)
    figure.tight_layout(rect=(0, 0, 1, 0.95))
    metadata = {"Date": None, "Description": f"comparison.json: {digest}"}
    figure.savefig(PLOT, metadata=metadata)


if __name__ == "__main__":
    main()
