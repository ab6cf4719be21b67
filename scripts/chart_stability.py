#!/usr/bin/env python3
"""Measures how well rays meet solids from far away; prints the table and draws the chart of docs/stability.md.

usage: chart_stability.py [--rays N] [--csv FILE] [PROGRAM]

Runs PROGRAM (default build/release/shape_stability), writes what it prints to PROGRAM.csv, prints tables in Markdown,
and draws docs/stability.svg. With --csv FILE nothing is run: the numbers are those of FILE. Needs matplotlib.
"""

from decimal import Decimal
from pathlib import Path

from charts import add_grid, options, save, subplots
from measured import measure, percent, read

ROOT = Path(__file__).resolve().parent.parent
METHODS = {
    "naive": ("naive, float32", "#c0392b", "o"),
    "robust": ("robust, float32", "#d98c00", "s"),
    "parian": ("Parian, function", "#1f6fb2", "D"),
    "traced": ("Parian, traced", "#3c9d4e", "^"),
}
# The error bound that Parian reports is 12 unit roundoffs of the point's largest coordinate, which lies between these.
BOUND = (12 * 2**-24 / 3**0.5, 12 * 2**-24)


def length(value: float) -> str:
    return f"{Decimal(f'{value:.0e}'):f}" if value >= 0.01 else f"{value:.0e}".replace("e-0", "e-")


def print_tables(rows: list[dict]) -> None:
    left_out = sum(row["left_out"] for row in rows if row["method"] == "naive")
    print(f"{rows[0]['rays']:.0f} rays for each solid and distance; left out: {left_out:.0f}.\n")
    by_key = {(row["shape"], row["ratio"], row["method"]): row for row in rows}
    for title, cell in (
        ("wrong hit or miss", lambda row: percent(row["wrong_share"])),
        ("position error: largest (mean)", lambda row: f"{length(row['max_error'])} ({length(row['mean_error'])})"),
        ("hits beyond the reported bound", lambda row: percent(row["beyond_bound_share"])),
    ):
        print(f"| {title} | d/R | " + " | ".join(name for name, _, _ in METHODS.values()) + " |")
        print("|---" * (2 + len(METHODS)) + "|")
        for shape, ratio in dict.fromkeys((row["shape"], row["ratio"]) for row in rows):
            cells = " | ".join(cell(by_key[shape, ratio, method]) for method in METHODS)
            print(f"| {shape} | {ratio:g} | {cells} |")
        print()


def curve(rows: list[dict], shape: str, method: str, key: str) -> tuple[list[float], list[float]]:
    points = [(r["ratio"], r[key]) for r in rows if r["shape"] == shape and r["method"] == method]
    return [x for x, _ in points], [y for _, y in points]


def draw_wrong(axes, rows: list[dict], shape: str) -> None:
    """None wrong has no logarithm: it is drawn on a line of its own, below one ray of all."""
    rays = rows[0]["rays"]
    none = 0.2 / rays
    # Curves of zeros would hide each other: they are set apart a little.
    for i, (method, (label, color, marker)) in enumerate(METHODS.items()):
        x, y = curve(rows, shape, method, "wrong_share")
        y = [v if v > 0 else none * 1.45 ** (1.5 - i) for v in y]
        axes.plot(x, y, marker=marker, markersize=4, color=color, label=label, linewidth=1.4)
    axes.set_ylim(none / 2.5, 1.5)
    axes.axhline(none * 2.2, color="#999999", linewidth=0.6)
    ticks = [10.0**e for e in range(-7, 1) if 10.0**e >= 1 / rays]
    axes.set_yticks([none] + ticks, ["none"] + [percent(t) for t in ticks])


def draw_error(axes, rows: list[dict], shape: str) -> None:
    axes.axhspan(*BOUND, color="#bbbbbb", alpha=0.6, linewidth=0)
    for method, (_, color, marker) in METHODS.items():
        if method == "traced":
            continue
        axes.plot(*curve(rows, shape, method, "max_error"), marker=marker, markersize=4, color=color, linewidth=1.4)
        axes.plot(*curve(rows, shape, method, "mean_error"), linestyle=":", color=color, linewidth=1.4)
    axes.text(1.3e5, BOUND[1] * 1.3, "bound that Parian reports", ha="right", va="bottom", fontsize=7, color="#555555")
    axes.set_ylim(5e-9, 2e2)


def draw(rows: list[dict], out: Path) -> None:
    shapes = list(dict.fromkeys(row["shape"] for row in rows))
    figure, grid = subplots(2, len(shapes), figsize=(10, 6), sharex=True, sharey="row")
    for column, shape in enumerate(shapes):
        for axes, plot in zip(grid[:, column], (draw_wrong, draw_error)):
            axes.set_xscale("log")
            axes.set_yscale("log")
            add_grid(axes)
            axes.minorticks_off()
            plot(axes, rows, shape)
        grid[0, column].set_title(shape, fontsize=10)
        grid[1, column].set_xlabel("distance d / R")
    grid[0, 0].set_ylabel("wrong hit or miss")
    grid[1, 0].set_ylabel("position error / R: largest; dotted: mean")
    save(figure, out, len(METHODS), 0.96)


def main() -> None:
    parser = options(__doc__, "build/release/shape_stability", "docs/stability.svg")
    parser.add_argument("--rays", type=int, help="for each solid and distance (default: the program's)")
    arguments = parser.parse_args()
    rows = read(arguments.csv or measure(arguments.program, arguments.rays), {"shape", "method"})
    print_tables(rows)
    draw(rows, arguments.out)


if __name__ == "__main__":
    main()
