#!/usr/bin/env python3
"""Counts what each feature costs a scene that has it but does not use it, and one that does; prints tables in Markdown,
draws docs/features.svg.

usage: chart_features.py [--csv FOLDER] [--out FILE] [PROGRAM]

A closed room with two blocks (feature_scenes.py), rendered by PROGRAM (default build/release/parian) under valgrind:
instructions for each camera path, loading left out. Each feature is in the file where no path comes by, and then on the
blocks. The static libraries beside PROGRAM say which source file a function is from. Takes 20 minutes; what else runs
does not matter. Writes the numbers to build/charts/features.csv and features-sources.csv; with --csv FOLDER they are
read from there. Needs valgrind and matplotlib.
"""

import json
import math
import tempfile
from pathlib import Path
from typing import Any, Optional, Sequence

from callgrind import Cost, by_source, count_per_path
from charts import add_grid, options, save, subplots
from feature_scenes import base, blocks, features, plaster, room
from gltf_builder import Gltf
from measured import CHARTS, read, write

PLAIN = "plain room"
RENDERING = ("accel", "film", "integrators", "light", "materials", "session", "shapes")  # layers that paths come by
LITTLE = 1  # instruction for each camera path
NONE = Cost({"": math.nan}, math.nan)
MOST = 0.02  # of the plain room's instructions that a feature may cost where it is not used


class Counts:
    """Of scenes that are counted once each."""

    def __init__(self, program: Path) -> None:
        self.program = program
        self.known: dict[tuple, Cost] = {}

    def of(self, scene: Gltf, settings: Sequence[str] = ()) -> Cost:
        key = (json.dumps(scene.document("")), bytes(scene.binary), tuple(scene.files.items()), tuple(settings))
        if key not in self.known:
            with tempfile.TemporaryDirectory() as folder:
                scene.write(Path(folder), "room")
                self.known[key] = count_per_path(self.program, Path(folder) / "room.gltf", settings)
        return self.known[key]


def measure(program: Path) -> Path:
    CHARTS.mkdir(parents=True, exist_ok=True)
    counts = Counts(program)
    rows, sources = [], source_rows(PLAIN, counts.of(base()), program)
    for feature in features():
        present = room(blocks(plaster), feature.outside) if feature.outside else None
        costs = {
            "plain": counts.of(base()),
            "present": counts.of(present) if present else NONE,
            "without": counts.of(feature.without or base()),
            "used": counts.of(feature.used, feature.options) if feature.used else NONE,
        }
        numbers = {name: cost.total() for name, cost in costs.items()}
        rays = {f"{name}_rays": costs[name].rays for name in ("without", "used")}
        rows.append({"feature": feature.name, **numbers, **rays})
        print(feature.name, *(f"{value:.0f}" for value in numbers.values()), flush=True)
        if present:
            sources += source_rows(feature.name, costs["present"], program)
    write(CHARTS / "features.csv", rows)
    write(CHARTS / "features-sources.csv", sources)
    return CHARTS


def source_rows(feature: str, cost: Cost, program: Path) -> list[dict]:
    counts = by_source(cost.instructions, program)
    return [{"feature": feature, "source": name, "instructions": count} for name, count in counts.items()]


# --- what it says -----------------------------------------------------------------------------------------------------


def presence(row: dict) -> float:
    """What being in the file costs, of the plain room's instructions."""
    return row["present"] / row["plain"] - 1


def print_features(rows: list[dict]) -> None:
    print(f"\nThe plain room takes {rows[0]['plain']:,.0f} instructions for each camera path.\n")
    print("| feature | in the file, not used | used: without it | with it | times | rays, times |\n" + "|---" * 6 + "|")
    for row in rows:
        present = "" if math.isnan(row["present"]) else f"{100 * presence(row):+.2f}%"
        times = f"{row['used'] / row['without']:.2f} | {row['used_rays'] / row['without_rays']:.2f}"
        used = f"{row['without']:,.0f} | {row['used']:,.0f} | {times}"
        print(f"| {row['feature']} | {present} | {' | | | ' if math.isnan(row['used']) else used} |")
    print(f"\nMore than {100 * MOST:g}% where nothing uses it: {', '.join(dear(rows)) or 'none'}.")


