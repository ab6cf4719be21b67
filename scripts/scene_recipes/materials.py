"""A still life of glTF's material extensions that reflect, for looking at."""

import math
import random
from typing import Any

from gltf_builder import Gltf
from gltf_shapes import Vec, Vec3, floor, lathe, mul, normalize, quad, rotation, sphere, torus
from image_files import environment_hdr, png, to_srgb
from scene_recipes.expectations import Expected, measured
from scene_recipes.shapes import ball, block, draw, frustum


def materials() -> tuple[Gltf, Expected]:
    """A dozen materials on a table, in three rows."""
    scene = Gltf()
    add_room(scene)
    add_back_row(scene)
    add_middle_row(scene)
    add_front_row(scene)
    scene.add_camera((0, 1.75, 5.2), (0, 0.42, 0), yfov_degrees=27, aspect=1.5)
    return scene, measured(
        "Metals, car paint, lacquer on weave, velvet, brushed steel, a thin film, a paper lantern, Phong, dense plastic."
    )


def add_room(scene: Gltf) -> None:
    wood = scene.add_material("table", (0.3, 0.2, 0.13), roughness=0.4)
    scene.add_object("table", floor(6).without("uvs"), wood)
    wall = scene.add_lambert("wall", (0.28, 0.31, 0.34))
    scene.add_object("wall", quad((0, 3, -2.2), (8, 0, 0), (0, 3, 0)).without("uvs"), wall)
    scene.set_environment(scene.add_image("sky.hdr", environment_hdr(64, 32, studio)))
    scene.add_rect_light("window", (1, 0.95, 0.88), 11, (1.6, 1.6), (-3.2, 3.0, 2.4), (0, 0.3, 0))
    scene.add_rect_light("strip", (0.8, 0.9, 1), 9, (0.35, 2.2), (3.0, 1.9, 1.6), (0, 0.4, 0))


def studio(w: Vec3) -> Vec:
    """Dim blue above, with a row of soft panels for metals to mirror; brown below."""
    if w[1] < 0:
        return 0.05, 0.04, 0.03
    panel = 0.9 if w[2] > 0 and 0.35 < w[1] < 0.7 and math.sin(7 * math.atan2(w[0], w[2])) > 0.3 else 0.0
    return tuple(c + panel for c in mul((0.2, 0.24, 0.3), 0.6 + w[1]))


def coated(scene: Gltf, name: str, color: Vec, coat: dict[str, Any], **more: Any) -> int:
    extensions = {"KHR_materials_clearcoat": {"clearcoatFactor": 1, **coat}}
    return scene.add_material(name, color, extensions=extensions, **more)


def add_back_row(scene: Gltf) -> None:
    """Paper lantern, golden vase, brushed steel pot, velvet ball."""
    paper = {"diffuseTransmissionFactor": 0.55, "diffuseTransmissionColorFactor": [0.95, 0.75, 0.5]}
    lampshade = scene.add_material(
        "paper", (0.85, 0.8, 0.7), double_sided=True, extensions={"KHR_materials_diffuse_transmission": paper}
    )
    shade = [(0.2, 0.95), (0.34, 0.7), (0.36, 0.45), (0.3, 0.16)]
    scene.add_object("lantern", lathe(shade, 48).without("uvs"), lampshade, translation=(-1.5, 0, -0.85))
    bulb = scene.add_lambert("bulb", (0, 0, 0), emission=(5, 3.4, 1.8))
    draw(scene, ball(0.17), bulb, translation=(-1.5, 0.5, -0.85))

    gold = scene.add_material("gold", roughness=0.12, extensions={"PARIAN_materials_conductor": {"name": "gold"}})
    vase = [(0.1, 0.95), (0.13, 0.9), (0.09, 0.78), (0.16, 0.6), (0.27, 0.4), (0.25, 0.18), (0.14, 0.04)]
    vase += [(0.17, 0), (0, 0)]
    scene.add_object("vase", lathe(vase, 48).without("uvs"), gold, translation=(-0.55, 0, -0.75))

    steel = scene.add_material(
        "brushed steel", (0.62, 0.61, 0.6), metallic=1, roughness=0.18,
        extensions={"KHR_materials_anisotropy": {"anisotropyStrength": 0.75, "anisotropyRotation": 0}},
    )  # fmt: skip
    pot = lathe([(0, 0.56), (0.36, 0.56), (0.36, 0), (0, 0)], 48, smooth=False)
    scene.add_object("pot", pot, steel, translation=(0.45, 0, -0.8))
    velvet = scene.add_material(
        "velvet", (0.16, 0.01, 0.04), roughness=1,
        extensions={
            "KHR_materials_sheen": {"sheenColorFactor": [0.85, 0.35, 0.5], "sheenRoughnessFactor": 0.45},
            "KHR_materials_specular": {"specularFactor": 0},
        },
    )  # fmt: skip
    draw(scene, ball(0.4), velvet, "velvet ball", translation=(1.4, 0.4, -0.7))


