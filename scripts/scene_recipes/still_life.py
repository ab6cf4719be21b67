"""A still life in which each object shows another use of textures, vertex colours and alpha."""

import colorsys
import math
from typing import Sequence

from gltf_builder import Gltf
from gltf_shapes import Geometry, Vec3, box, lathe, merge, mul, normalize, polygon, quad, rotation, sphere, torus
from image_files import environment_hdr, png, to_srgb
from scene_recipes.expectations import Expected, measured

LETTER = ("......", ".####.", ".#..#.", ".####.", ".#....", ".#....", "......")  # a P: no symmetry hides a flip


def textured() -> tuple[Gltf, Expected]:
    """Base colour, normal, metallic-roughness and emissive textures; two UV sets; transforms; wrap modes; vertex
    colours; alpha by mask and by blending; double-sided leaves."""
    scene = Gltf()
    add_room(scene)
    add_wrap_posters(scene)
    add_ball(scene)
    add_plant(scene)
    add_lantern(scene)
    add_panes(scene)
    sky = environment_hdr(32, 16, lambda w: mul((0.8, 0.9, 1.0), 0.5 + 0.3 * w[1]))
    scene.set_environment(scene.add_image("sky.hdr", sky))
    scene.add_rect_light("window", (1, 0.95, 0.88), 13, (1.68, 1.2), (-2.6, 3.0, 2.6), (0, 0.5, 0))
    scene.add_camera((0.1, 1.45, 5.6), (0.05, 0.86, 0), yfov_degrees=27, aspect=1.5)
    shows = "Textures of every kind, wrap modes (repeat, mirror, clamp), vertex colours, masked leaves, 50% panes."
    return scene, measured(shows)


def srgb(color: Sequence[float]) -> tuple[float, ...]:
    return tuple(to_srgb(c) for c in color)


def mix(a: Sequence[float], b: Sequence[float], t: float) -> tuple[float, ...]:
    return tuple(x + (y - x) * t for x, y in zip(a, b))


def add_room(scene: Gltf) -> None:
    """A tiled floor (one texture, repeated by KHR_texture_transform) and a plain wall."""

    def tile(u: float, v: float) -> tuple[float, ...]:
        x, y = (2 * u) % 1, (2 * v) % 1
        if min(x, y, 1 - x, 1 - y) < 0.035:
            return srgb((0.16, 0.15, 0.14))
        dark = (int(2 * u) + int(2 * v)) % 2 == 1
        grain = 0.06 * math.sin(23 * x + 5 * math.sin(9 * y + u)) * math.sin(17 * y + 3 * x)
        return srgb(mul((0.2, 0.26, 0.3) if dark else (0.58, 0.55, 0.5), 1 + grain))

    texture = scene.add_texture(scene.add_image("tiles.png", png(128, 128, 3, tile)))
    info = scene.texture_info(texture, transform={"offset": [0.07, 0.11], "rotation": math.pi / 4, "scale": [8, 8]})
    tiles = scene.add_material("tiles", roughness=0.45, pbr={"baseColorTexture": info})
    scene.add_object("floor", quad((0, 0, 0), (5, 0, 0), (0, 0, -5)), tiles)
    wall = scene.add_lambert("wall", (0.5, 0.47, 0.42))
    scene.add_object("wall", quad((0, 3, -1.6), (8, 0, 0), (0, 3, 0)).without("uvs"), wall)


def add_wrap_posters(scene: Gltf) -> None:
    """One picture whose uvs run from -.6 to 1.6, under three samplers."""

    def letter(u: float, v: float) -> tuple[float, ...]:
        if min(u, v, 1 - u, 1 - v) < 0.06:
            return srgb((0.75, 0.36, 0.08))
        row, column = int(v * len(LETTER)), int(u * len(LETTER[0]))
        paper = mix((0.85, 0.8, 0.68), (0.55, 0.7, 0.75), v)
        return srgb((0.06, 0.1, 0.2) if LETTER[row][column] == "#" else paper)

    image = scene.add_image("letter.png", png(64, 64, 3, letter))
    modes = (("repeat", "repeat"), ("mirror", "mirror"), ("clamp", "repeat"))
    for i, (wrap_s, wrap_t) in enumerate(modes):
        texture = scene.add_texture(image, wrap_s, wrap_t, nearest=i == 2)
        pbr = {"baseColorTexture": scene.texture_info(texture)}
        paper = scene.add_lambert(f"{wrap_s} {wrap_t}", (1, 1, 1), pbr=pbr)
        poster = quad((1.12 * (i - 1), 1.72, -1.58), (0.48, 0, 0), (0, 0.48, 0))
        poster.uvs = [(2.2 * u - 0.6, 2.2 * v - 0.6) for u, v in poster.uvs]
        scene.add_object(f"poster {wrap_s} {wrap_t}", poster, paper)


