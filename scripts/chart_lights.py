#!/usr/bin/env python3
"""Measures what ways to choose among many lights cost and leave of noise; prints a table and draws docs/lights.svg.

usage: chart_lights.py [--size N] [--csv FILE] [--out FILE] [PROGRAM]

Runs PROGRAM (default build/release/many_lights), writes what it prints to PROGRAM.csv, prints a table in Markdown, and
draws docs/lights.svg. With --csv FILE nothing is run: the numbers are those of FILE. Needs matplotlib.
"""

import argparse
from pathlib import Path

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt  # noqa: E402

from measured import measure, read  # noqa: E402

ROOT = Path(__file__).resolve().parent.parent
CHOICES = {
    "uniform": ("all alike", "#c0392b", "o"),
    "power": ("by power", "#d98c00", "s"),
    "tree": ("by the tree", "#1f6fb2", "D"),
}


def curve(rows: list[dict], lights: float, choice: str) -> list[dict]:
    return [row for row in rows if row["lights"] == lights and row["choice"] == choice]


def counts(rows: list[dict]) -> list[float]:
    return list(dict.fromkeys(row["lights"] for row in rows))


def print_table(rows: list[dict]) -> None:
    """The error with the most samples, and the CPU time that all points of the floor took together."""
    print("| lights | " + " | ".join(f"{name}: error, CPU s" for name, _, _ in CHOICES.values()) + " |")
    print("|---" * (1 + len(CHOICES)) + "|")
    for lights in counts(rows):
        last = [curve(rows, lights, choice)[-1] for choice in CHOICES]
        cells = " | ".join(f"{100 * row['relative_rmse']:.2g}%, {row['cpu_seconds']:.2g}" for row in last)
        print(f"| {lights:,.0f} | {cells} |")


def draw(rows: list[dict], out: Path) -> None:
    plt.rcParams.update({"font.size": 8, "svg.fonttype": "path", "svg.hashsalt": "lights"})
    columns = counts(rows)
    figure, grid = plt.subplots(1, len(columns), figsize=(10, 3.6), sharey=True, squeeze=False)
    for axes, lights in zip(grid[0], columns):
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.grid(True, which="major", color="#e4e4e4", linewidth=0.6)
        axes.set_axisbelow(True)
        axes.minorticks_off()
        for choice, (label, color, marker) in CHOICES.items():
            points = curve(rows, lights, choice)
            x, y = [p["cpu_seconds"] for p in points], [p["relative_rmse"] for p in points]
            axes.plot(x, y, marker=marker, markersize=4, color=color, label=label, linewidth=1.4)
        axes.set_yticks([0.01, 0.1, 1], ["1%", "10%", "100%"])
        axes.set_title(f"{lights:,.0f} lights", fontsize=10)
        axes.set_xlabel("CPU seconds")
    grid[0][0].set_ylabel("error (RMS, relative)")
    handles, labels = grid[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="upper center", ncol=len(CHOICES), frameon=False)
    figure.tight_layout(rect=(0, 0, 1, 0.93))
    figure.savefig(out, metadata={"Date": None, "Creator": None})


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", nargs="?", type=Path, default=ROOT / "build/release/many_lights")
    parser.add_argument("--size", type=int, help="points along each side of the floor (default: the program's)")
    parser.add_argument("--csv", type=Path, help="use these numbers instead of measuring")
    parser.add_argument("--out", type=Path, default=ROOT / "docs/lights.svg")
    arguments = parser.parse_args()
    rows = read(arguments.csv or measure(arguments.program, arguments.size), {"choice"})
    print_table(rows)
    draw(rows, arguments.out)


if __name__ == "__main__":
    main()
