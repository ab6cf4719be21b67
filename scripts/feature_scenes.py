"""The room of chart_features.py: without a feature, with it where no path comes by, and with it in use."""

import math
from dataclasses import dataclass
from typing import Any, Callable, Optional, Sequence

from gltf_builder import Gltf
from gltf_shapes import Geometry, Vec, box, cylinder, floor, merge, mul, normalize, quad, rotation, sphere
from image_files import environment_hdr, png, to_srgb

Material = Callable[[Gltf], int]
Part = Callable[[Gltf], None]  # of a scene, which it is added to

SHORT, TALL = ((0.35, 0.3, 0.35), (0.6, 0.6, 0.6), -17), ((-0.35, 0.6, -0.3), (0.6, 1.2, 0.6), 20)
UP = (0, 1, 0)
GREY = (0.7, 0.7, 0.7)  # all reflect about as much, so that paths are as long
STORED = tuple(to_srgb(c) for c in GREY)  # in a picture


@dataclass
class Feature:
    """`used` with `options` against `without`, and the plain room with `outside` against the plain room alone."""

    name: str
    used: Optional[Gltf]
    outside: Optional[Part] = None
    options: tuple[str, ...] = ()
    without: Optional[Gltf] = None  # the plain room


# --- the room -------------------------------------------------------------------------------------------------------


def room(*parts: Part, lamp: Optional[Part] = None, camera: Optional[Part] = None, is_open: bool = False) -> Gltf:
    """Walls of 2 m that nothing gets out of, unless that behind the camera is missing, a lamp, and what is in it."""
    scene = Gltf()
    walls = box((0, 1, 0), (2, 2, 2)).inside_out().without("normals", "uvs")
    if is_open:
        walls.triangles = [t for t in walls.triangles if not all(walls.positions[i][2] == 1 for i in t)]
    scene.add_object("walls", walls, scene.add_lambert("wall", (0.7, 0.6, 0.5)))
    (camera or pinhole)(scene)
    (lamp or one_lamp)(scene)
    for part in parts:
        part(scene)
    return scene


def pinhole(scene: Gltf) -> None:
    scene.add_camera((0, 1, 0.95), (0, 0.9, 0), yfov_degrees=60, aspect=1)


def one_lamp(scene: Gltf) -> None:
    glow = scene.add_lambert("lamp", (0, 0, 0), emission=(12, 10, 8))
    scene.add_object("lamp", lamps(1, 1.99), glow)


def lamps(row: int, height: float) -> Geometry:
    """Row times row squares that shine down, .25 square metres together, over half of the floor."""
    step, half = 1 / row, 0.25 / row
    places = [step * (i + 0.5) - 0.5 for i in range(row)]
    flat = merge(quad((x, height, z), (half, 0, 0), (0, 0, half)) for x in places for z in places)
    return flat.without("normals", "uvs")


def plaster(scene: Gltf) -> int:
    return scene.add_lambert("plaster", GREY)


def blocks(material: Material, uvs: bool = False) -> Part:
    """Two blocks on the floor, which take two fifths of the picture."""

    def add(scene: Gltf) -> None:
        index = material(scene)
        for name, (at, size, degrees) in (("short", SHORT), ("tall", TALL)):
            body = box((0, 0, 0), size).without("normals", *([] if uvs else ["uvs"]))
            scene.add_object(name, body, index, translation=at, rotation=rotation(UP, degrees))

    return add


def sheet_below(material: Material, uvs: bool = False) -> Part:
    """A square under the floor, where the light of the room does not come."""

    def add(scene: Gltf) -> None:
        sheet = floor(1, -1).without("normals", *([] if uvs else ["uvs"]))
        scene.add_object("sheet", sheet, material(scene))

    return add


# --- features -------------------------------------------------------------------------------------------------------


