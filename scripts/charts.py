"""How the chart scripts are called, and what their charts look like."""

import argparse
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt  # noqa: E402

from measured import ROOT  # noqa: E402


def options(description: str, program: str, out: str) -> argparse.ArgumentParser:
    """The program that is measured, numbers to use instead, and the chart to draw; defaults are relative to the root."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", nargs="?", type=Path, default=ROOT / program)
    parser.add_argument("--csv", type=Path, help="use these numbers instead of measuring")
    parser.add_argument("--out", type=Path, default=ROOT / out)
    return parser


def subplots(*counts: int, **more: Any) -> tuple[Any, Any]:
    """Matplotlib's figure and axes, in the style of all charts; the same bytes every time."""
    plt.rcParams.update({"font.size": 8, "svg.fonttype": "path", "svg.hashsalt": "parian"})
    return plt.subplots(*counts, **more)


def add_grid(axes: Any) -> None:
    axes.grid(True, which="major", color="#e4e4e4", linewidth=0.6)
    axes.set_axisbelow(True)


def save(figure: Any, out: Path, columns: int, top: float = 0.93, png: bool = False) -> None:
    """Writes the figure, the legend of its first axes above it in so many columns; as a PNG too, beside it, where that
    is asked for."""
    handles, labels = figure.axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="upper center", ncol=columns, frameon=False)
    figure.tight_layout(rect=(0, 0, 1, top))
    figure.savefig(out, metadata={"Date": None, "Creator": None})
    if png:
        figure.savefig(out.with_suffix(".png"), dpi=110, metadata={"Software": None})
