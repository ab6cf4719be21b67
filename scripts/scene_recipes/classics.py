"""Two scenes that everyone knows."""

import math

from gltf_builder import Gltf
from gltf_shapes import (
    Geometry,
    Vec,
    Vec3,
    add,
    box,
    cross,
    floor,
    icosphere,
    merge,
    mul,
    normalize,
    polygon,
    quad,
    sub,
)
from scene_recipes.expectations import Expected, measured

# Cornell University's measured data, in millimetres: x to the left, z away from the camera.
CORNELL = {
    "floor": ("white", [[(552.8, 0, 0), (0, 0, 0), (0, 0, 559.2), (549.6, 0, 559.2)]]),
    "ceiling": ("white", [[(556, 548.8, 0), (556, 548.8, 559.2), (0, 548.8, 559.2), (0, 548.8, 0)]]),
    "back wall": ("white", [[(549.6, 0, 559.2), (0, 0, 559.2), (0, 548.8, 559.2), (556, 548.8, 559.2)]]),
    "right wall": ("green", [[(0, 0, 559.2), (0, 0, 0), (0, 548.8, 0), (0, 548.8, 559.2)]]),
    "left wall": ("red", [[(552.8, 0, 0), (549.6, 0, 559.2), (556, 548.8, 559.2), (556, 548.8, 0)]]),
    "short block": (
        "white",
        [
            [(130, 165, 65), (82, 165, 225), (240, 165, 272), (290, 165, 114)],
            [(290, 0, 114), (290, 165, 114), (240, 165, 272), (240, 0, 272)],
            [(130, 0, 65), (130, 165, 65), (290, 165, 114), (290, 0, 114)],
            [(82, 0, 225), (82, 165, 225), (130, 165, 65), (130, 0, 65)],
            [(240, 0, 272), (240, 165, 272), (82, 165, 225), (82, 0, 225)],
        ],
    ),
    "tall block": (
        "white",
        [
            [(423, 330, 247), (265, 330, 296), (314, 330, 456), (472, 330, 406)],
            [(423, 0, 247), (423, 330, 247), (472, 330, 406), (472, 0, 406)],
            [(472, 0, 406), (472, 330, 406), (314, 330, 456), (314, 0, 456)],
            [(314, 0, 456), (314, 330, 456), (265, 330, 296), (265, 0, 296)],
            [(265, 0, 296), (265, 330, 296), (423, 330, 247), (423, 0, 247)],
        ],
    ),
    "light": ("light", [[(343, 548.3, 227), (343, 548.3, 332), (213, 548.3, 332), (213, 548.3, 227)]]),
}


def cornell_box() -> tuple[Gltf, Expected]:
    """The classic: two blocks in a box, one quad light. Nothing but positions, no node transforms."""
    scene = Gltf()
    materials = {
        "white": scene.add_lambert("white", (0.725, 0.71, 0.68)),
        "red": scene.add_lambert("red", (0.63, 0.065, 0.05)),
        "green": scene.add_lambert("green", (0.14, 0.45, 0.091)),
        "light": scene.add_lambert("light", (0, 0, 0), emission=(17, 12, 4)),
    }
    for name, (material, faces) in CORNELL.items():
        in_metres = [[((278 - x) / 1000, y / 1000, -z / 1000) for x, y, z in face] for face in faces]
        scene.add_object(name, merge(polygon(face) for face in in_metres), materials[material])
    yfov = 2 * math.degrees(math.atan(0.025 / 2 / 0.035))
    scene.add_camera((0, 0.273, 0.8), yfov_degrees=yfov, aspect=1)
    return scene, measured("The Cornell box: indirect light, colour bleeding, soft shadows; the benchmark.", (512, 512))


def veach_mis() -> tuple[Gltf, Expected]:
    """After Veach: four spheres of equal power over four metal plates, from polished to rough."""
    scene = Gltf()
    eye, lamps = (0.0, 2.6, 14.0), (0.0, 1.3, -1.0)
    grey = scene.add_lambert("grey", (0.4, 0.4, 0.42))
    scene.add_object("floor", floor(30, -3.6).without("uvs"), grey)
    scene.add_object("wall", quad((0, 0, -4.5), (30, 0, 0), (0, 20, 0)).without("uvs"), grey)
    colors = ((1.0, 0.32, 0.18), (1.0, 0.78, 0.32), (0.35, 1.0, 0.55), (0.3, 0.5, 1.0))
    radii, left = (0.04, 0.12, 0.36, 1.0), -4.0
    for i, (color, radius) in enumerate(zip(colors, radii)):
        glow = scene.add_lambert(f"lamp {i}", (0, 0, 0), emission=mul(color, 1.3 / radius**2))
        ball = icosphere(radius, 2 + (i > 1)).without("normals")
        scene.add_object(f"lamp {i}", ball, glow, translation=(left + 2.65 * i, lamps[1], lamps[2]))
    for i, roughness in enumerate((0.06, 0.14, 0.25, 0.4)):
        metal = scene.add_material(f"plate {roughness}", (0.88, 0.9, 0.93), metallic=1, roughness=roughness)
        centre = (0.0, -1.7 - 0.34 * i, 0.2 + 1.2 * i)
        plate = mirror_plate(centre, eye, lamps, 4.9 - 0.3 * i, 0.52).without("uvs")
        scene.add_object(f"plate {i}", plate, metal)
    scene.add_rect_light("overhead", (1, 1, 1), 0.7, (16, 8), (0, 12, 4), (0, 0, 4))
    scene.add_camera(eye, (0, -0.9, 0), yfov_degrees=31, aspect=1.5)
    return scene, measured(
        "Four lamps of equal power and growing size over metal plates of roughness .06, .14, .25, .4: sampling the "
        "light fails at the top right, sampling the reflection at the bottom left."
    )


def mirror_plate(centre: Vec3, eye: Vec, lamps: Vec, half_width: float, half_depth: float) -> Geometry:
    """A plate, wide along x, that mirrors the lamps towards the eye."""
    normal = normalize(add(normalize(sub(eye, centre)), normalize(sub(lamps, centre))))
    along = mul(normalize(cross((1, 0, 0), normal)), half_depth)  # away from the camera
    plate = quad((0, 0, 0), (half_width, 0, 0), mul(along, -1) if along[2] > 0 else along)
    return plate.moved(centre)
