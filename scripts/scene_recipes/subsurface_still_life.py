"""A still life of what light goes into: milk, skin, wax, jade."""

import math
from typing import Any

from gltf_builder import Gltf
from gltf_shapes import Vec, Vec3, compose, icosphere, lathe, rotation
from image_files import environment_hdr, png, to_srgb
from scene_recipes.expectations import Expected, measured
from scene_recipes.glass import Glass
from scene_recipes.shapes import UPWARDS, Y_AXIS, Z_AXIS, ball, draw, frustum, sheet
from scene_recipes.subsurface_bust import NECK, bell, bust


def subsurface_still_life() -> tuple[Gltf, Expected]:
    """On a table before a window, as if a third of the size."""
    scene = Gltf()
    add_room(scene)
    add_glass_of_milk(scene, (-1.1, 0, 0.0))
    add_head(scene, (-0.28, 0, -0.15))
    add_candle(scene, (0.48, 0, -0.3))
    add_jade(scene)
    scene.add_camera((0.05, 1.05, 4.6), (0.0, 0.51, 0), yfov_degrees=21, aspect=16 / 9)
    return scene, measured(
        "A glass of milk, a head of skin, a wax candle that burns, and jade: a coarse lump and a fine one.", (480, 270)
    )


def add_room(scene: Gltf) -> None:
    wood = scene.add_material("table", (0.16, 0.09, 0.055), roughness=0.45)
    draw(scene, sheet(9, 6), wood, "table", translation=(0, 0, 1))
    wall = scene.add_lambert("wall", (0.13, 0.15, 0.17))
    draw(scene, sheet(14, 8), wall, "wall", translation=(0, 4, -2), rotation=UPWARDS)
    sky = environment_hdr(32, 16, lambda w: [c * (0.1 + 0.08 * w[1]) for c in (0.75, 0.88, 1.0)])
    scene.set_environment(scene.add_image("sky.hdr", sky))
    scene.add_rect_light("window", (1, 0.94, 0.86), 9, (1.8, 1.6), (-2.6, 2.3, 1.9), (0, 0.4, 0))
    scene.add_rect_light("behind", (1, 0.9, 0.78), 24, (0.9, 0.7), (1.7, 2.1, -1.5), (-0.1, 0.3, 0))


def add_glass_of_milk(scene: Gltf, at: Vec) -> None:
    """As the glass of water of glass-still-life: priorities hollow out air and milk."""
    glass = Glass("tumbler", attenuation=((0.9, 0.96, 0.93), 0.3), priority=1).add_to(scene)
    air = Glass("inside of the tumbler", 1, priority=2).add_to(scene)
    extensions = {
        "PARIAN_materials_subsurface": {"name": "wholemilk", "scale": 6},
        "PARIAN_materials_priority": {"priority": 3},
    }
    milk = scene.add_material("milk", roughness=0, extensions=extensions)
    parts = []
    for material, name, bottom, top in (
        (glass, "tumbler", 0.001, 0.9),
        (air, "inside", 0.08, 0.95),
        (milk, "milk", 0.079, 0.6),
    ):
        wall = 0.028 if material != glass else 0
        low, high = (0.23 + 0.07 * y - wall for y in (bottom, top))
        body = frustum(name, top - bottom, low, high)
        parts.append(draw(scene, body, material, translation=(0, (bottom + top) / 2, 0)))
    scene.add_node("glass of milk", translation=at, children=parts)


