#!/usr/bin/env python3
"""Measures how near --sss METHOD is to the random walk, and what it costs; prints tables in Markdown, draws
docs/subsurface-bodies.svg and docs/subsurface-scenes.svg.

usage: chart_subsurface.py [--csv FOLDER] [--out FOLDER] [PROGRAM]

Bodies: a thick block of every albedo, slabs of every thickness and balls of every radius, index 1.3, under a white sky,
by each method and by the walk; the share of the light that enters which comes out again, on the side of the sky and, of
slabs, on the other. Scenes: the relative error of the picture over CPU time, against references by the walk. Writes the
numbers to build/charts/subsurface-bodies.csv and subsurface-scenes.csv; with --csv FOLDER they are read from there.
Needs numpy and matplotlib.
"""

from pathlib import Path
from typing import Any, Callable

from charts import add_grid, options, save, subplots
from gltf_builder import Gltf
from gltf_shapes import look_at
from image_files import environment_hdr
from measured import CHARTS, ROOT, percent, read, references, relative_rmse, render, write

METHODS = {
    "random-walk": "#111111",
    "auto": "#1f6fb2",
    "photon-beam": "#2e8b57",
    "better-dipole": "#d98c00",
    "dipole": "#c0392b",
    "burley": "#8e5bb5",
}
INDEX = 1.3
F0 = ((INDEX - 1) / (INDEX + 1)) ** 2
FREE_PATH = 1e-3  # metres
ALBEDOS = (0.3, 0.5, 0.7, 0.8, 0.9, 0.95, 0.99, 0.999)
SIZES = (1, 2, 5, 10, 20, 50, 100)  # in mean free paths
SCENES = {
    "subsurface-bust": ("96x96", 2048, (1, 4, 16, 64, 256)),
    "subsurface-still-life": ("96x54", 2048, (1, 4, 16, 64, 256)),
}



def plot(panel: Any, x: list[float], y: list[float], method: str) -> None:
    width = 2 if method == "auto" else 1
    panel.plot(x, y, color=METHODS[method], marker="o", markersize=2.5, linewidth=width, label=method)


# --- bodies -----------------------------------------------------------------------------------------------------------


def half_sky(above: bool) -> Callable[[Any], tuple[float, float, float]]:
    return lambda w: (1.0, 1.0, 1.0) if (w[1] > 0) == above else (0.0, 0.0, 0.0)


def body(shape: tuple[str, dict[str, Any]], albedo: float, top: float, sky: Callable) -> Gltf:
    """Seen from straight above, where its top is."""
    scene = Gltf()
    coefficients = {"sigmaA": [1 - albedo] * 3, "sigmaSPrime": [albedo] * 3, "eta": INDEX}
    material = scene.add_material("body", roughness=0, extensions={"PARIAN_materials_subsurface": coefficients})
    scene.add_shape_node("body", scene.add_shape(shape[0], **shape[1]), material, translation=[0, top, 0])
    scene.set_environment(scene.add_image("sky.hdr", environment_hdr(8, 512, sky)))
    scene.add_orthographic_camera((0, 1, 0), look_at((0, 1, 0), (0, 0, 0)), 1e-6, 1e-6)
    return scene


def slab(paths: float) -> tuple[tuple[str, dict[str, Any]], float]:
    thickness = paths * FREE_PATH
    return ("box", {"size": [4, thickness, 4]}), -thickness / 2


def ball(paths: float) -> tuple[tuple[str, dict[str, Any]], float]:
    return ("sphere", {"radius": paths * FREE_PATH}), -paths * FREE_PATH


def shares(program: Path, scene: Gltf, mirrored: float) -> dict[str, float]:
    """Of what enters, by method."""
    scene.write(CHARTS, "body")
    result = {}
    for method in METHODS:
        settings = ["--size", "8x8", "--spp", "1024", "--max-depth", "1000", "--sss", method]
        seen = render(program, CHARTS / "body.gltf", settings, CHARTS / "body")[0].mean()
        result[method] = (seen - mirrored) / (1 - F0)
    return result


def measure_bodies(program: Path) -> Path:
    CHARTS.mkdir(parents=True, exist_ok=True)
    rows = []

    def add(study: str, albedo: float, size: float, shape: Any, sky: Callable, mirrored: float) -> None:
        scene = body(shape[0], albedo, shape[1], sky)
        rows.append({"study": study, "albedo": albedo, "size": size, **shares(program, scene, mirrored)})

    white = lambda w: (1.0, 1.0, 1.0)  # noqa: E731
    for albedo in ALBEDOS:
        add("block", albedo, 1000, slab(1000), white, F0)
    for size in SIZES:
        add("slab, reflected", 0.99, size, slab(size), half_sky(True), F0)
        if size <= 20:  # beyond, there is nothing to compare
            add("slab, transmitted", 0.99, size, slab(size), half_sky(False), 0)
        for albedo in (0.9, 0.99, 0.999):
            add("ball", albedo, size, ball(size), white, F0)
    return write(CHARTS / "subsurface-bodies.csv", rows)