def features() -> list[Feature]:
    plastic = {"color": GREY, "roughness": 0.3}
    metal = {"color": GREY, "metallic": 1, "roughness": 0.3}
    phong = {"diffuse": (0.4, 0.4, 0.4), "specular": (0.3, 0.3, 0.3), "exponent": 60}
    fibres = {"sheenColorFactor": (0.3, 0.3, 0.3), "sheenRoughnessFactor": 0.5}
    absorbing = {"attenuationDistance": 0.5, "attenuationColor": [0.4, 0.8, 0.6]}
    clear = room(blocks(glass(volume={})))
    materials = [
        by_material("metallic-roughness, plastic", plain(**plastic)),
        by_material("metallic-roughness, metal", plain(**metal)),
        by_material("base colour texture", textured("even.png", lambda u, v: STORED), uvs=True),
        by_material("normal map", bumpy, uvs=True),
        by_material("Phong", extended("PARIAN_materials_phong", {}, **phong)),
        by_material("conductor by name", extended("PARIAN_materials_conductor", {"roughness": 0.3}, name="nickel")),
        by_material("clear coat", extended("KHR_materials_clearcoat", plastic, clearcoatFactor=1)),
        by_material("sheen", extended("KHR_materials_sheen", plastic, **fibres)),
        by_material("iridescence", extended("KHR_materials_iridescence", metal, iridescenceFactor=1)),
        by_material("anisotropy", extended("KHR_materials_anisotropy", metal, anisotropyStrength=0.7), uvs=True),
        by_material("alpha mask", textured("cut.png", cut, alphaMode="MASK"), uvs=True),
        by_material("alpha blend", plain((*GREY, 0.5), alphaMode="BLEND")),
        by_material("unlit", plain(extensions={"KHR_materials_unlit": {}})),
        by_material("thin glass", glass()),
        by_material("refracting glass", glass(volume={})),
        by_material("absorbing medium (against glass)", glass(volume=absorbing), without=clear),
        by_material("dispersion (against glass)", glass(volume={}, dispersion=1), without=clear),
        by_material("subsurface, auto", marble),
        by_material("subsurface, dipole", marble, options=("--sss", "dipole")),
        by_material("subsurface, random walk", marble, options=("--sss", "random-walk")),
    ]
    others = [
        Feature("sphere, cylinder (against meshes)", room(solids), solid_below, without=room(meshes)),
        Feature("instances", room(instanced(0)), instanced(-4)),
        Feature("1,024 lamps", room(blocks(plaster), lamp=many_lamps(1.99)), many_lamps(-1)),
        Feature(
            "environment (a wall missing)",
            room(blocks(plaster), sky, is_open=True),
            sky,
            without=room(blocks(plaster), is_open=True),
        ),
        Feature("thin lens", room(blocks(plaster), camera=lens), lens),
        by_options("--sampler independent"),
        by_options("--clamp 10"),
        by_options("--noise 0.001"),
        by_options("all layers", "--aov variance samples albedo normal depth object sss"),
    ]
    return [*materials, Feature(ALL_MATERIALS, None, together(materials)), *others]


def together(features: Sequence[Feature]) -> Part:
    """Out of sight."""

    def add(scene: Gltf) -> None:
        for feature in features:
            feature.outside(scene)

    return add


ALL_MATERIALS = "all materials above"


def base() -> Gltf:
    return room(blocks(plaster))


def by_material(name: str, material: Material, uvs: bool = False, **more: Any) -> Feature:
    """Both blocks have it; or a sheet out of sight."""
    return Feature(name, room(blocks(material, uvs)), sheet_below(material, uvs), **more)


def by_options(name: str, options: str = "") -> Feature:
    return Feature(name, base(), options=tuple((options or name).split()))


def plain(color: Vec = GREY, **values: Any) -> Material:
    return lambda scene: scene.add_material("plain", color, **values)


def extended(extension: str, base: dict[str, Any], **values: Any) -> Material:
    return plain(**base, extensions={extension: values})


