#!/usr/bin/env python3
"""Measures what a cap for the memory of images costs: a room of 16 images of 2048 x 2048 pixels, 201 MB decoded.

    scripts/measure_textures.py [--program build/release/parian] [--runs 3] [--spp 16]

Renders without a cap, within half of what the images take and within a tenth, in turns, and prints a table: the least
of the runs for times, and what the program says of its memory. All pictures must be the same bit for bit.
"""

import argparse
import json
import random
import struct
import subprocess
import tempfile
import zlib
from pathlib import Path

from gltf_builder import Gltf
from gltf_shapes import quad

IMAGES, SIDE = 16, 2048
BYTES = IMAGES * SIDE * SIDE * 3


def noise_png(seed: int) -> bytes:
    """An RGB image of noise that no two images and no two tiles share; its rows are parts of one, so that it is made
    fast."""
    noise = random.Random(seed).randbytes(9 * SIDE)
    rows = b"".join(b"\0" + noise[(i := y * 37 % (6 * SIDE)) : i + 3 * SIDE] for y in range(SIDE))
    chunks = [
        (b"IHDR", struct.pack(">IIBBBBB", SIDE, SIDE, 8, 2, 0, 0, 0)),
        (b"IDAT", zlib.compress(rows, 1)),
        (b"IEND", b""),
    ]
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data)) for kind, data in chunks
    )


def write_scene(folder: Path) -> Path:
    """A room of 6 x 3 x 6 m whose floor, ceiling and walls have an image for each of 16 pieces."""
    scene = Gltf()
    pieces = [((x, 0, z), (1.5, 0, 0), (0, 0, -1.5)) for x in (-1.5, 1.5) for z in (-1.5, 1.5)]
    pieces += [((x, 3, z), (1.5, 0, 0), (0, 0, 1.5)) for x in (-1.5, 1.5) for z in (-1.5, 1.5)]
    pieces += [((x, 1.5, -3), (1.5, 0, 0), (0, 1.5, 0)) for x in (-1.5, 1.5)]
    pieces += [((x, 1.5, 3), (-1.5, 0, 0), (0, 1.5, 0)) for x in (-1.5, 1.5)]
    pieces += [((-3, 1.5, z), (0, 0, -1.5), (0, 1.5, 0)) for z in (-1.5, 1.5)]
    pieces += [((3, 1.5, z), (0, 0, 1.5), (0, 1.5, 0)) for z in (-1.5, 1.5)]
    for i, (center, u, v) in enumerate(pieces):
        texture = scene.add_texture(scene.add_image(f"{i}.png", noise_png(i)))
        material = scene.add_lambert(f"{i}", (1, 1, 1), pbr={"baseColorTexture": {"index": texture}})
        scene.add_object(f"{i}", quad(center, u, v), material)
    scene.add_rect_light("lamp", (1, 1, 1), 20, (1, 1), at=(0, 2.9, 0), towards=(0, 0, 0.001))
    scene.add_camera((0, 1.5, 2.8), (0, 1.4, 0), yfov_degrees=70, aspect=4 / 3)
    scene.write(folder, "room")
    return folder / "room.gltf"


def render(program: Path, scene: Path, cap: int, spp: int) -> dict:
    """The statistics of a render; its picture stays beside the scene, named for the cap."""
    stats, out = scene.with_name("stats.json"), scene.with_name(f"{cap}.exr")
    command = [str(program), "render", str(scene), "-o", str(out), "--size", "640x480", "--spp", str(spp), "--quiet"]
    command += ["--stats", str(stats)] + (["--texture-memory", str(cap)] if cap else [])
    subprocess.run(command, check=True)
    return json.loads(stats.read_text())


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=Path, default=Path("build/release/parian"))
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--spp", type=int, default=16)
    options = parser.parse_args()
    caps = {"none": 0, "a half": BYTES // 2, "a tenth": BYTES // 10}
    with tempfile.TemporaryDirectory() as folder:
        scene = write_scene(Path(folder))
        runs: dict[str, list[dict]] = {name: [] for name in caps}
        for _ in range(options.runs):
            for name, cap in caps.items():
                runs[name].append(render(options.program, scene, cap, options.spp))
        for name, cap in list(caps.items())[1:]:
            pictures = [str(scene.with_name(f"{c}.exr")) for c in (cap, 0)]
            subprocess.run([str(options.program), "compare", *pictures, "--max-rmse", "0"], check=True, stdout=subprocess.DEVNULL)
    print("| cap | loading | render, CPU | images in memory | cache at its peak | file | tile reads | peak memory |")
    print("|---|---|---|---|---|---|---|---|")
    for name, all_runs in runs.items():
        images = all_runs[0]["images"]
        print(
            f"| {name} | {min(r['seconds']['load'] for r in all_runs):.2f} s"
            f" | {min(r['render_cpu_seconds'] for r in all_runs):.2f} s | {images['memory_bytes'] / 1e6:.0f} MB"
            f" | {images['cache_peak_bytes'] / 1e6:.0f} of {images['cache_bytes'] / 1e6:.0f} MB"
            f" | {images['file_bytes'] / 1e6:.0f} MB | {images['tile_reads']:,}"
            f" | {max(r['peak_memory_bytes'] for r in all_runs) / 1e6:.0f} MB |"
        )


if __name__ == "__main__":
    main()
