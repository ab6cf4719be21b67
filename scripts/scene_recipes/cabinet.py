"""Every kind of light, each in a compartment of a cabinet."""

import math

from gltf_builder import Gltf
from gltf_shapes import Vec, Vec3, box, cone, cylinder, lathe, merge, quad, rotation, sphere, torus
from scene_recipes.expectations import Expected, measured

BALL = sphere(1, 56, 28).without("uvs")
BAY = (2.0, 1.9, 1.9)  # a compartment of the cabinet: width, height, depth


def lights() -> tuple[Gltf, Expected]:
    """A cabinet with six compartments, each with a lamp of another kind over an object."""
    scene = Gltf()
    cabinet(scene)
    bays = [(column, row) for row in (1, 0) for column in (0, 1, 2)]
    centres = [((column - 1) * BAY[0], row * BAY[1], -BAY[2] / 2) for column, row in bays]
    for place, centre in zip((bay_point, bay_directional, bay_spot, bay_rectangle, bay_disk, bay_mesh), centres):
        place(scene, centre)
    scene.add_camera((0, 1.98, 8.4), (0, 1.9, 0), yfov_degrees=26.6, aspect=1.5)
    return scene, measured(
        "Point, directional (through a slot in the roof) and spot light; rectangle, disk and glowing mesh."
    )


