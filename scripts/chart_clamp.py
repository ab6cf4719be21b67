#!/usr/bin/env python3
"""Measures what --clamp costs: the bias of the picture's mean and the error; prints a table, draws docs/clamp.svg.

usage: chart_clamp.py [--csv FILE] [--out FILE] [PROGRAM]

Renders three scenes with PROGRAM (default build/release/parian) at 64 samples per pixel, for each value of --clamp with
eight seeds: a room with a glass ball under a small bright lamp, whose caustics are fireflies; the same with a ball of
plaster, which has none; and the Cornell box, whose lamp is in view. Both mean and error are against two references
without a clamp, which are kept in build/charts. Writes the numbers to build/charts/clamp.csv, prints a table in
Markdown, and draws docs/clamp.svg. With --csv FILE nothing is rendered: the numbers are those of FILE. Needs numpy and
matplotlib.
"""

import math
from pathlib import Path

import numpy

from charts import add_grid, options, save, subplots
from gltf_builder import Gltf
from gltf_shapes import merge, quad
from measured import CHARTS, ROOT, percent, read, references, relative_rmse, render, write

CLAMPS = (0.5, 1, 2, 5, 10, 30, 100, math.inf)
SEEDS = 8
SCENES = {
    "glass-ball": ("a glass ball under a small lamp", "#c0392b", "o"),
    "plaster-ball": ("a plaster ball instead", "#3c9d4e", "^"),
    "cornell-box": ("the Cornell box, its lamp in view", "#1f6fb2", "D"),
}


def ball_room(glass: bool) -> Gltf:
    """A room of 2 m with a ball on its floor, lit by a lamp of .1 x .1 m that shines downwards and is not in view:
    through glass, paths find it by chance alone."""
    scene = Gltf()
    walls = {
        "white": [((0, 0, 0), (1, 0, 0), (0, 0, -1)), ((0, 2, 0), (1, 0, 0), (0, 0, 1)),
                  ((0, 1, -1), (1, 0, 0), (0, 1, 0)), ((0, 1, 1), (-1, 0, 0), (0, 1, 0))],
        "red": [((-1, 1, 0), (0, 0, -1), (0, 1, 0))],
        "blue": [((1, 1, 0), (0, 0, 1), (0, 1, 0))],
    }  # fmt: skip
    colors = {"white": (0.7, 0.7, 0.7), "red": (0.65, 0.2, 0.15), "blue": (0.2, 0.3, 0.6)}
    for name, quads in walls.items():
        sides = merge(quad(*sizes) for sizes in quads).without("uvs")
        scene.add_object(name, sides, scene.add_lambert(name, colors[name]))
    if glass:
        clear, solid = {"transmissionFactor": 1}, {"thicknessFactor": 1}
        extensions = {"KHR_materials_transmission": clear, "KHR_materials_volume": solid}
        material = scene.add_material("glass", roughness=0, extensions=extensions)
    else:
        material = scene.add_lambert("plaster", (0.8, 0.8, 0.8))
    scene.add_shape_node("ball", scene.add_shape("sphere", radius=0.35), material, translation=(0.1, 0.35, -0.4))
    lamp = quad((0, 1.99, 0), (0.05, 0, 0), (0, 0, 0.05)).without("uvs")
    scene.add_object("lamp", lamp, scene.add_lambert("lamp", (0, 0, 0), emission=(250, 230, 200)))
    scene.add_camera((0, 1.1, 0.95), (0, 0.6, -0.6), yfov_degrees=58, aspect=4 / 3)
    return scene


def measure_scene(program: Path, scene: Path, size: str, most: str) -> list[dict]:
    """Rows for each clamp; the references have `most` samples."""
    truth = references(program, scene, ["--size", size, "--spp", most])
    mean = (truth[0].mean() + truth[1].mean()) / 2
    rows = []
    for clamp in CLAMPS:
        biases, errors = [], []
        for seed in range(SEEDS):
            options = ["--size", size, "--spp", "64", "--seed", str(seed)]
            options += ["--clamp", str(clamp)] if clamp < math.inf else []
            picture, _ = render(program, scene, options, CHARTS / "clamp")
            biases.append(picture.mean() / mean - 1)
            errors.append(relative_rmse(picture, truth))
        spread = numpy.std(biases, ddof=1) / math.sqrt(SEEDS)
        # Half of what the references differ is the standard error of their mean, as well as two values can tell it.
        own = abs(truth[0].mean() - truth[1].mean()) / (2 * mean)
        row = {"scene": scene.stem, "clamp": clamp, "bias": numpy.mean(biases), "bias_error": math.hypot(spread, own)}
        rows.append(row | {"relative_rmse": math.sqrt(numpy.mean(numpy.square(errors)))})
    return rows


def measure(program: Path) -> Path:
    CHARTS.mkdir(parents=True, exist_ok=True)
    rows = []
    for name, most in (("glass-ball", "8192"), ("plaster-ball", "2048")):
        ball_room(glass=name == "glass-ball").write(CHARTS, name)
        rows += measure_scene(program, CHARTS / f"{name}.gltf", "64x48", most)
    rows += measure_scene(program, ROOT / "scenes/cornell-box/cornell-box.gltf", "64x64", "2048")
    return write(CHARTS / "clamp.csv", rows)


def label(clamp: float) -> str:
    return f"{clamp:g}" if clamp < math.inf else "none"


def print_table(rows: list[dict]) -> None:
    print("| `--clamp` | " + " | ".join(f"{SCENES[name][0]}: bias, error" for name in SCENES) + " |")
    print("|---" * (1 + len(SCENES)) + "|")
    for clamp in CLAMPS:
        cells = [
            f"{percent(row['bias'])} +- {percent(row['bias_error'])}, {percent(row['relative_rmse'])}"
            for row in rows
            if row["clamp"] == clamp
        ]
        print(f"| {label(clamp)} | " + " | ".join(cells) + " |")


def draw(rows: list[dict], out: Path) -> None:
    figure, (left, right) = subplots(1, 2, figsize=(10, 3.4))
    places = range(len(CLAMPS))
    for name, (text, color, marker) in SCENES.items():
        points = [row for row in rows if row["scene"] == name]
        bias, error = [100 * row["bias"] for row in points], [100 * row["bias_error"] for row in points]
        style = {"marker": marker, "markersize": 4, "color": color, "linewidth": 1.4, "label": text}
        left.errorbar(places, bias, yerr=error, capsize=2, elinewidth=0.8, **style)
        right.plot(places, [row["relative_rmse"] for row in points], **style)
    for axes in (left, right):
        axes.set_xticks(places, [label(clamp) for clamp in CLAMPS])
        axes.set_xlabel("--clamp")
        add_grid(axes)
    left.set_ylabel("bias of the mean, %")
    left.set_yscale("symlog", linthresh=1)
    left.set_ylim(-90, 1)
    left.set_yticks([0, -1, -3, -10, -30], ["0", "-1", "-3", "-10", "-30"])
    left.axhline(0, color="#999999", linewidth=0.6)
    right.set_yscale("log")
    right.set_ylabel("error (RMS, relative)")
    right.set_yticks([0.03, 0.1, 0.3, 1, 3], ["3%", "10%", "30%", "100%", "300%"])
    right.minorticks_off()
    save(figure, out, len(SCENES))


def main() -> None:
    arguments = options(__doc__, "build/release/parian", "docs/clamp.svg").parse_args()
    rows = read(arguments.csv or measure(arguments.program), {"scene"})
    print_table(rows)
    draw(rows, arguments.out)


if __name__ == "__main__":
    main()