def add_middle_row(scene: Gltf) -> None:
    """Car paint with flakes, lacquer over a weave, a thin film on metal."""
    flakes, chance = 64, random.Random(3)
    slopes = [[(chance.gauss(0, 0.13), chance.gauss(0, 0.13)) for _ in range(flakes)] for _ in range(flakes)]

    def flake_normal(u: float, v: float) -> Vec:
        x, y = slopes[int(v * flakes)][int(u * flakes)]
        return [0.5 + 0.5 * c for c in normalize((x, y, 1))]

    flake_map = scene.add_texture(scene.add_image("flakes.png", png(flakes, flakes, 3, flake_normal)), nearest=True)
    info = scene.texture_info(flake_map, transform={"scale": [10, 5]})
    paint = coated(
        scene, "car paint", (0.02, 0.16, 0.42), {"clearcoatRoughnessFactor": 0.02},
        metallic=0.8, roughness=0.35, normalTexture=info,
    )  # fmt: skip
    car = sphere(0.36, 64, 32)
    scene.add_object("car paint ball", car, paint, translation=(-0.95, 0.36, 0.05))

    def weave(u: float, v: float) -> Vec:
        over = (int(8 * u) + int(8 * v)) % 2 == 0
        along = math.sin(math.pi * ((8 * u) % 1)), math.sin(math.pi * ((8 * v) % 1))
        return [to_srgb(c) for c in mul((0.08, 0.08, 0.09), 0.25 + (along[1] if over else along[0]))]

    def weave_normal(u: float, v: float) -> Vec:
        over = (int(8 * u) + int(8 * v)) % 2 == 0
        slope = 0.5 * math.cos(math.pi * ((8 * (v if over else u)) % 1))
        return [0.5 + 0.5 * c for c in normalize((0, slope, 1) if over else (-slope, 0, 1))]

    color = scene.add_texture(scene.add_image("weave.png", png(128, 128, 3, weave)))
    normal = scene.add_texture(scene.add_image("weave-normal.png", png(128, 128, 3, weave_normal)))
    repeat = {"scale": [4, 2]}
    carbon = coated(
        scene, "lacquered weave", (1, 1, 1), {"clearcoatRoughnessFactor": 0.03}, roughness=0.5, metallic=0.3,
        pbr={"baseColorTexture": scene.texture_info(color, transform=repeat)},
        normalTexture=scene.texture_info(normal, transform=repeat),
    )  # fmt: skip
    tube = lathe([(0.12, 0.52), (0.26, 0.5), (0.26, 0.02), (0.12, 0)], 48, smooth=False)
    scene.add_object("woven tube", tube, carbon, translation=(0.88, 0, 0.1))

    def bubble(u: float, v: float) -> Vec:
        return 0, min(max(0.05 + 0.9 * v + 0.05 * math.sin(12 * math.pi * u + 3 * v), 0), 1), 0

    thickness = scene.add_texture(scene.add_image("film.png", png(64, 64, 3, bubble)))
    film = {"iridescenceFactor": 1, "iridescenceIor": 1.35, "iridescenceThicknessMinimum": 180}
    film |= {"iridescenceThicknessMaximum": 620, "iridescenceThicknessTexture": scene.texture_info(thickness)}
    iridescent = scene.add_material(
        "film on metal", (0.55, 0.55, 0.58), metallic=1, roughness=0.12, extensions={"KHR_materials_iridescence": film}
    )
    draw(scene, ball(0.3), iridescent, "iridescent ball", translation=(0.0, 0.3, 0.1))


def add_front_row(scene: Gltf) -> None:
    """Copper ring, silver block, Phong ball, cone of high index, felt, porcelain."""
    copper = scene.add_material("copper", roughness=0.25, extensions={"PARIAN_materials_conductor": {"name": "copper"}})
    ring = torus(0.2, 0.06, 40, 16).without("uvs")
    scene.add_object("copper ring", ring, copper, translation=(-1.35, 0.06, 0.75))
    silver = {"PARIAN_materials_conductor": {"name": "silver"}}
    mirror = scene.add_material("silver mirror", roughness=0, extensions=silver)
    turned = rotation((0, 1, 0), 32)
    draw(scene, block(0.3, 0.3, 0.3), mirror, "mirror", translation=(-0.62, 0.15, 0.85), rotation=turned)
    phong = {"diffuse": [0.35, 0.06, 0.03], "specular": [0.3, 0.3, 0.3], "exponent": 60}
    old = scene.add_material("phong", extensions={"PARIAN_materials_phong": phong})
    draw(scene, ball(0.19), old, "phong ball", translation=(-0.15, 0.19, 0.9))
    jewel = scene.add_material(
        "dense plastic", (0.02, 0.2, 0.1), roughness=0.08,
        extensions={"KHR_materials_ior": {"ior": 2.3}, "KHR_materials_specular": {"specularColorFactor": [0.8, 1, 0.9]}},
    )  # fmt: skip
    draw(scene, frustum("cone", 0.42, 0.2, 0), jewel, "dense cone", translation=(0.35, 0.21, 0.85))
    fibres = {"sheenColorFactor": [0.3, 0.45, 0.8], "sheenRoughnessFactor": 0.8}
    felt = scene.add_material("felt", (0.06, 0.12, 0.25), extensions={"KHR_materials_sheen": fibres})
    draw(scene, frustum("felt", 0.16, 0.24, 0.22), felt, translation=(0.92, 0.08, 0.85))
    china = coated(scene, "porcelain", (0.85, 0.84, 0.8), {"clearcoatRoughnessFactor": 0}, roughness=0.6)
    cup = [(0.19, 0.3), (0.2, 0.31), (0.21, 0.3), (0.19, 0.12), (0.1, 0.02), (0.1, 0), (0, 0)]
    scene.add_object("porcelain cup", lathe(cup, 48).without("uvs"), china, translation=(1.5, 0, 0.55))
