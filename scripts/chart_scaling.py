#!/usr/bin/env python3
"""Measures how rendering scales with threads and with the picture, and ways to cut it; prints tables in Markdown, draws
docs/scaling.svg and docs/scaling-splits.svg.

usage: chart_scaling.py [--quick] [--scene FILE] [--csv FILE] [--out FOLDER] [PROGRAM]

Renders scenes/cornell-box, or another scene, with PROGRAM (default build/release/parian) by 1, 2, 4 ... and as many
threads as there are cores, bound to as many cores and not, at sides of 10 to 4096 pixels; and on all cores by all
--tiles and --partitioner. Takes 15 minutes on two cores, with --quick two. What others took of the machine meanwhile is
measured: a run that they disturbed is repeated, and where too many stay disturbed nothing is concluded and the exit
status is 1. Writes the numbers to build/charts/scaling.csv and the machine to scaling.txt beside it; with --csv FILE
they are read from there. Needs numpy and matplotlib.
"""

import sys
from pathlib import Path

import machine
from charts import options
from measured import CHARTS, ROOT, read, write
from scaling_charts import draw_splits, draw_threads
from scaling_numbers import (
    CLAIM, SMALL, Estimate, Split, amdahl, count_equal, efficiencies, exponent, sides, speeds, split_costs, threads_of,
)  # fmt: skip
from scaling_runs import FEW, QUICK, Plan, measure


def share(value: Estimate) -> str:
    return f"{100 * value.mean:.1f}% +- {100 * value.error:.1f}%"


def print_threads(rows: list[dict]) -> None:
    print("\n| side | threads | bound | efficiency | busy | work | us per path: one thread, all |\n" + "|---" * 7 + "|")
    for side in sides(rows, "threads"):
        for threads in threads_of(rows)[1:]:
            for pinned in (1, 0):
                e = efficiencies(rows, side, threads, pinned)
                micros = [1e6 * efficiencies(rows, side, n, pinned).cpu_per_path.mean for n in (1, threads)]
                cells = [share(e.wall), share(e.busy), share(e.work), ", ".join(f"{micro:.3f}" for micro in micros)]
                print(f"| {side:.0f} | {threads:.0f} | {'yes' if pinned else 'no'} | " + " | ".join(cells) + " |")
    print("\nEfficiency: wall time of one thread over N times that of N. Busy: CPU over N times wall time; the rest is")
    print("waiting. Work: CPU time of one thread over that of N; the rest is shared memory, and spinning for work.")


def print_splits(rows: list[dict]) -> None:
    costs = split_costs(rows)
    partitioners = list(dict.fromkeys(partitioner for _, partitioner in costs))
    print("\nTime over the fastest, mean of all sides:\n\n| tiles | " + " | ".join(partitioners) + " |")
    print("|---" * (1 + len(partitioners)) + "|")
    for tiles in dict.fromkeys(tiles for tiles, _ in costs):
        cells = [f"+{share(costs[tiles, partitioner])}" for partitioner in partitioners]
        print(f"| {tiles or 'by default'} | " + " | ".join(cells) + " |")
    by_side = {side: split_costs(rows, side) for side in sides(rows, "splits")}
    print("\nBy side, dealt by `simple`:\n\n| tiles | " + " | ".join(f"{side:.0f}" for side in by_side) + " |")
    print("|---" * (1 + len(by_side)) + "|")
    for tiles in dict.fromkeys(tiles for tiles, _ in costs):
        cells = [f"+{share(of_side[tiles, 'simple'])}" for of_side in by_side.values()]
        print(f"| {tiles or 'by default'} | " + " | ".join(cells) + " |")


# --- conclusions ------------------------------------------------------------------------------------------------------


def conclude(rows: list[dict]) -> None:
    print()
    most = max(threads_of(rows))
    for threads in threads_of(rows)[1:]:
        print(claim(rows, threads))
    for pinned in (1, 0):
        serial = amdahl(rows, pinned)
        if serial:
            print(f"- Serial fraction (Amdahl), {bound(pinned)}, sides of {SMALL} and more: {share(serial)}.")
    for threads in dict.fromkeys((1, most)):
        slopes = [exponent(rows, threads, least_side) for least_side in (0, SMALL)]
        powers = [f"{slope.mean:.3f} +- {slope.error:.3f}" for slope in slopes]
        print(
            f"- {threads:.0f} thread{'s'[: threads > 1]}: time grows with the side to the power of {powers[0]}; "
            f"from {SMALL} pixels on, {powers[1]}."
        )
    print("- Tiles, mean of all partitioners: " + ranking(split_costs(rows, by=["tiles"])))
    print("- Partitioners, mean of all tiles: " + ranking(split_costs(rows, by=["partitioner"])))
    for side in sides(rows, "splits"):
        costs = split_costs(rows, side)
        best = min(costs, key=lambda split: costs[split].mean)
        print(
            f"- Side {side:.0f}: fastest with {name(*best)}; {count_equal(costs)} of {len(costs)} are within two "
            f"standard errors of it; default tiles, simple: +{share(costs['', 'simple'])}."
        )


