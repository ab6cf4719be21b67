"""The charts of chart_scaling.py."""

from pathlib import Path
from typing import Any

import numpy

from charts import add_grid, subplots
from scaling_numbers import CLAIM, Estimate, amdahl, efficiencies, exponent, per_sample, sides, split_costs, threads_of

COLORS = ("#1f6fb2", "#d98c00", "#2e8b57", "#c0392b", "#8e5bb5", "#111111")
PARTITIONERS = {"simple": "#1f6fb2", "auto": "#2e8b57", "affinity": "#d98c00", "static": "#c0392b"}


def draw_threads(rows: list[dict], out: Path, contended: bool) -> None:
    figure, ((wall, parts), (speedup, time)) = subplots(2, 2, figsize=(9, 6.6))
    draw_efficiency(wall, rows)
    draw_parts(parts, rows)
    draw_speedup(speedup, rows)
    draw_time(time, rows)
    for axes in (wall, parts, time):
        axes.set_xscale("log")
        axes.minorticks_off()
        ticks = [side for side in sides(rows, "threads") if side not in (105, 200)]
        axes.set_xticks(ticks, [f"{side:.0f}" for side in ticks])
        axes.set_xlabel("side of the picture [pixels]")
    for axes in (wall, parts, speedup, time):
        add_grid(axes)
        axes.legend(frameon=False, fontsize=7)
    finish(figure, out, contended)


def line(axes: Any, x: list[float], y: list[Estimate], factor: float, **style: Any) -> None:
    means, errors = [factor * e.mean for e in y], numpy.nan_to_num([factor * e.error for e in y])
    axes.errorbar(x, means, errors, marker="o", markersize=3, linewidth=1.3, elinewidth=0.8, capsize=2, **style)


def draw_efficiency(axes: Any, rows: list[dict]) -> None:
    x = sides(rows, "threads")
    for threads, color in zip([n for n in threads_of(rows) if n > 1], COLORS):
        for pinned, style in ((1, "-"), (0, ":")):
            y = [efficiencies(rows, side, threads, pinned).wall for side in x]
            label = f"{threads:.0f} threads, {'bound' if pinned else 'not bound'}"
            line(axes, x, y, 100, color=color, linestyle=style, label=label)
    axes.axhline(100 * CLAIM, color="#111111", linewidth=0.8, linestyle="--")
    axes.set_ylabel("efficiency [%]")
    axes.set_title("wall time of one thread over N times that of N", fontsize=8)


def draw_parts(axes: Any, rows: list[dict]) -> None:
    x, threads = sides(rows, "threads"), max(threads_of(rows))
    all_ = [efficiencies(rows, side, threads, 1) for side in x]
    line(axes, x, [e.busy for e in all_], 100, color=COLORS[2], label="busy: CPU over N times wall time")
    line(axes, x, [e.work for e in all_], 100, color=COLORS[4], label="work: CPU time of one thread over that of all")
    axes.set_ylabel("[%]")
    axes.set_title(f"what becomes of the time of {threads:.0f} threads", fontsize=8)


def draw_speedup(axes: Any, rows: list[dict]) -> None:
    counts = threads_of(rows)
    for side, color in zip([s for s in sides(rows, "threads") if s in (10, 57, 105, 200, 512, 2048)], COLORS):
        points = [efficiencies(rows, side, n, 1).wall for n in counts]
        scaled = [Estimate(n * e.mean, n * e.error if n > 1 else 0) for n, e in zip(counts, points)]
        line(axes, counts, scaled, 1, color=color, label=f"{side:.0f} pixels square")
    axes.plot(counts, counts, color="#111111", linewidth=0.8, linestyle="--", label="linear")
    serial = amdahl(rows, 1)
    if serial:
        n = numpy.linspace(1, max(counts), 50)
        s = serial.mean
        axes.plot(n, 1 / (s + (1 - s) / n), color="#888888", linewidth=1, label=f"serial fraction {100 * s:.1f}%")
    axes.set_xticks(counts, [f"{n:.0f}" for n in counts])
    axes.set_xlabel("threads, bound to as many cores")
    axes.set_ylabel("times as fast as one")


def draw_time(axes: Any, rows: list[dict]) -> None:
    x, counts = sides(rows, "threads"), threads_of(rows)
    for threads, color in zip(counts, COLORS):
        y = [per_sample(rows, side, threads) for side in x]
        slope = exponent(rows, threads)
        label = f"{threads:.0f} thread{'s'[: threads > 1]}: side to the power of {slope.mean:.2f}"
        line(axes, x, y, 1000, color=color, label=label)
    axes.set_yscale("log")
    axes.yaxis.set_major_formatter("{x:g}")
    axes.set_ylabel("ms for one sample of each pixel")


def draw_splits(rows: list[dict], out: Path, contended: bool) -> None:
    panels = sides(rows, "splits")
    figure, grid = subplots(1, len(panels), figsize=(10, 3.4), sharey=True, squeeze=False)
    for axes, side in zip(grid[0], panels):
        costs = split_costs(rows, side)
        names = list(dict.fromkeys(tiles for tiles, _ in costs))
        for shift, (partitioner, color) in enumerate(PARTITIONERS.items()):
            mine = [(i, costs[tiles, partitioner]) for i, tiles in enumerate(names) if (tiles, partitioner) in costs]
            x = [i + 0.15 * (shift - 1.5) for i, _ in mine]
            y, errors = [100 * e.mean for _, e in mine], numpy.nan_to_num([100 * e.error for _, e in mine])
            axes.errorbar(x, y, errors, fmt="o", markersize=3.5, elinewidth=0.8, color=color, label=partitioner)
        axes.set_xticks(range(len(names)), [name or "default" for name in names], rotation=90)
        axes.set_title(f"{side:.0f} pixels square", fontsize=8)
        axes.set_xlabel("--tiles")
        axes.set_yscale("symlog", linthresh=10)
        axes.set_yticks([0, 5, 10, 20, 50, 100], ["0", "5%", "10%", "20%", "50%", "100%"])
        axes.set_ylim(bottom=-1)
        add_grid(axes)
    grid[0][0].set_ylabel("time more than the fastest")
    handles, labels = grid[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="upper center", ncol=len(PARTITIONERS), frameon=False)
    finish(figure, out, contended, 0.93)


def finish(figure: Any, out: Path, contended: bool, top: float = 1) -> None:
    if contended:
        figure.text(0.5, 0.5, "CONTENDED", fontsize=60, color="#c0392b", alpha=0.25, ha="center", va="center")
    figure.tight_layout(rect=(0, 0, 1, top))
    figure.savefig(out, metadata={"Date": None, "Creator": None})
    figure.savefig(out.with_suffix(".png"), dpi=110, metadata={"Software": None})