def dear(rows: list[dict]) -> list[str]:
    return [row["feature"] for row in rows if presence(row) > MOST]


def distinct(rows: list[dict], names: list[str]) -> list[str]:
    """Of features that cost the same, as all materials of one medium do, the first."""
    first: dict[float, str] = {}
    for row in rows:
        if row["feature"] in names:
            first.setdefault(row["present"], row["feature"])
    return list(first.values())


def print_sources(rows: list[dict], dear: list[str]) -> None:
    """What the plain room takes by file, and what these features add to it where they are in the file, not used."""
    by_feature: dict[str, dict[str, float]] = {}
    for row in rows:
        by_feature.setdefault(row["feature"], {})[row["source"]] = row["instructions"]
    plain = by_feature[PLAIN]
    more = {name: by_feature[name] for name in dear}
    print("\n| source | plain room | " + " | ".join(more) + " |\n|---|---" + "|---" * len(more) + "|")
    for source in dict.fromkeys(row["source"] for row in rows):
        cells = [counts.get(source, 0) - plain.get(source, 0) for counts in more.values()]
        if max([plain.get(source, 0), *map(abs, cells)]) >= LITTLE:
            words = [f"{cell:+,.0f}" if abs(cell) >= LITTLE else "" for cell in cells]
            print(f"| {source} | {plain.get(source, 0):,.0f} | " + " | ".join(words) + " |")
    idle = sorted(source for source, count in plain.items() if count == 0 and source.split("/")[0] in RENDERING)
    print(f"\nNothing in the plain room: {', '.join(idle)}.")


def draw(rows: list[dict], out: Path) -> None:
    figure, (left, right) = subplots(1, 2, figsize=(9, 6), sharey=True)
    places = range(len(rows), 0, -1)
    for place, row in zip(places, rows):
        if not math.isnan(row["present"]):
            bar(left, place, 0, 100 * presence(row), f"{100 * presence(row):+.2f}%", "#1f6fb2")
        if not math.isnan(row["used"]):
            times = row["used"] / row["without"]
            bar(right, place, 1, times, f"{times:.2f}", "#d98c00")
    left.set_yticks(list(places), [row["feature"] for row in rows])
    left.margins(x=0.25)
    left.set_ylim(0.3, len(rows) + 0.7)
    left.set_title("in the file, and no path meets it", fontsize=8)
    left.set_xlabel("instructions more [%]")
    right.set_xscale("log")
    right.minorticks_off()
    right.set_xticks([0.5, 1, 2, 5, 10, 20], ["0.5", "1", "2", "5", "10", "20"])
    right.margins(x=0.15)
    right.set_title("used", fontsize=8)
    right.set_xlabel("times the instructions without it")
    for axes in (left, right):
        add_grid(axes)
    save(figure, out, 1, 1, png=True)


def bar(axes: Any, place: int, start: float, end: float, label: str, color: str) -> None:
    axes.barh(place, end - start, left=start, height=0.7, color=color)
    axes.annotate(label, (max(start, end), place), (3, 0), textcoords="offset points", va="center", fontsize=7)


def main() -> None:
    arguments = options(__doc__, "build/release/parian", "docs/features.svg").parse_args()
    kept: Optional[Path] = arguments.csv
    folder = kept or measure(arguments.program)
    rows = read(folder / "features.csv", {"feature"})
    print_features(rows)
    print_sources(read(folder / "features-sources.csv", {"feature", "source"}), distinct(rows, dear(rows)))
    draw(rows, arguments.out)


if __name__ == "__main__":
    main()