def name(tiles: str, partitioner: str = "") -> str:
    return ", ".join(filter(None, (tiles or "default tiles", partitioner)))


def ranking(costs: dict[Split, Estimate]) -> str:
    ranked = sorted(costs, key=lambda split: costs[split].mean)
    return f"{name(*ranked[0])}; " + ", ".join(f"{name(*split)} +{share(costs[split])}" for split in ranked[1:]) + "."


def bound(pinned: int) -> str:
    return "bound to as many cores" if pinned else "not bound"


def claim(rows: list[dict], threads: float) -> str:
    """From which side on all efficiencies are what is claimed, as they were measured and for sure."""
    words = []
    for pinned in (1, 0):
        waiting = {side: efficiencies(rows, side, threads, pinned).wall for side in sides(rows, "threads")}
        measured = from_side({side: e.mean >= CLAIM for side, e in waiting.items()})
        surely = from_side({side: e.mean - 2 * e.error >= CLAIM for side, e in waiting.items()})
        words.append(f"{bound(pinned)}: {measured} (by two standard errors: {surely})")
    return f"- {threads:.0f} threads have {100 * CLAIM:.0f}% efficiency or more, " + "; ".join(words) + "."


def from_side(holds: dict[float, bool]) -> str:
    """The least side from which on it holds."""
    least = None
    for side in sorted(holds, reverse=True):
        if not holds[side]:
            break
        least = side
    return f"from {least:.0f} pixels on" if least else "at no side from which it lasts"


def main() -> None:
    parser = options(__doc__, "build/release/parian", "docs")
    parser.add_argument("--quick", action="store_true", help="fewer and shorter runs")
    parser.add_argument("--scene", type=Path, default=ROOT / "scenes/cornell-box/cornell-box.gltf")
    arguments = parser.parse_args()
    table: Path = arguments.csv or CHARTS / "scaling.csv"
    if not arguments.csv:
        CHARTS.mkdir(parents=True, exist_ok=True)
        now = machine.run(["sleep", "1"])
        print(f"Others use {100 * now.others / now.wall:.0f}% of a core now.", flush=True)
        table.with_suffix(".txt").write_text(f"{machine.describe()}; {arguments.scene.stem}\n")
        write(table, measure(arguments.program, arguments.scene, QUICK if arguments.quick else Plan()))
    rows = read(table, {"study", "tiles", "partitioner"})
    contended = sum(row["contended"] for row in rows)
    note = table.with_suffix(".txt").read_text().strip() if table.with_suffix(".txt").exists() else ""
    mean = {key: sum(row[key] for row in rows) / len(rows) for key in ("others", "stolen", "load")}
    spoilt = contended > FEW * len(rows)
    print(f"{note}\n{len(rows)} runs, {sum(row['tries'] for row in rows) - len(rows):.0f} more repeated, ", end="")
    print(f"{contended:.0f} contended. On average others took {100 * mean['others']:.1f}% of the cores used ", end="")
    print(f"({100 * mean['stolen']:.1f}% stolen); load average {mean['load']:.2f}.")
    if max(row["repetition"] for row in rows) > 0:
        print(f"CPU time of equal runs varies by {100 * speeds(rows):.1f}% (standard deviation).")
    kept = rows if spoilt else [row for row in rows if not row["contended"]]
    if spoilt:
        print("\n**CONTENDED: others used the machine. The figures below are not to be relied on.**")
    print_threads(kept)
    print_splits(kept)
    draw_threads(kept, arguments.out / "scaling.svg", spoilt)
    draw_splits(kept, arguments.out / "scaling-splits.svg", spoilt)
    if spoilt:
        sys.exit("No conclusion: too many runs were contended. Run it again on a quiet machine.")
    conclude(kept)


if __name__ == "__main__":
    main()
