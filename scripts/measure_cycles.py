#!/usr/bin/env python3
"""The same model in Parian and in Blender's Cycles: memory, time to the first ray, time to render, noise. Prints a Markdown
table.

    scripts/build.sh release parian
    apt-get install blender
    scripts/make_mesh.py 10000000 sphere.glb
    scripts/measure_cycles.py sphere.glb

Both render with as many samples for each pixel, on all threads, twice with other seeds; noise is half of the mean square
difference of the two, and `to equal noise` the ratio of the products of noise and seconds of rendering. Blender reads the
file by its own importer, whose time and memory are in columns of their own; its materials are then made what the file
says (its importer of version 3.4 knows no KHR_materials_specular, and nothing of the environment).
"""

import argparse
import json
import os
import re
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

RELEASE = Path(__file__).resolve().parent.parent / "build/release"


def embedded_image(scene: Path) -> bytes:
    """The first image of a .glb: the environment of those that make_mesh.py writes."""
    data = scene.read_bytes()
    length = struct.unpack_from("<I", data, 12)[0]
    document = json.loads(data[20 : 20 + length])
    view = document["bufferViews"][document["images"][0]["bufferView"]]
    begin = 28 + length + view.get("byteOffset", 0)
    return data[begin : begin + view["byteLength"]]


def render_in_blender(arguments: list[str]) -> None:
    """Inside Blender: imports and renders. Prints one line of JSON after the mark @@."""
    import resource
    import time

    import bpy
    import numpy

    numpy.bool, numpy.int, numpy.float = bool, int, float  # names that Blender 3.4's importer still uses
    scene_file, sky, width, height, samples, seed, out = arguments
    peak = lambda: resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    start = time.time()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=scene_file)
    imported, import_peak = time.time() - start, peak()
    for material in bpy.data.materials:
        for node in material.node_tree.nodes if material.use_nodes else []:
            if node.type == "BSDF_PRINCIPLED":
                node.inputs["Specular"].default_value = 0
    scene = bpy.context.scene
    scene.camera = next(o for o in scene.objects if o.type == "CAMERA")
    scene.world = bpy.data.worlds.new("sky")
    scene.world.use_nodes = True
    tree = scene.world.node_tree
    texture = tree.nodes.new("ShaderNodeTexEnvironment")
    texture.image = bpy.data.images.load(sky)
    tree.links.new(texture.outputs[0], tree.nodes["Background"].inputs[0])
    render = scene.render
    render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.samples, scene.cycles.seed = int(samples), int(seed)
    scene.cycles.use_adaptive_sampling = scene.cycles.use_denoising = False
    scene.cycles.pixel_filter_type = "BOX"
    render.resolution_x, render.resolution_y, render.resolution_percentage = int(width), int(height), 100
    render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
    render.image_settings.color_mode, render.filepath = "RGB", out
    start = time.time()
    bpy.ops.render.render(write_still=True)
    print("@@" + json.dumps({"import": imported, "import_peak": import_peak, "all": time.time() - start, "peak": peak()}))


def run_cycles(scene: Path, sky: Path, args: argparse.Namespace, seed: int, out: Path) -> dict[str, float]:
    size = args.size.split("x")
    command = ["blender", "--background", "--debug-cycles", "--python", __file__, "--", scene, sky, *size]
    # Debian's Blender takes the libraries of the python3 that it finds first; numpy is with the system's.
    path = {**os.environ, "PATH": "/usr/bin:/bin"}
    command += [str(args.spp), str(seed), out]
    done = subprocess.run(command, check=True, capture_output=True, text=True, env=path)
    text = done.stdout
    if "@@" not in text:
        sys.exit(f"Blender: {(done.stderr.strip() or text).splitlines()[-1]}")
    values = json.loads(re.search(r"@@(.*)", text)[1])
    # "Total render time" counts from the start of the session, synchronisation and build included.
    seconds = [60 * int(m) + float(s) for m, s in re.findall(r"Time:(?:\d+:)?(\d+):([\d.]+) .*\| Sample \d+/\d+", text)]
    values["first"], values["render"] = seconds[0], seconds[-1] - seconds[0]
    return values


def run_parian(scene: Path, args: argparse.Namespace, seed: int, out: Path) -> dict[str, float]:
    stats = out.with_suffix(".json")
    command = [RELEASE / "parian", "render", scene, "-o", out, "--stats", stats, "--size", args.size, "--quiet"]
    subprocess.run([*command, "--spp", str(args.spp), "--seed", str(seed), "--filter", "box"], check=True)
    values = json.loads(stats.read_text())
    return {"first": values["seconds_to_first_ray"], "render": values["seconds"]["render"], "peak": values["peak_memory_bytes"]}


def noise(a: Path, b: Path) -> float:
    report = a.with_suffix(".compare.json")
    subprocess.run([RELEASE / "parian", "compare", a, b, "--json", report], check=False, capture_output=True)
    return json.loads(report.read_text())["layers"]["rgb"]["rmse"] ** 2 / 2


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenes", type=Path, nargs="+", metavar="SCENE.glb")
    parser.add_argument("--size", default="1024x768", metavar="WxH")
    parser.add_argument("--spp", type=int, default=16, metavar="N")
    args = parser.parse_args()
    heads = ["scene", "renderer", "import s", "peak of import MB", "first ray s", "peak MB", "render s", "noise", "to equal noise"]
    print("| " + " | ".join(heads) + " |\n|" + "---|" * len(heads))
    for scene in args.scenes:
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            (folder / "sky.hdr").write_bytes(embedded_image(scene))
            ours = [run_parian(scene, args, seed, folder / f"parian{seed}.exr") for seed in (1, 2)]
            theirs = [run_cycles(scene, folder / "sky.hdr", args, seed, folder / f"cycles{seed}.exr") for seed in (1, 2)]
            noises = [noise(folder / f"{kind}1.exr", folder / f"{kind}2.exr") for kind in ("parian", "cycles")]
        best = [{key: min(run[key] for run in runs) for key in runs[0]} for runs in (ours, theirs)]
        costs = [run["render"] * value for run, value in zip(best, noises)]
        for kind, run, value, cost in zip(("Parian", "Cycles"), best, noises, costs):
            cells = [scene.stem, kind, f"{run['import']:.1f}" if "import" in run else ""]
            cells += [f"{run['import_peak'] / 1e6:.0f}" if "import" in run else "", f"{run['first']:.2f}"]
            cells += [f"{run['peak'] / 1e6:.0f}", f"{run['render']:.2f}", f"{value:.3g}", f"{cost / costs[0]:.1f}"]
            print("| " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    if "--background" in sys.argv:
        render_in_blender(sys.argv[sys.argv.index("--") + 1 :])
    else:
        main()