def textured(name: str, shader: Callable[[float, float], Vec], **values: Any) -> Material:
    """A pure Lambert surface of a picture."""

    def add(scene: Gltf) -> int:
        channels = len(shader(0.5, 0.5))
        texture = scene.add_texture(scene.add_image(name, png(64, 64, channels, shader)))
        return scene.add_lambert("textured", (1, 1, 1), pbr={"baseColorTexture": scene.texture_info(texture)}, **values)

    return add


def cut(u: float, v: float) -> Vec:
    return *STORED, float((int(8 * u) + int(8 * v)) % 2)


def bumpy(scene: Gltf) -> int:
    def waves(u: float, v: float) -> Vec:
        slope = 0.3 * math.cos(16 * math.pi * u)
        return [0.5 + 0.5 * c for c in normalize((slope, 0, 1))]

    texture = scene.add_texture(scene.add_image("waves.png", png(64, 64, 3, waves)))
    return scene.add_lambert("bumpy", GREY, normalTexture=scene.texture_info(texture))


def glass(volume: Optional[dict[str, Any]] = None, dispersion: float = 0) -> Material:
    extensions: dict[str, Any] = {"KHR_materials_transmission": {"transmissionFactor": 1}}
    if volume is not None:
        extensions["KHR_materials_volume"] = {"thicknessFactor": 1, **volume}
    if dispersion:
        extensions["KHR_materials_dispersion"] = {"dispersion": dispersion}
    return lambda scene: scene.add_material("glass", roughness=0, extensions=extensions)


def marble(scene: Gltf) -> int:
    """As if the room were one of 20 cm."""
    body = {"name": "marble", "scale": 10}
    return scene.add_material("marble", roughness=0.3, extensions={"PARIAN_materials_subsurface": body})


def solids(scene: Gltf) -> None:
    material = plaster(scene)
    scene.add_shape_node("ball", scene.add_shape("sphere", radius=0.35), material, translation=(0.35, 0.35, 0.35))
    tube = scene.add_shape("cylinder", height=1.2, radiusBottom=0.35, radiusTop=0.35)
    scene.add_shape_node("tube", tube, material, translation=(-0.35, 0.6, -0.3))


def meshes(scene: Gltf) -> None:
    """The same of 960 and 128 triangles."""
    material = plaster(scene)
    scene.add_object("ball", sphere(0.35, 32, 16).without("uvs"), material, translation=(0.35, 0.35, 0.35))
    scene.add_object("tube", cylinder(0.35, 1.2, 32).without("uvs"), material, translation=(-0.35, 0, -0.3))


def solid_below(scene: Gltf) -> None:
    scene.add_shape_node("ball", scene.add_shape("sphere", radius=0.5), plaster(scene), translation=(0, -1, 0))


def instanced(height: float) -> Part:
    """The two blocks as one mesh that two nodes scale, so much higher than the floor."""

    def add(scene: Gltf) -> None:
        mesh = scene.add_mesh("block", (box((0, 0, 0), (1, 1, 1)).without("normals", "uvs"), plaster(scene)))
        for name, ((x, y, z), size, degrees) in (("short", SHORT), ("tall", TALL)):
            turn = rotation(UP, degrees)
            scene.add_node(name, mesh=mesh, translation=(x, y + height, z), rotation=turn, scale=size)

    return add


def many_lamps(height: float) -> Part:
    def add(scene: Gltf) -> None:
        glow = scene.add_lambert("lamps", (0, 0, 0), emission=(12, 10, 8))
        scene.add_object("lamps", lamps(32, height), glow)

    return add


def sky(scene: Gltf) -> None:
    picture = environment_hdr(64, 32, lambda w: mul((0.6, 0.8, 1.0), 1 + w[1]))
    scene.set_environment(scene.add_image("sky.hdr", picture))


def lens(scene: Gltf) -> None:
    values = {"focalLength": 0.035, "sensorSize": [0.036, 0.024], "fStop": 1.4, "focusDistance": 1.2}
    scene.add_camera((0, 1, 0.95), (0, 0.9, 0), yfov_degrees=60, aspect=1, name="lens", lens=values)
