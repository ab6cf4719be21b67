#!/usr/bin/env python3
"""Measures what --ggx compensated gains and costs; prints tables in Markdown, draws docs/ggx.svg.

usage: chart_ggx.py [--csv FILE] [--out FILE] [PROGRAM]

Gain: a white ball in a white furnace, of each kind and roughness, rendered with PROGRAM (default build/release/parian)
both ways; the mean of the middle of its picture, which is 1 where nothing is lost. Cost: CPU time of scenes both ways, by
turns, the smallest of seven. Writes the gains to build/charts/ggx.csv. With --csv FILE nothing is rendered, and costs are
left out. Needs numpy and matplotlib.
"""

from pathlib import Path
from typing import Any

from charts import add_grid, options, save, subplots
from gltf_builder import Gltf
from image_files import environment_hdr
from measured import CHARTS, ROOT, read, render, write

ROUGHNESS = [0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1]
MODES = ("single", "compensated")
GLASS = {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 1.5}}
KINDS: dict[str, tuple[str, dict[str, Any]]] = {
    "metal": ("#c0392b", {"metallic": 1}),
    "dielectric": ("#7a7a7a", {}),
    "thin glass": ("#d98c00", {"extensions": GLASS}),
    "solid glass": ("#1f6fb2", {"extensions": {**GLASS, "KHR_materials_volume": {"thicknessFactor": 1}}}),
}
COSTS = ("veach-mis", "textured", "environment-sun", "glass-still-life", "cornell-box")


def furnace(kind: str, roughness: float) -> Gltf:
    scene = Gltf()
    white = scene.add_material(kind, roughness=roughness, **KINDS[kind][1])
    scene.add_shape_node("ball", scene.add_shape("sphere", radius=1), white)
    scene.set_environment(scene.add_image("white.hdr", environment_hdr(8, 4, lambda w: (1.0, 1.0, 1.0))))
    scene.add_orthographic_camera((0, 0, 3), (0, 0, 0, 1), 0.7, 0.7)
    return scene


def measure(program: Path) -> Path:
    CHARTS.mkdir(parents=True, exist_ok=True)
    rows = []
    for kind in KINDS:
        for roughness in ROUGHNESS:
            furnace(kind, roughness).write(CHARTS, "furnace")
            row = {"kind": kind, "roughness": roughness}
            for mode in MODES:
                options = ["--size", "32x32", "--spp", "256", "--ggx", mode]
                row[mode] = render(program, CHARTS / "furnace.gltf", options, CHARTS / "ggx")[0].mean()
            rows.append(row)
    return write(CHARTS / "ggx.csv", rows)


def print_costs(program: Path) -> None:
    print("| scene | single, CPU s | compensated | ratio |\n|---|---|---|---|")
    for name in COSTS:
        seconds: dict[str, list[float]] = {mode: [] for mode in MODES}
        for _ in range(7):
            for mode in MODES:
                options = ["--size", "192x128", "--spp", "16", "--threads", "1", "--ggx", mode]
                stats = render(program, ROOT / f"scenes/{name}/{name}.gltf", options, CHARTS / "ggx")[1]
                seconds[mode].append(stats["render_cpu_seconds"])
        single, compensated = (min(seconds[mode]) for mode in MODES)
        print(f"| {name} | {single:.3f} | {compensated:.3f} | {compensated / single:.3f} |")


def print_gains(rows: list[dict]) -> None:
    print("\n| roughness | " + " | ".join(KINDS) + " |\n" + "|---" * (len(KINDS) + 1) + "|")
    for roughness in ROUGHNESS:
        cells = [next(r for r in rows if r["kind"] == kind and r["roughness"] == roughness) for kind in KINDS]
        print(f"| {roughness:g} | " + " | ".join(f"{c['single']:.3f}, {c['compensated']:.3f}" for c in cells) + " |")


def draw(rows: list[dict], out: Path) -> None:
    figure, axes = subplots(figsize=(8, 4))
    for kind, (color, _) in KINDS.items():
        mine = [row for row in rows if row["kind"] == kind]
        x = [row["roughness"] for row in mine]
        axes.plot(x, [row["single"] for row in mine], color=color, label=f"{kind}, single")
        axes.plot(x, [row["compensated"] for row in mine], color=color, linestyle="--", label=f"{kind}, compensated")
    axes.set_xlabel("roughness")
    axes.set_ylabel("radiance of a white ball in a white furnace")
    add_grid(axes)
    save(figure, out, len(KINDS), 0.9)


def main() -> None:
    arguments = options(__doc__, "build/release/parian", "docs/ggx.svg").parse_args()
    rows = read(arguments.csv or measure(arguments.program), {"kind"})
    if not arguments.csv:
        print_costs(arguments.program)
    print_gains(rows)
    draw(rows, arguments.out)


if __name__ == "__main__":
    main()