def add_head(scene: Gltf, at: Vec) -> None:
    """Tinted by a texture: cheeks, lips, brows."""

    def tint(u: float, v: float) -> Vec:
        around, height = 2 * math.pi * u - math.pi, 0.995 - v * (0.995 - NECK)
        side = abs(around)
        red = 0.5 * bell(around, 0.19) * (bell(height - 0.633, 0.008) + bell(height - 0.608, 0.008))
        red += 0.16 * bell(side - 0.6, 0.22) * bell(height - 0.67, 0.035) + 0.12 * bell(side - 1.72, 0.2)
        dark = 0.45 * bell(side - 0.32, 0.16) * bell(height - 0.806, 0.007)
        return [to_srgb((1 - dark) * (1 - min(red, 1) * k)) for k in (0.15, 0.6, 0.5)]

    texture = scene.add_texture(scene.add_image("skin.png", png(128, 128, 3, tint)), wrap_t="clamp")
    skin = {"PARIAN_materials_subsurface": {"name": "skin2", "scale": 5}}
    pbr = {"baseColorTexture": scene.texture_info(texture)}
    material = scene.add_material("skin", roughness=0.45, pbr=pbr, extensions=skin)
    head = bust(88, 72, NECK).moved((0, -NECK, 0))
    turn = rotation(Y_AXIS, 18)
    x, y, z = at
    scene.add_object("head", head, material, translation=(x, y + 0.1, z), rotation=turn, scale=(1.35,) * 3)
    stand = scene.add_material("stand", (0.03, 0.025, 0.02), roughness=0.3)
    draw(scene, frustum("stand", 0.1, 0.24, 0.19), stand, translation=(x, y + 0.05, z))


def add_candle(scene: Gltf, at: Vec3) -> None:
    """Wax by KHR_materials_volume_scatter."""
    extensions: dict[str, Any] = {
        "KHR_materials_ior": {"ior": 1.44},
        "KHR_materials_volume": {
            "thicknessFactor": 0.1, "attenuationColor": [0.3, 0.26, 0.2], "attenuationDistance": 0.03,
        },
        "KHR_materials_volume_scatter": {"multiscatterColor": [0.93, 0.86, 0.66], "scatterAnisotropy": 0},
        "KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 1},
    }  # fmt: skip
    wax = scene.add_material("wax", roughness=0.4, extensions=extensions)
    outline = [(0, 0.68), (0.09, 0.685), (0.125, 0.72), (0.145, 0.735), (0.16, 0.72), (0.163, 0.6), (0.165, 0.3)]
    outline += [(0.165, 0.03), (0.15, 0.001), (0, 0.001)]
    parts = [scene.add_object("candle", lathe(outline, 48).without("uvs"), wax)]
    black = scene.add_lambert("wick", (0.02, 0.02, 0.02))
    parts.append(draw(scene, frustum("wick", 0.09, 0.008, 0.006), black, translation=(0, 0.725, 0)))
    flame = scene.add_lambert("flame", (0, 0, 0), emission=(90, 46, 15))
    drop = [(0, 0.2), (0.012, 0.15), (0.028, 0.09), (0.034, 0.05), (0.024, 0.012), (0, 0)]
    parts.append(scene.add_object("flame", lathe(drop, 16).without("uvs"), flame, translation=(0, 0.76, 0)))
    scene.add_node("candle and flame", translation=at, children=parts)


def add_jade(scene: Gltf) -> None:
    """One shape of 80 triangles and of 5,120, in one material."""
    jade = {"sigmaA": [0.045, 0.006, 0.02], "sigmaSPrime": [0.9, 1.1, 1.0], "eta": 1.6, "scale": 12}
    material = scene.add_material("jade", roughness=0.25, extensions={"PARIAN_materials_subsurface": jade})
    turn = compose(rotation(Z_AXIS, 12), rotation(Y_AXIS, 30))
    coarse, fine = icosphere(0.27, 1).without("normals"), icosphere(0.27, 4)
    scene.add_object("coarse jade", coarse, material, translation=(1.08, 0.26, 0.05), rotation=turn)
    scene.add_object("fine jade", fine, material, translation=(0.62, 0.2, 0.62), rotation=turn, scale=(0.74,) * 3)
    pearl = {"PARIAN_materials_subsurface": {"name": "cream", "scale": 4}}
    white = scene.add_material("bead", roughness=0.4, extensions=pearl)
    for i, (x, z) in enumerate(((1.06, 0.7), (1.27, 0.6), (-0.62, 0.62))):
        draw(scene, ball(0.09), white, f"bead {i}", translation=(x, 0.09, z))
