#!/usr/bin/env python3
"""Measures the error over CPU time of what can be chosen; prints tables, draws docs/accuracy-GROUP.svg and .png.

usage: chart_accuracy.py [--only GROUP,...] [--scenes NAME,...] [--again] [--csv FOLDER] [--out FOLDER] [PROGRAM]

Groups are strategy, sampler, light-choice, sss, clamp and noise (adaptive sampling), each on those of scenes/ where it
says something. Renders with PROGRAM (default build/release/parian) small pictures on one thread, with more and more
samples per pixel, four seeds each, against two references of many samples, which are kept in build/charts; their noise
does not count. Writes the numbers to build/charts/accuracy-GROUP.csv after every picture, and does not measure again
what is there from the same program, scene and options, unless --again is given: so it may be interrupted. With
--csv FOLDER nothing is rendered: the numbers are those of FOLDER. Tables are in Markdown. Needs numpy and matplotlib.

Two measures: the root mean square error over the mean of the picture ("RMS"), and the root of the mean of each pixel's
square error over the square of its own value, plus .01 ("pixels"). Factors are at equal CPU time or at equal error,
their standard errors by leaving out each seed in turn.
"""

import hashlib
from pathlib import Path
from typing import Any, Sequence

from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from accuracy_groups import GROUPS, Group, Point, plan, study
from accuracy_tables import MEASURES, curve, print_group
from charts import add_grid, options, save, subplots
from measured import CHARTS, ROOT, pixel_relative_mse, read, references, relative_mse, render, write

# --- measuring --------------------------------------------------------------------------------------------------------


def digest(program: Path, scene: Path) -> bytes:
    """Of the program and all that the scene is made of."""
    files = [program, *sorted(scene.parent.iterdir())]
    return hashlib.sha256(b"".join(file.read_bytes() for file in files if file.name != "expected.json")).digest()


def measure(program: Path, group: str, scenes: Sequence[str], again: bool) -> None:
    CHARTS.mkdir(parents=True, exist_ok=True)
    table = CHARTS / f"accuracy-{group}.csv"
    rows = read_table(table) if table.exists() else {}
    for name in scenes:
        scene, how = ROOT / f"scenes/{name}/{name}.gltf", study(group, name)
        source = digest(program, scene)
        common = ["--size", how.size, "--threads", "1", *how.common]
        truth = references(program, scene, [*common, "--spp", str(how.reference), *how.truth])
        for point, chosen in plan(group, name):
            settings = [*common, *chosen, "--seed", str(point.seed)]
            key = hashlib.sha256(source + repr(settings).encode()).hexdigest()[:16]
            if not again and rows.get(point, {}).get("key") == key:
                continue
            picture, stats = render(program, scene, settings, CHARTS / f"accuracy-{group}")
            row: dict[str, Any] = point._asdict()
            row["samples"] = 3 * stats["rays"]["camera"] / picture.size
            row["cpu_seconds"] = stats["render_cpu_seconds"]
            row["mse"], row["pixel_mse"] = relative_mse(picture, truth), pixel_relative_mse(picture, truth)
            row["bias"] = 2 * picture.mean() / (truth[0].mean() + truth[1].mean()) - 1
            rows[point] = row | {"key": key}
            write(table.with_suffix(".tmp"), list(rows.values())).replace(table)


def read_table(path: Path) -> dict[Point, dict]:
    rows = read(path, {"scene", "choice", "key"})
    return {Point(row["scene"], row["choice"], row["step"], int(row["seed"])): row for row in rows}


def finished(group: str, rows: dict[Point, dict]) -> dict[str, list[dict]]:
    """The rows of each scene of which none is missing, as some are where measuring was interrupted."""
    points = {scene: [point for point, _ in plan(group, scene)] for scene in GROUPS[group].scenes}
    return {scene: [rows[point] for point in mine] for scene, mine in points.items() if rows.keys() >= set(mine)}


# --- the chart --------------------------------------------------------------------------------------------------------


def draw(group: Group, by_scene: dict[str, list[dict]], out: Path) -> None:
    columns = min(4, len(by_scene))
    lines = -(-len(by_scene) // columns)
    figure, grid = subplots(lines, columns, figsize=(max(2.6 * columns, 7), 2.3 * lines + 0.4), squeeze=False)
    for axes in grid.flat[len(by_scene) :]:
        axes.set_visible(False)
    default = next(iter(group.colors))
    for axes, (scene, rows) in zip(grid.flat, by_scene.items()):
        seeds = {row["seed"] for row in rows}
        for choice, color in group.colors.items():
            width = 2.4 if choice == default else 1.2  # seen below one that lies on it
            points, dots = (curve(rows, choice, key, seeds) for key in MEASURES)
            axes.plot(points.cpu_seconds, points.errors, "o-", markersize=3, linewidth=width, color=color, label=choice)
            axes.plot(dots.cpu_seconds, dots.errors, ":", linewidth=0.6 + width / 2, color=color)
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_title(scene, fontsize=9)
        axes.xaxis.set_major_locator(LogLocator(numticks=12))
        axes.xaxis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:g}"))
        least, most = axes.get_ylim()
        axes.yaxis.set_major_locator(LogLocator(subs=(1, 3) if most < 300 * least else (1,), numticks=12))
        axes.yaxis.set_major_formatter(FuncFormatter(lambda y, _: f"{100 * y:g}%"))
        axes.yaxis.set_minor_formatter(NullFormatter())
        axes.minorticks_off()
        add_grid(axes)
    for axes in grid[:, 0]:
        axes.set_ylabel("error: RMS (line), of pixels (dots)")
    for axes in grid.flat[max(0, len(by_scene) - columns) : len(by_scene)]:
        axes.set_xlabel("CPU seconds")
    save(figure, out, len(group.colors), 1 - 0.3 / figure.get_figheight(), png=True)


def main() -> None:
    parser = options(__doc__, "build/release/parian", "docs")
    parser.add_argument("--only", default=",".join(GROUPS), help="groups, separated by commas")
    parser.add_argument("--scenes", help="scenes to measure, separated by commas; all of the groups by default")
    parser.add_argument("--again", action="store_true", help="measure also what has been measured")
    arguments = parser.parse_args()
    names = arguments.only.split(",")
    if unknown := set(names) - GROUPS.keys():
        parser.error(f"--only {','.join(unknown)}: the groups are {', '.join(GROUPS)}")
    known = {scene for name in names for scene in GROUPS[name].scenes}
    wanted = set(arguments.scenes.split(",")) if arguments.scenes else known
    if unknown := wanted - known:
        parser.error(f"--scenes {','.join(unknown)}: the scenes are {', '.join(sorted(known))}")
    for name in names:
        group = GROUPS[name]
        if not arguments.csv:
            measure(arguments.program, name, [scene for scene in group.scenes if scene in wanted], arguments.again)
        by_scene = finished(name, read_table((arguments.csv or CHARTS) / f"accuracy-{name}.csv"))
        print_group(name, group, by_scene)
        draw(group, by_scene, arguments.out / f"accuracy-{name}.svg")


if __name__ == "__main__":
    main()