def add_ball(scene: Gltf) -> None:
    """Golden and lacquered patches (metallic-roughness texture) with round studs (normal map)."""

    def is_metal(u: float, v: float) -> bool:
        return (int(8 * u) + int(4 * v)) % 2 == 0

    def stud_normal(u: float, v: float) -> tuple[float, ...]:
        x, y = 2 * u - 1, 1 - 2 * v  # y up, as glTF's green channel
        r = math.hypot(x, y)
        slope = 1.1 * math.sin(math.pi * r / 0.8) if 0 < r < 0.8 else 0.0
        n = normalize((slope * x / r, slope * y / r, 1)) if slope else (0, 0, 1)
        return tuple(0.5 + 0.5 * c for c in n)

    def color(u: float, v: float) -> tuple[float, ...]:
        return srgb((1.0, 0.72, 0.3) if is_metal(u, v) else (0.04, 0.1, 0.24))

    def metallic_roughness(u: float, v: float) -> tuple[float, ...]:
        return (0, 0.28, 1) if is_metal(u, v) else (0, 0.12, 0)

    color_image = scene.add_image("ball-color.png", png(64, 32, 3, color))
    color_map = scene.add_texture(color_image, nearest=True)
    rough_image = scene.add_image("ball-roughness.png", png(64, 32, 3, metallic_roughness))
    rough_map = scene.add_texture(rough_image, nearest=True)
    normal_map = scene.add_texture(scene.add_image("ball-normal.png", png(64, 64, 3, stud_normal)))
    studs = scene.texture_info(normal_map, transform={"scale": [16, 8]})
    pbr = {"baseColorTexture": scene.texture_info(color_map), "metallicRoughnessTexture": scene.texture_info(rough_map)}
    studded = scene.add_material("studded", metallic=1, roughness=1, pbr=pbr, normalTexture={**studs, "scale": 0.9})
    ball, turn = sphere(0.5, 64, 32), rotation((0, 1, 0), 25)
    scene.add_object("ball", ball, studded, translation=(-0.28, 0.5, 0.1), rotation=turn)


def add_plant(scene: Gltf) -> None:
    """Leaves cut out of bent cards by an alpha mask, seen from both sides."""

    def leaf(u: float, v: float) -> tuple[float, ...]:
        across, along = abs(2 * u - 1), 1 - v  # from the stem at v = 1 to the tip
        width = 0.92 * math.sin(math.pi * along**0.8) ** 0.9 * (1 - 0.12 * abs(math.sin(22 * along)))
        rib = across < 0.03 or abs(math.sin(14 * (along - 0.35 * across))) < 0.1
        green = mix((0.05, 0.22, 0.04), (0.2, 0.42, 0.06), along)
        return (*srgb(mix(green, (0.45, 0.6, 0.2), 0.6 if rib else 0.0)), 1.0 if across < width else 0.0)

    texture = scene.add_texture(scene.add_image("leaf.png", png(64, 96, 4, leaf)), "clamp", "clamp")
    green = scene.add_material(
        "leaves",
        roughness=0.5,
        double_sided=True,
        alphaMode="MASK",
        alphaCutoff=0.5,
        pbr={"baseColorTexture": scene.texture_info(texture)},
    )
    cards = []
    for i in range(13):
        card = leaf_card(length=1.0 - 0.022 * i, width=0.21, curl=2.0 - 0.11 * i)
        cards.append(card.moved((0, 0.42, 0), rotation((0, 1, 0), 137.5 * i)))
    scene.add_object("leaves", merge(cards), green, translation=(-1.35, 0, -0.35))
    clay = scene.add_lambert("clay", (0.5, 0.2, 0.1))
    pot = [(0.2, 0.4), (0.25, 0.45), (0.29, 0.45), (0.29, 0.37), (0.26, 0.36), (0.2, 0.0), (0, 0)]
    scene.add_object("pot", lathe(pot, 40, smooth=False).without("uvs"), clay, translation=(-1.35, 0, -0.35))
    soil = polygon([(0.245 * math.cos(a), 0.41, -0.245 * math.sin(a)) for a in (math.pi * i / 20 for i in range(40))])
    scene.add_object("soil", soil, scene.add_lambert("soil", (0.06, 0.04, 0.03)), translation=(-1.35, 0, -0.35))


