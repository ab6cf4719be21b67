"""What a lens adds to a camera."""

import math
import random

from gltf_builder import Gltf
from gltf_shapes import box, icosphere, lathe, mul, quad
from scene_recipes.expectations import Expected, measured


def depth_of_field() -> tuple[Gltf, Expected]:
    """Pawns in rows on a table through a wide-open lens, and lamps far behind that become disks."""
    scene = Gltf()
    table = scene.add_material("table", (0.16, 0.09, 0.055), roughness=0.35)
    scene.add_object("table", box((0, -0.02, -0.75), (4, 0.04, 3.1)).without("uvs"), table)
    profile = [(0, 0.1), (0.012, 0.098), (0.021, 0.09), (0.024, 0.08), (0.021, 0.07), (0.012, 0.063), (0.02, 0.058)]
    profile += [(0.011, 0.053), (0.013, 0.035), (0.022, 0.016), (0.03, 0.012), (0.031, 0.004), (0.03, 0), (0, 0)]
    pawn = lathe(profile, 40).without("uvs")
    colors = [(0.72, 0.63, 0.5), (0.5, 0.05, 0.04), (0.03, 0.2, 0.25), (0.75, 0.42, 0.06), (0.06, 0.08, 0.2)]
    meshes = []
    for i, color in enumerate(colors):
        lacquer = scene.add_material(f"lacquer {i}", color, roughness=0.18)
        meshes.append(scene.add_mesh(f"pawn {i}", (pawn, lacquer)))
    for row in range(7):
        for column in range(5):
            x, z = 0.15 * (column - 2) + 0.05 * (row % 2), 0.45 - 0.26 * row
            scene.add_node(f"pawn {row} {column}", mesh=meshes[(row + 2 * column) % 5], translation=(x, 0, z))
    wall = quad((0, 0, -10), (8, 0, 0), (0, 6, 0)).without("uvs")
    scene.add_object("far wall", wall, scene.add_lambert("night", (0.03, 0.05, 0.1)))
    add_bulbs(scene)
    scene.add_rect_light("key", (1, 0.93, 0.84), 6, (1.2, 0.8), (-1.1, 1.3, 0.9), (0, 0, -0.2))
    eye, target = (0.12, 0.26, 1.05), (0.0, 0.055, -0.07)
    lens = {"focalLength": 0.055, "sensorSize": [0.036, 0.024], "fStop": 1.4, "focusDistance": math.dist(eye, target)}
    scene.add_camera(eye, target, yfov_degrees=2 * math.degrees(math.atan(0.012 / 0.055)), aspect=1.5, lens=lens)
    return scene, measured("Pawns through a 55 mm lens at f/1.4, the third row sharp; the lamps behind become disks.")


def add_bulbs(scene: Gltf) -> None:
    """Small glowing spheres, scattered behind the table; the same every time."""
    chance = random.Random(7)
    colors = [(1.0, 0.55, 0.2), (1.0, 0.3, 0.12), (0.35, 0.6, 1.0), (1.0, 0.8, 0.5), (0.3, 1.0, 0.6)]
    bulb = icosphere(0.03, 1).without("normals")
    glows = [scene.add_lambert(f"bulb {i}", (0, 0, 0), emission=mul(color, 26)) for i, color in enumerate(colors)]
    bulbs = [scene.add_mesh(f"bulb {i}", (bulb, glow)) for i, glow in enumerate(glows)]
    for i in range(48):
        distance = 3.5 + 5 * chance.random()
        x, y = (chance.random() - 0.5) * 0.7 * distance, (0.04 - 0.22 * chance.random()) * distance * 0.7
        scene.add_node(f"bulb {i}", mesh=bulbs[i % len(bulbs)], translation=(x, y + 0.2, -distance))