def cabinet(scene: Gltf) -> None:
    """Walls, shelves and a roof whose middle has a slot for the sun."""
    width, height, depth = BAY
    thick = 0.08
    wood = scene.add_lambert("boards", (0.62, 0.58, 0.53))
    boards = [box((x * width, height, -depth / 2), (thick, 2 * height + thick, depth)) for x in (-1.5, -0.5, 0.5, 1.5)]
    boards += [box((0, y * height, -depth / 2), (3 * width + thick, thick, depth)) for y in (0, 1)]
    top = 2 * height
    for x0, x1, z0, z1 in ((-1.5, -0.42, -1, 0), (0.06, 1.5, -1, 0), (-0.42, 0.06, -1, -0.85), (-0.42, 0.06, -0.12, 0)):
        middle = ((x0 + x1) / 2 * width, top, (z0 + z1) / 2 * depth)
        boards.append(box(middle, ((x1 - x0) * width, thick, (z1 - z0) * depth)))
    scene.add_object("boards", merge(boards).without("uvs"), wood)
    colors = [(0.55, 0.24, 0.19), (0.22, 0.36, 0.50), (0.60, 0.46, 0.20)]
    colors += [(0.28, 0.42, 0.30), (0.42, 0.28, 0.42), (0.20, 0.40, 0.42)]
    for i, color in enumerate(colors):
        centre = ((i % 3 - 1) * width, (1.5 - i // 3) * height, -depth + 0.001)
        back = quad(centre, (width / 2, 0, 0), (0, height / 2, 0)).without("uvs")
        scene.add_object(f"back {i}", back, scene.add_lambert(f"back {i}", color))
    shield = box((0, height, -depth - 0.05), (3 * width + thick, 2 * height + thick, 0.08))
    scene.add_object("back board", shield.without("uvs"), wood)


def on_shelf(centre: Vec, x: float = 0, y: float = 0, z: float = 0) -> Vec3:
    return centre[0] + x, centre[1] + 0.04 + y, centre[2] + z


def bay_point(scene: Gltf, centre: Vec) -> None:
    scene.add_punctual_light("point", "point", (1, 0.82, 0.6), 2.5, on_shelf(centre, 0.35, 1.45, 0.35))
    white = scene.add_lambert("plaster", (0.8, 0.78, 0.74))
    scene.add_object("cone", cone(0.42, 1.2).without("uvs"), white, translation=on_shelf(centre, -0.3, 0, -0.2))
    scene.add_object("ball", BALL, white, translation=on_shelf(centre, 0.38, 0.3, 0.25), scale=(0.3,) * 3)


def bay_directional(scene: Gltf, centre: Vec) -> None:
    scene.add_punctual_light("directional", "sun", (1, 0.94, 0.84), 9, (-1.8, 5, 0), (0, 0, 0))
    marble = scene.add_material("glazed", (0.75, 0.75, 0.72), roughness=0.25)
    profile = [(0.12, 1.25), (0.16, 1.21), (0.12, 1.06), (0.17, 0.87), (0.37, 0.56), (0.41, 0.37), (0.35, 0.15)]
    vase = lathe([*profile, (0.22, 0), (0, 0)], 48).without("uvs")
    scene.add_object("vase", vase, marble, translation=on_shelf(centre, 0, 0, 0.15))


def bay_spot(scene: Gltf, centre: Vec) -> None:
    cone_angles = {"innerConeAngle": math.radians(22), "outerConeAngle": math.radians(30)}
    eye, target = on_shelf(centre, -0.5, 1.7, 0.75), on_shelf(centre, 0.12, 0.45, -0.3)
    scene.add_punctual_light("spot", "spot", (1, 0.9, 0.75), 28, eye, target, spot=cone_angles)
    gold = scene.add_material("gold", (1.0, 0.77, 0.34), metallic=1, roughness=0.42)
    ring = torus(0.42, 0.15, 48, 20).without("uvs").moved(turn=rotation((1, 0, 0), 80))
    place, turn = on_shelf(centre, 0.08, 0.57, -0.05), rotation((0, 1, 0), 25)
    scene.add_object("ring", ring, gold, translation=place, rotation=turn)


def bay_rectangle(scene: Gltf, centre: Vec) -> None:
    eye, target = on_shelf(centre, 0, 1.74, -0.1), on_shelf(centre, 0, 0, 0.3)
    scene.add_rect_light("rectangle", (1, 0.96, 0.9), 9, (1.4, 0.35), eye, target)
    red = scene.add_material("red lacquer", (0.65, 0.06, 0.05), roughness=0.2)
    cube = box((0, 0.3, 0), (0.6, 0.6, 0.6)).without("uvs")
    scene.add_object("cube", cube, red, translation=on_shelf(centre, -0.28, 0, -0.1), rotation=rotation((0, 1, 0), 28))
    steel = scene.add_material("steel", (0.62, 0.61, 0.6), metallic=1, roughness=0.22)
    scene.add_object("ball", BALL, steel, translation=on_shelf(centre, 0.42, 0.34, 0.15), scale=(0.34,) * 3)


def bay_disk(scene: Gltf, centre: Vec) -> None:
    eye, target = on_shelf(centre, 0.25, 1.66, 0.15), on_shelf(centre, 0, 0, 0.5)
    scene.add_disk_light("disk", (0.8, 0.9, 1), 26, 0.5, eye, target)
    white = scene.add_lambert("chalk", (0.82, 0.82, 0.82))
    pearl = scene.add_material("pearl", (0.85, 0.82, 0.78), roughness=0.15)
    for i, (radius, height) in enumerate(((0.62, 0.26), (0.46, 0.26), (0.3, 0.26))):
        step = cylinder(radius, height).without("uvs")
        scene.add_object(f"step {i}", step, white, translation=on_shelf(centre, 0, 0.26 * i, -0.1))
    scene.add_object("pearl", BALL, pearl, translation=on_shelf(centre, 0, 1.04, -0.1), scale=(0.26,) * 3)


def bay_mesh(scene: Gltf, centre: Vec) -> None:
    glow = scene.add_lambert("glow", (0, 0, 0), emission=(5, 2.2, 0.9))
    arch = torus(0.6, 0.035, 48, 10).moved(turn=rotation((1, 0, 0), 90))
    scene.add_object("glowing ring", arch.without("uvs"), glow, translation=on_shelf(centre, 0, 0.85, -0.45))
    blue = scene.add_material("blue glaze", (0.05, 0.16, 0.55), roughness=0.12)
    scene.add_object("ball", BALL, blue, translation=on_shelf(centre, -0.05, 0.42, 0.1), scale=(0.42,) * 3)