def leaf_card(length: float, width: float, curl: float, steps: int = 7) -> Geometry:
    """A strip that leaves the origin upwards along +x and bends over by `curl` radians."""
    card = Geometry()
    x, y, lean = 0.0, 0.0, 0.12
    for i in range(steps + 1):
        along = i / steps
        normal = (-math.cos(lean), math.sin(lean), 0)
        for side in (-1, 1):
            card.positions.append((x, y, side * width * 0.5))
            card.normals.append(normal)
            card.uvs.append((0.5 + 0.5 * side, 1 - along))
        x, y = x + length / steps * math.sin(lean), y + length / steps * math.cos(lean)
        lean += curl / steps
    card.triangles = [t for i in range(0, 2 * steps, 2) for t in ((i, i + 1, i + 3), (i, i + 3, i + 2))]
    return card


def add_lantern(scene: Gltf) -> None:
    """A box whose paint is laid out by its second uv set and whose glowing windows by its first."""

    def paint(u: float, v: float) -> tuple[float, ...]:
        x, y = (8 * u) % 1, (8 * v) % 1
        return srgb((0.36, 0.07, 0.06) if (x + y) % 1 < 0.5 else (0.6, 0.5, 0.38))

    def windows(u: float, v: float) -> tuple[float, ...]:
        x, y = (3 * u) % 1 - 0.5, (3 * v) % 1 - 0.5
        lit = abs(x) < 0.3 and -0.3 < y < 0.32
        return srgb(mix((1.0, 0.75, 0.35), (1.0, 0.42, 0.12), v)) if lit else (0, 0, 0)

    paint_map = scene.add_texture(scene.add_image("paint.png", png(64, 64, 3, paint)))
    window_map = scene.add_texture(scene.add_image("windows.png", png(48, 48, 3, windows)))
    lantern = scene.add_material(
        "lantern",
        roughness=0.6,
        pbr={"baseColorTexture": scene.texture_info(paint_map, uv_set=1)},
        emissiveTexture=scene.texture_info(window_map),
        emissiveFactor=[1, 1, 1],
        extensions={"KHR_materials_emissive_strength": {"emissiveStrength": 2.5}},
    )
    body = box((0, 0.42, 0), (0.5, 0.84, 0.5))
    body.uvs1 = [(0.5 * u, 0.84 * v) for u, v in body.uvs]
    scene.add_object("lantern", body, lantern, translation=(1.5, 0, -0.55), rotation=rotation((0, 1, 0), -28))


def add_panes(scene: Gltf) -> None:
    """Two 50% panes that overlap, before a ring painted by vertex colours."""

    def hue(p: Vec3) -> Sequence[float]:
        return colorsys.hsv_to_rgb((math.atan2(p[1], p[0]) / (2 * math.pi)) % 1, 0.85, 0.8)

    ring = torus(0.3, 0.11).without("uvs").moved(turn=rotation((1, 0, 0), 90)).painted(hue)
    painted = scene.add_material("painted", roughness=0.35)
    scene.add_object("painted ring", ring, painted, translation=(0.62, 0.41, -0.1))
    panes = (("cyan", (0.05, 0.6, 0.7, 0.5), (0.66, 0.3, 0.75)), ("rose", (0.75, 0.08, 0.25, 0.5), (0.98, 0.36, 0.5)))
    for name, rgba, centre in panes:
        material = scene.add_material(f"{name} pane", rgba, roughness=0.3, double_sided=True, alphaMode="BLEND")
        pane = quad((0, 0, 0), (0.26, 0, 0), (0, centre[1], 0)).without("uvs")
        scene.add_object(f"{name} pane", pane, material, translation=centre, rotation=rotation((0, 1, 0), -14))