def print_bodies(rows: list[dict]) -> None:
    print("| body | albedo | " + " | ".join(METHODS) + " |\n" + "|---" * (len(METHODS) + 2) + "|")
    for row in rows:
        name = row["study"] + ("" if row["study"] == "block" else f" {row['size']:g}")
        truth = row["random-walk"]
        cells = [f"{truth:.4f}"] + [f"{100 * (row[m] / truth - 1):+.1f}%" for m in list(METHODS)[1:]]
        print(f"| {name} | {row['albedo']:g} | " + " | ".join(cells) + " |")


def draw_bodies(rows: list[dict], out: Path) -> None:
    figure, axes = subplots(2, 3, figsize=(9, 5.4))
    panels = [
        ("block", None, "thick block"),
        ("slab, reflected", 0.99, "slab of albedo .99, reflected"),
        ("slab, transmitted", 0.99, "slab of albedo .99, transmitted"),
        ("ball", 0.9, "ball of albedo .9"),
        ("ball", 0.99, "ball of albedo .99"),
        ("ball", 0.999, "ball of albedo .999"),
    ]
    for panel, (study, albedo, label) in zip(axes.flat, panels):
        mine = [row for row in rows if row["study"] == study and albedo in (None, row["albedo"])]
        x = [1 - row["albedo"] if study == "block" else row["size"] for row in mine]
        for method in list(METHODS)[1:]:
            y = [100 * (row[method] / row["random-walk"] - 1) for row in mine]
            plot(panel, x, y, method)
        panel.axhline(0, color="#111111", linewidth=0.8)
        panel.set_xscale("log")
        panel.set_ylim(-80, 80)
        panel.set_title(label, fontsize=8)
        quantity = {"b": "radius [mean free paths]", "s": "thickness [mean free paths]"}
        panel.set_xlabel("1 - albedo" if study == "block" else quantity[study[0]])
        add_grid(panel)
    for panel in axes[:, 0]:
        panel.set_ylabel("light against the walk [%]")
    save(figure, out, len(METHODS) - 1)


# --- scenes -----------------------------------------------------------------------------------------------------------


def measure_scenes(program: Path) -> Path:
    rows = []
    for name, (size, many, counts) in SCENES.items():
        scene, common = ROOT / f"scenes/{name}/{name}.gltf", ["--size", size, "--threads", "1", "--max-depth", "1000"]
        truth = references(program, scene, [*common, "--spp", str(many), "--sss", "random-walk"])
        for method in METHODS:
            for spp in counts:
                picture, stats = render(program, scene, [*common, "--spp", str(spp), "--sss", method], CHARTS / "scene")
                seconds, error = stats["render_cpu_seconds"], relative_rmse(picture, truth)
                rows.append({"scene": name, "method": method, "spp": spp, "seconds": seconds, "error": error})
    return write(CHARTS / "subsurface-scenes.csv", rows)


def print_scenes(rows: list[dict]) -> None:
    print("\n| scene | method | samples | CPU s | error |\n|---|---|---|---|---|")
    for row in rows:
        print(f"| {row['scene']} | {row['method']} | {row['spp']:g} | {row['seconds']:.2f} | {percent(row['error'])} |")


def draw_scenes(rows: list[dict], out: Path) -> None:
    figure, axes = subplots(1, len(SCENES), figsize=(9, 3.6))
    for panel, name in zip(axes, SCENES):
        for method in METHODS:
            mine = [row for row in rows if row["scene"] == name and row["method"] == method]
            x, y = [row["seconds"] for row in mine], [100 * row["error"] for row in mine]
            plot(panel, x, y, method)
        panel.set_xscale("log")
        panel.set_yscale("log")
        panel.set_xlabel(f"CPU seconds, {name}")
        add_grid(panel)
    axes[0].set_ylabel("relative error [%]")
    save(figure, out, len(METHODS), 0.9)


def main() -> None:
    parser = options(__doc__, "build/release/parian", "docs")
    arguments = parser.parse_args()
    kept = arguments.csv
    bodies = read(kept / "subsurface-bodies.csv" if kept else measure_bodies(arguments.program), {"study"})
    print_bodies(bodies)
    draw_bodies(bodies, arguments.out / "subsurface-bodies.svg")
    scenes = read(kept / "subsurface-scenes.csv" if kept else measure_scenes(arguments.program), {"scene", "method"})
    print_scenes(scenes)
    draw_scenes(scenes, arguments.out / "subsurface-scenes.svg")


if __name__ == "__main__":
    main()
