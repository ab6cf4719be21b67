"""An environment map with a sun in it."""

import math

from gltf_builder import Gltf
from gltf_shapes import Vec, Vec3, add, box, cylinder, floor, mul, normalize, rotation, sphere, torus
from image_files import environment_hdr
from scene_recipes.expectations import Expected, measured

SUN = normalize((-0.55, 0.52, 0.42))


def sky_radiance(w: Vec3) -> Vec3:
    """A clear evening: blue above, warm at the horizon and around the sun, ground below; without the sun itself."""
    if w[1] < 0:
        return mul((0.22, 0.19, 0.15), 1 + 0.5 * w[1])
    up = w[1] ** 0.45
    base = tuple(a + (b - a) * up for a, b in zip((0.62, 0.45, 0.32), (0.05, 0.13, 0.36)))
    near = max(sum(a * b for a, b in zip(w, SUN)), 0.0)
    return add(base, mul((1.0, 0.7, 0.4), 0.6 * near**24 + 0.12 * near**4))


def environment_sun() -> tuple[Gltf, Expected]:
    """Metal, plastic and plaster under a sky whose sun is two texels wide."""
    scene = Gltf()
    width, height = 256, 128
    u, v = math.atan2(SUN[2], SUN[0]) / (2 * math.pi) + 0.5, math.acos(SUN[1]) / math.pi
    column, row = int(u * width), int(v * height)

    def radiance(w: Vec3) -> Vec:
        x, y = (math.atan2(w[2], w[0]) / (2 * math.pi) + 0.5) * width, math.acos(w[1]) / math.pi * height
        inside = column <= x < column + 2 and row <= y < row + 2
        return (2500.0, 2000.0, 1400.0) if inside else sky_radiance(w)

    scene.set_environment(scene.add_image("sky.hdr", environment_hdr(width, height, radiance)))
    scene.add_object("ground", floor(400).without("uvs"), scene.add_lambert("sand", (0.46, 0.4, 0.33)))
    ball = sphere(1, 80, 40).without("uvs")
    gold = scene.add_material("gold", (1.0, 0.71, 0.29), metallic=1, roughness=0.16)
    scene.add_object("golden ball", ball, gold, translation=(-0.95, 0.75, -0.3), scale=(0.75,) * 3)
    red = scene.add_material("red plastic", (0.55, 0.035, 0.03), roughness=0.25)
    scene.add_object("plastic ball", ball, red, translation=(0.55, 0.5, 0.55), scale=(0.5,) * 3)
    plaster = scene.add_lambert("plaster", (0.78, 0.76, 0.72))
    scene.add_object("plaster column", cylinder(0.42, 1.7, 64).without("uvs"), plaster, translation=(0.95, 0, -1.0))
    teal = scene.add_material("teal glaze", (0.02, 0.22, 0.24), roughness=0.18)
    scene.add_object("glazed ring", torus(0.4, 0.13).without("uvs"), teal, translation=(-0.35, 0.13, 1.2))
    copper = scene.add_material("brushed copper", (0.95, 0.55, 0.4), metallic=1, roughness=0.38)
    cube = box((0, 0.34, 0), (0.68, 0.68, 0.68)).without("uvs")
    scene.add_object("copper cube", cube, copper, translation=(2.0, 0, 0.0), rotation=rotation((0, 1, 0), 32))
    scene.add_camera((0.45, 1.05, 5.6), (0.42, 0.78, 0), yfov_degrees=30, aspect=1.5)
    return scene, measured("Metal, plastic and plaster under a clear sky with a small, very bright sun.")
