#!/usr/bin/env python3
"""Measures what ways to choose among many lights leave of noise for their time; prints tables, draws docs/lights.svg.

usage: chart_lights.py [--csv FILE] [--out FILE] [PROGRAM]

Renders the rooms of make_lights.py with PROGRAM (default build/release/parian): 10 to 10,000 lamps, 1 to 256 samples
per pixel, each choice of lights; on one thread. The error is against two references of 512 samples per pixel by the
tree, which are kept in build/charts; their noise does not count. Writes the numbers to build/charts/lights.csv, prints
tables in Markdown, and draws docs/lights.svg. With --csv FILE nothing is rendered: the numbers are those of FILE. Needs
numpy and matplotlib.
"""

from pathlib import Path

from charts import add_grid, options, save, subplots
from make_lights import room
from measured import CHARTS, first_below, percent, read, references, relative_rmse, render, write

COUNTS = (10, 100, 1000, 10000)
SIZE = ["--size", "128x96"]
SAMPLES = [2**i for i in range(9)]
CHOICES = {
    "uniform": ("any alike", "#c0392b", "o"),
    "power": ("by power", "#d98c00", "s"),
    "tree": ("by the tree", "#1f6fb2", "D"),
}


def measure(program: Path) -> Path:
    """The choices alternate, so that a slow minute of the machine meets all of them."""
    CHARTS.mkdir(parents=True, exist_ok=True)
    rows = []
    for count in COUNTS:
        scene = CHARTS / f"many-lights-{count}.gltf"
        room(count).write(CHARTS, scene.stem)
        truth = references(program, scene, [*SIZE, "--spp", "512"])
        for spp in SAMPLES:
            for choice in CHOICES:
                options = [*SIZE, "--spp", str(spp), "--light-choice", choice, "--threads", "1"]
                picture, stats = render(program, scene, options, CHARTS / "lights")
                row = {"lights": count, "choice": choice, "spp": spp, "cpu_seconds": stats["render_cpu_seconds"]}
                rows.append(row | {"relative_rmse": relative_rmse(picture, truth)})
    return write(CHARTS / "lights.csv", rows)


def curve(rows: list[dict], lights: float, choice: str) -> list[dict]:
    return [row for row in rows if row["lights"] == lights and row["choice"] == choice]


def counts(rows: list[dict]) -> list[float]:
    return list(dict.fromkeys(row["lights"] for row in rows))


def seconds_to(points: list[dict], error: float) -> float:
    """The CPU time to an error."""
    return first_below([p["cpu_seconds"] for p in points], [p["relative_rmse"] for p in points], error)


def print_tables(rows: list[dict]) -> None:
    print("| lights | error | " + " | ".join(f"{name}: CPU s" for name, _, _ in CHOICES.values()) + " |")
    print("|---" * (2 + len(CHOICES)) + "|")
    for lights in counts(rows):
        # The least error that every choice reaches.
        error = max(curve(rows, lights, choice)[-1]["relative_rmse"] for choice in CHOICES)
        cells = " | ".join(f"{seconds_to(curve(rows, lights, choice), error):.2g}" for choice in CHOICES)
        print(f"| {lights:,.0f} | {percent(error)} | {cells} |")
    samples = sorted({row["spp"] for row in rows})
    few, some, many = samples[0], samples[len(samples) // 2], samples[-1]
    names = " | ".join(name for name, _, _ in CHOICES.values())
    print(f"\n| lights | error with {few:.0f}, {some:.0f}, {many:.0f} samples: {names} |")
    print("|---" * (1 + len(CHOICES)) + "|")
    for lights in counts(rows):
        curves = [curve(rows, lights, choice) for choice in CHOICES]
        errors = [[points[i]["relative_rmse"] for i in (0, len(points) // 2, -1)] for points in curves]
        cells = " | ".join(", ".join(percent(error) for error in three) for three in errors)
        print(f"| {lights:,.0f} | {cells} |")


def draw(rows: list[dict], out: Path) -> None:
    columns = counts(rows)
    figure, grid = subplots(1, len(columns), figsize=(10, 3.4), sharex=True, sharey=True, squeeze=False)
    for axes, lights in zip(grid[0], columns):
        axes.set_xscale("log")
        axes.set_yscale("log")
        add_grid(axes)
        axes.minorticks_off()
        for choice, (label, color, marker) in CHOICES.items():
            points = curve(rows, lights, choice)
            x, y = [p["cpu_seconds"] for p in points], [p["relative_rmse"] for p in points]
            axes.plot(x, y, marker=marker, markersize=4, color=color, label=label, linewidth=1.4)
        axes.set_xticks([0.1, 1, 10], ["0.1", "1", "10"])
        axes.set_yticks([0.03, 0.1, 0.3, 1, 3, 10], ["3%", "10%", "30%", "100%", "300%", "1000%"])
        axes.set_title(f"{lights:,.0f} lights", fontsize=10)
        axes.set_xlabel("CPU seconds")
    grid[0][0].set_ylabel("error (RMS, relative)")
    save(figure, out, len(CHOICES))


def main() -> None:
    arguments = options(__doc__, "build/release/parian", "docs/lights.svg").parse_args()
    rows = read(arguments.csv or measure(arguments.program), {"choice"})
    print_tables(rows)
    draw(rows, arguments.out)


if __name__ == "__main__":
    main()
