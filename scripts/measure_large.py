#!/usr/bin/env python3
"""What large models cost against the least that they could: time to the first ray and peak memory, beside reading the
file and Embree's own build of the same triangles. Prints a Markdown table.

    scripts/build.sh release parian bare_build
    scripts/make_mesh.py 10000000 sphere.glb
    scripts/measure_large.py sphere.glb

All programs run in turn, N times; times are medians. `first ray` is from the start of the process; `bare` is one read of
the file into memory and one commit of all its triangles, on all threads.
"""

import argparse
import json
import re
import subprocess
import tempfile
from pathlib import Path
from statistics import median
from typing import Any

RELEASE = Path(__file__).resolve().parent.parent / "build/release"
UNITS = {"B": 1, "kB": 1e3, "MB": 1e6, "GB": 1e9, "TB": 1e12}


def run_bare(scene: Path) -> dict[str, Any]:
    return json.loads(subprocess.run([RELEASE / "bare_build", scene], check=True, capture_output=True).stdout)


def run_parian(scene: Path, size: str, options: list[str]) -> dict[str, Any]:
    """The statistics of a render of one sample for each pixel."""
    with tempfile.TemporaryDirectory() as folder:
        stats, picture = Path(folder) / "stats.json", Path(folder) / "out.exr"
        command = [RELEASE / "parian", "render", scene, "-o", picture, "--stats", stats, "--size", size, "--spp", "1"]
        subprocess.run(command + ["--quiet", *options], check=True)
        return json.loads(stats.read_text())


def run_info(scene: Path, size: str) -> dict[str, float]:
    """Bytes of the geometry, and of the peak as predicted."""
    text = subprocess.run([RELEASE / "parian", "info", scene, "--size", size], check=True, capture_output=True, text=True)
    number = r"([\d.]+) ([kMGT]?B)"
    find = lambda pattern: re.search(pattern, text.stdout)
    geometry, peak = find(rf"memory +{number} geometry"), find(rf"rendering +about {number}")
    return {"geometry": float(geometry[1]) * UNITS[geometry[2]], "peak": float(peak[1]) * UNITS[peak[2]]}


def row(scene: Path, args: argparse.Namespace) -> str:
    bare, parian = [], []
    options = ["--build", args.build] if args.build else []
    for _ in range(args.runs):
        bare.append(run_bare(scene))
        parian.append(run_parian(scene, args.size, options))
    info = run_info(scene, args.size)
    middle = lambda runs, key: median(run[key] for run in runs)
    least = middle(bare, "read") + middle(bare, "build")
    first, peak = middle(parian, "seconds_to_first_ray"), middle(parian, "peak_memory_bytes")
    base = info["geometry"] + middle(bare, "bytes")
    mb = lambda value: f"{value / 1e6:.0f}"
    cells = [scene.stem, f"{bare[0]['triangles'] / 1e6:.1f}", mb(info["geometry"]), mb(middle(bare, "bytes"))]
    cells += [mb(middle(parian, "acceleration_bytes")), mb(peak), f"{peak / base:.2f}", f"{info['peak'] / peak:.2f}"]
    cells += [f"{middle(bare, 'read'):.2f} + {middle(bare, 'build'):.2f}", f"{first:.2f}", f"{first / least:.2f}"]
    return "| " + " | ".join(cells) + " |"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenes", type=Path, nargs="+", metavar="SCENE.glb")
    parser.add_argument("--runs", type=int, default=3, metavar="N")
    parser.add_argument("--size", default="1024x768", metavar="WxH")
    parser.add_argument("--build", choices=["fast", "balanced", "best"])
    args = parser.parse_args()
    heads = ["scene", "million triangles", "geometry MB", "Embree's BVH MB", "Parian's MB", "peak MB"]
    heads += ["peak / (geometry + Embree's)", "predicted / peak", "bare s", "first ray s", "first ray / bare"]
    print("| " + " | ".join(heads) + " |\n|" + "---|" * len(heads))
    for scene in args.scenes:
        print(row(scene, args), flush=True)


if __name__ == "__main__":
    main()
