#!/usr/bin/env python3
"""Writes the scenes under scenes/: NAME/NAME.gltf with its .bin and pictures, and NAME/expected.json.

    scripts/make_scenes.py [NAME...] [--out FOLDER]

The same bytes every time. A `mean` that was filled into expected.json by hand, from a converged render, is kept as
long as the scene's own files do not change.
"""

import argparse
import json
from pathlib import Path
from typing import Any

from gltf_builder import Gltf, to_json
from scene_recipes import cabinet, classics, furnaces, garden, glass, lens, shapes, single_lights, still_life, sunlight
from scene_recipes import many_lights, materials, subsurface, subsurface_bust, subsurface_still_life, surfaces

SCENES = {
    "cornell-box": classics.cornell_box,
    "veach-mis": classics.veach_mis,
    "lights": cabinet.lights,
    "depth-of-field": lens.depth_of_field,
    "environment-sun": sunlight.environment_sun,
    "textured": still_life.textured,
    "instances": garden.instances,
    "shapes-still-life": shapes.shapes_still_life,
    "glass-still-life": glass.glass_still_life,
    "furnace-sphere": furnaces.furnace_sphere,
    "furnace-box": furnaces.furnace_box,
    "environment-gradient": furnaces.environment_gradient,
    "light-point": single_lights.light_point,
    "light-spot": single_lights.light_spot,
    "light-directional": single_lights.light_directional,
    "light-rectangle": single_lights.light_rectangle,
    "light-disk": single_lights.light_disk,
    "shapes-furnace": shapes.shapes_furnace,
    "shapes-scales": shapes.shapes_scales,
    "specular": surfaces.specular,
    "clearcoat": surfaces.clearcoat,
    "sheen": surfaces.sheen,
    "anisotropy": surfaces.anisotropy,
    "iridescence": surfaces.iridescence,
    "diffuse-transmission": surfaces.diffuse_transmission,
    "conductor": surfaces.conductor,
    "phong": surfaces.phong,
    "surfaces-furnace": surfaces.surfaces_furnace,
    "terminator": surfaces.terminator,
    "many-lights": many_lights.many_lights,
    "materials": materials.materials,
    "glass-panes": glass.glass_panes,
    "glass-slabs": glass.glass_slabs,
    "glass-nested": glass.glass_nested,
    "glass-furnace": glass.glass_furnace,
    "glass-balls": glass.glass_balls,
    "glass-inside": glass.glass_inside,
    "glass-prism": glass.glass_prism,
    "subsurface-bust": subsurface_bust.subsurface_bust,
    "subsurface-still-life": subsurface_still_life.subsurface_still_life,
    "subsurface-balls": subsurface.subsurface_balls,
    "subsurface-blocks": subsurface.subsurface_blocks,
    "subsurface-slabs": subsurface.subsurface_slabs,
    "subsurface-edge": subsurface.subsurface_edge,
    "subsurface-shadow": subsurface.subsurface_shadow,
    "subsurface-touching": subsurface.subsurface_touching,
    "subsurface-walk": subsurface.subsurface_walk,
    "subsurface-auto": subsurface.subsurface_auto,
    "subsurface-furnace": subsurface.subsurface_furnace,
}


def read_files(folder: Path) -> dict[str, bytes]:
    """The scene's own files, by name."""
    return {p.name: p.read_bytes() for p in folder.glob("*") if p.name != "expected.json"}


def keep_measured(expected: dict[str, Any], before: Path) -> None:
    """Takes over the measured values of an earlier expected.json where the scene itself states none."""
    if expected["mean"] is None and before.exists():
        measured = json.loads(before.read_text())
        if measured.get("mean") is not None:
            for key in ("size", "spp", "mean", "tolerance", "source"):
                expected[key] = measured[key]


def write_scene(folder: Path, scene: Gltf, expected: dict[str, Any]) -> None:
    old = read_files(folder)
    scene.write(folder, folder.name)
    new = read_files(folder)
    if old == new:
        keep_measured(expected, folder / "expected.json")
    (folder / "expected.json").write_text(to_json(expected), newline="\n")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME", help="scenes to write (default: all)")
    parser.add_argument("--out", type=Path, default=Path(__file__).resolve().parent.parent / "scenes")
    args = parser.parse_args()
    unknown = set(args.names) - set(SCENES)
    if unknown:
        parser.error(f"no such scene: {', '.join(sorted(unknown))}; there are {', '.join(sorted(SCENES))}")
    for name in args.names or SCENES:
        write_scene(args.out / name, *SCENES[name]())
        print(args.out / name)


if __name__ == "__main__":
    main()
