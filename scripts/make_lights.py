#!/usr/bin/env python3
"""Writes a room that N small triangles light, for benchmarks of many lights: OUT/many-lights-N.gltf and .bin.

    scripts/make_lights.py N OUT

Half of the lamps lie on a grid below the ceiling and shine down, the others hang anywhere in the upper half of the
room, turned any way; their radiances differ by up to a thousand, and their area together is the same for any N. Blocks,
pillars and hanging panels hide them. The camera looks down from below all lamps and sees none. All surfaces are
Lambert's. The same bytes every time; standard library only.
"""

import argparse
import math
import random
from pathlib import Path

from gltf_builder import Gltf
from gltf_shapes import Geometry, Vec, Vec3, add, box, cross, merge, mul, normalize

HALF, HEIGHT = 5.0, 4.0  # of the room, m
LOWEST = 2.1  # lamps are above this, the camera below
RADIANCES = [1000 ** (i / 16) for i in range(16)]


def lamp(center: Vec, normal: Vec, radius: float) -> Geometry:
    """An equilateral triangle that faces along the unit normal."""
    x = normalize(cross(normal, (1, 0, 0) if abs(normal[0]) < 0.9 else (0, 1, 0)))
    y = cross(normal, x)
    angles = [2 * math.pi * i / 3 for i in range(3)]
    corners = [add(center, add(mul(x, radius * math.cos(a)), mul(y, radius * math.sin(a)))) for a in angles]
    return Geometry(positions=corners, triangles=[(0, 1, 2)])


def hanging(numbers: random.Random) -> tuple[Vec3, Vec3]:
    """A place in the upper half of the room and a direction, both uniform."""
    span = HEIGHT - 0.2 - LOWEST
    center = tuple(low + size * numbers.random() for low, size in ((-4.8, 9.6), (LOWEST, span), (-4.8, 9.6)))
    z, phi = 2 * numbers.random() - 1, 2 * math.pi * numbers.random()
    r = math.sqrt(1 - z * z)
    return center, (r * math.cos(phi), z, r * math.sin(phi))


def lamps(count: int) -> dict[float, list[Geometry]]:
    """The triangles by radiance."""
    numbers = random.Random(7)
    radius = 0.9 / math.sqrt(count)
    row = math.ceil(math.sqrt(count / 2))
    step = 2 * HALF / row
    by_radiance: dict[float, list[Geometry]] = {}
    for i in range(count):
        center, normal = hanging(numbers)
        if i % 2 == 0:
            z, x = divmod(i // 2, row)
            center, normal = ((x + 0.5) * step - HALF, HEIGHT - 0.1, (z + 0.5) * step - HALF), (0, -1, 0)
        by_radiance.setdefault(numbers.choice(RADIANCES), []).append(lamp(center, normal, radius))
    return by_radiance


def furniture() -> list[Geometry]:
    """Blocks on the floor, pillars up to the ceiling, panels among the lamps."""
    numbers = random.Random(3)
    parts = []
    for x in (-3.6, -1.2, 1.2, 3.6):
        for z in (-3.8, -1.6, 0.6, 2.2):
            height = 0.3 + 1.1 * numbers.random()
            at = (x + numbers.random() - 0.5, height / 2, z + numbers.random() - 0.5)
            parts.append(box(at, (0.4 + 0.7 * numbers.random(), height, 0.4 + 0.7 * numbers.random())))
    parts += [box((x, HEIGHT / 2, z), (0.3, HEIGHT, 0.3)) for x in (-2.4, 2.4) for z in (-2.7, 1.4)]
    for i in range(12):
        at = (-4 + 8 * numbers.random(), 2.4 + numbers.random(), -4 + 8 * numbers.random())
        parts.append(box(at, [(1.2, 0.05, 1.2), (0.05, 1, 1.2), (1.2, 1, 0.05)][i % 3]))
    return parts


def room(count: int) -> Gltf:
    scene = Gltf()
    walls = box((0, HEIGHT / 2, 0), (2 * HALF, HEIGHT, 2 * HALF)).inside_out().without("uvs")
    scene.add_object("walls", walls, scene.add_lambert("grey", (0.7, 0.68, 0.65)))
    things = merge(furniture()).without("uvs")
    scene.add_object("furniture", things, scene.add_lambert("clay", (0.6, 0.45, 0.35)))
    primitives = [
        (merge(triangles), scene.add_lambert(f"lamp {radiance:.3g}", (0, 0, 0), emission=(radiance,) * 3))
        for radiance, triangles in sorted(lamps(count).items())
    ]
    scene.add_node("lamps", mesh=scene.add_mesh("lamps", *primitives))
    scene.add_camera((0, 1.9, 4.9), (0, 0, 0), yfov_degrees=40, aspect=4 / 3)
    return scene


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("count", type=int, metavar="N", help="how many lamps")
    parser.add_argument("out", type=Path, metavar="OUT", help="folder to write to")
    arguments = parser.parse_args()
    if not 1 <= arguments.count <= 1_000_000:
        parser.error("N must be between 1 and 1000000")
    room(arguments.count).write(arguments.out, f"many-lights-{arguments.count}")


if __name__ == "__main__":
    main()
