"""Bodies that scatter light, of which it is known what they give back."""

import math
from dataclasses import dataclass
from typing import Any, Callable, Sequence

from gltf_builder import Gltf
from gltf_shapes import Vec, Vec3, box, rotation, sphere, torus
from scene_recipes.expectations import Expected, Region, expected, region
from scene_recipes.glass import BLUR, fresnel
from scene_recipes.shapes import FRONT, X_AXIS, ball, block, draw, frustum, sheet, white_sky
from scene_recipes.subsurface_forms import (
    MEASURED, Medium, given_back, given_back_of_diffuse, medium, mirrored_from_all_sides, seen,
)  # fmt: skip

WHITE = (1.0, 1.0, 1.0)


def add_body(scene: Gltf, name: str, what: Medium, scale: float = 1, color: Vec = WHITE) -> int:
    """A smooth material."""
    extensions = {"PARIAN_materials_subsurface": what.extension(scale)}
    return scene.add_material(name, color, roughness=0, extensions=extensions)


def by_method(method: str, out: Expected) -> Expected:
    """To be rendered with `--sss method`."""
    return {**out, "sss": method}


@dataclass
class Grid:
    """Cells of 1 m before a parallel camera that looks along -z, of few pixels, for many samples each; every one stands
    `apart` metres behind the one before."""

    columns: int
    rows: int
    cell: int  # pixels of a side
    apart: float = 0

    def add_camera(self, scene: Gltf) -> None:
        depth = self.apart * self.columns * self.rows / 2 + 2
        scene.add_orthographic_camera((0, 0, depth), FRONT, self.columns / 2, self.rows / 2, zfar=2 * depth)

    def size(self) -> tuple[int, int]:
        return self.columns * self.cell, self.rows * self.cell

    def centre(self, cell: int) -> Vec3:
        column, row = cell % self.columns, cell // self.columns
        depth = self.apart * (cell + 0.5 - self.columns * self.rows / 2)
        return column + 0.5 - self.columns / 2, self.rows / 2 - row - 0.5, -depth

    def area(self, cell: int, inset: int = 0) -> Region:
        """The cell without so many pixels at its sides."""
        left, top = cell % self.columns * self.cell + inset, cell // self.columns * self.cell + inset
        side, (width, height) = self.cell - 2 * inset, self.size()
        return left / width, top / height, (left + side) / width, (top + side) / height


# --- subsurface-balls -----------------------------------------------------------------------------------------------

RADIUS = 0.46


def subsurface_balls() -> tuple[Gltf, Expected]:
    """Balls under a white sky, of radii from half a mean free path to 20. All of a ball is as far from each of its
    points as it is from any other: 1 - F of it is the same everywhere."""
    scene = Gltf()
    grid = Grid(3, 2, 12, apart=30)
    grid.add_camera(scene)
    white_sky(scene)
    pixels = []
    covered, missing = math.pi * RADIUS**2, [0.0, 0.0, 0.0]
    for cell, paths in enumerate((1, 3, 10, 1, 3, 10)):
        radii = (paths, 2 * paths, paths / 2)  # in mean free paths
        albedos, eta = ((0.99, 0.9, 0.5), 1.3) if cell < 3 else ((0.999, 0.95, 0.7), 1.5)
        what = medium(albedos, [RADIUS / r for r in radii], eta)
        name = f"radius {radii[0]:g}, {radii[1]:g}, {radii[2]:g}; albedo {albedos}; index {eta}"
        material = add_body(scene, name, what, scale=1 if cell % 2 else 100)
        if cell < 3:
            draw(scene, ball(RADIUS), material, name, translation=grid.centre(cell))
        else:  # as a part of a node that is mirrored, and twice as large
            child = draw(scene, ball(RADIUS / 2), material, name)
            scene.add_node(f"mirrored {cell}", translation=grid.centre(cell), scale=(-2, 2, 2), children=[child])
        shares = [what.dipole(k).ball(r) for k, r in enumerate(radii)]
        mean_f = mirrored_from_all_sides(eta)
        whole = [1 - covered * (1 - mean_f) * (1 - share) for share in shares]
        pixels.append(region(grid.area(cell), whole, 0.01, f"{name}: the mean of 1 - (1 - F) (1 - share)"))
        f = mean_mirrored(grid, eta)
        middle = [f + (1 - f) * share for share in shares]
        pixels.append(region(grid.area(cell, 3), middle, 0.05, f"{name}: F + (1 - F) share"))
        missing = [m + 1 - value for m, value in zip(missing, whole)]
    source = "closed form: share = R CDF(2 r), the dipole within a distance of the ball's width"
    mean = [1 - m / (grid.columns * grid.rows) for m in missing]
    return scene, by_method("dipole", expected(
        "Balls under a white sky, from small ones that most light misses to nearly opaque ones.",
        grid.size(), 768, source, mean, 0.003, pixels,
    ))  # fmt: skip


def mean_mirrored(grid: Grid, eta: float, inset: int = 3, steps: int = 8) -> float:
    """F over the middle of a ball, as the film's filter blurs it (by its two points per axis)."""
    half = grid.cell / 2 - inset
    at = [((i + 0.5) / steps - half + b) / grid.cell for i in range(round(2 * half * steps)) for b in (-BLUR, BLUR)]
    values = [fresnel(1, eta, math.hypot(x, y) / RADIUS) for x in at for y in at]
    return sum(values) / len(values)


# --- blocks ---------------------------------------------------------------------------------------------------------

GAP = 0.01
TINT = (0.9, 0.6, 0.8)
PATHS = (0.0005, 0.00025, 0.001)


class Blocks:
    """Thick blocks side by side under a white sky, their fronts in one plane, so that no light goes from one to the
    other. `scale` is that of PARIAN_materials_subsurface: the larger, the more of a block feels its sides; the smaller,
    the more of a mean free path is lost to offsets against rounding, where light takes a walk."""

    def __init__(self, share: Callable[[Medium, int], float], scale: float, inset: int) -> None:
        self.share, self.scale, self.inset = share, scale, inset
        self.scene, self.grid = Gltf(), Grid(3, 2, 16)
        self.pixels: list[Expected] = []
        self.grid.add_camera(self.scene)
        white_sky(self.scene)

    def add(self, name: str, material: int, value: Sequence[float], tolerance: float, text: str) -> None:
        """In the next cell: a shape, or a mesh that is mirrored and scaled to the same size."""
        cell = len(self.pixels)
        x, y, _ = self.grid.centre(cell)
        if cell % 2:
            draw(self.scene, block(1 - GAP, 1 - GAP, 0.5), material, name, translation=(x, y, -0.25))
        else:
            body = box((0, 0, 0), (1, 1, 1)).without("uvs")
            self.scene.add_object(name, body, material, translation=(x, y, -0.25), scale=(-1 + GAP, 1 - GAP, 0.5))
        self.pixels.append(region(self.grid.area(cell, self.inset), value, tolerance, f"{name}: {text}"))

    def add_all(self, measured: dict[str, float], others: float, text: str) -> None:
        """In measured materials, in one by its numbers, and in that one tinted, each with its tolerance."""
        for name, tolerance in measured.items():
            extension = {"PARIAN_materials_subsurface": {"name": name, "scale": self.scale}}
            material = self.scene.add_material(name, roughness=0, extensions=extension)
            self.add(name, material, self.values(MEASURED[name], WHITE), tolerance, text)
        numbers = medium((0.99, 0.9, 0.5), [4 * self.scale * path for path in PATHS])
        for name, color in (("by numbers", WHITE), ("tinted", TINT)):
            material = add_body(self.scene, name, numbers, self.scale, color)
            self.add(name, material, self.values(numbers, color), others, text)

    def values(self, what: Medium, color: Vec) -> list[float]:
        """A colour counts where light goes in and where it comes out."""
        return [seen(what.eta, color[k] ** 2 * self.share(what, k)) for k in range(3)]

    def expect(self, shows: str, spp: int) -> tuple[Gltf, Expected]:
        source = "closed form, see its regions"
        return self.scene, expected(shows, self.grid.size(), spp, source, None, pixels=self.pixels)


def subsurface_blocks() -> tuple[Gltf, Expected]:
    """By the dipole."""
    blocks = Blocks(lambda m, k: m.dipole(k).total, scale=0.25, inset=2)
    tolerances = {"marble": 0.006, "spectralon": 0.002, "skin1": 0.03, "ketchup": 0.03}
    blocks.add_all(tolerances, 0.025, "F + (1 - F) tint^2 R_d")
    scene, out = blocks.expect("Thick blocks of measured materials under a white sky, by the dipole.", 384)
    return scene, by_method("dipole", out)


HALF_SPACE = "F + (1 - F) tint^2 R by Chandrasekhar's H"


def by_walk(what: Medium, channel: int) -> float:
    return given_back(what.albedo(channel), what.eta)


def subsurface_auto() -> tuple[Gltf, Expected]:
    """By the model that is taken for broad bodies, scaled to the truth."""
    blocks = Blocks(by_walk, scale=0.25, inset=2)
    blocks.add_all({"marble": 0.01, "wholemilk": 0.01, "skin1": 0.015, "apple": 0.01}, 0.015, HALF_SPACE)
    return blocks.expect("Thick blocks of measured materials under a white sky, as they are rendered by default.", 384)


def subsurface_walk() -> tuple[Gltf, Expected]:
    """By walks, with the truth: and one below a diffuse interface."""
    blocks = Blocks(by_walk, scale=2, inset=4)
    blocks.add_all({"marble": 0.005, "skin1": 0.02, "skin2": 0.015}, 0.02, HALF_SPACE)
    color = (0.8, 0.5, 0.2)
    wax = scattering(blocks.scene, "wax", (0.5,) * 3, 0.001, multiscatter=color, **DIFFUSE_INTERFACE)
    value = [given_back_of_diffuse(albedo_of_color(c)) for c in color]
    blocks.add("wax", wax, value, 0.01, "R of even light without an interface")
    scene, out = blocks.expect("Thick blocks of measured materials under a white sky, by walks.", 2048)
    return scene, by_method("random-walk", out)


def scattering(
    scene: Gltf,
    name: str,
    color: Vec,
    distance: float,
    anisotropy: float = 0,
    ior: float = 1,
    multiscatter: Vec = WHITE,
    **more: Any,
) -> int:
    """KHR_materials_volume_scatter: attenuation by a colour at a distance, by scattering alone where the multi-scatter
    colour is white."""
    extensions: dict[str, Any] = {
        "KHR_materials_ior": {"ior": ior},
        "KHR_materials_volume": {"thicknessFactor": 1, "attenuationColor": color, "attenuationDistance": distance},
        "KHR_materials_volume_scatter": {"multiscatterColor": multiscatter, "scatterAnisotropy": anisotropy},
        **more,
    }
    return scene.add_material(name, roughness=0, extensions=extensions)


CLEAR_INTERFACE = {"KHR_materials_transmission": {"transmissionFactor": 1}}
DIFFUSE_INTERFACE = {
    "KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 1},
    "KHR_materials_specular": {"specularFactor": 0},
}


def albedo_of_color(color: float) -> float:
    """The single-scattering albedo of a multi-scatter colour (KHR_materials_volume_scatter)."""
    root = math.sqrt(9.59217 + 41.6808 * color + 17.7126 * color**2)
    return 1 - (4.09712 + 4.20863 * color - root) ** 2


# --- subsurface-slabs -----------------------------------------------------------------------------------------------


def subsurface_slabs() -> tuple[Gltf, Expected]:
    """Slabs that the white sky lights from both sides."""
    scene = Gltf()
    grid = Grid(3, 2, 16)
    grid.add_camera(scene)
    white_sky(scene)
    pixels = []
    path = 0.0005
    thicknesses = (0.3, 1, 3, 10, 1, 3)
    for cell, thickness in enumerate(thicknesses):
        x, y, _ = grid.centre(cell)
        what = medium((0.99, 0.9, 0.5), (path,) * 3, 1.3 if cell < 4 else 1.5)
        name = f"{thickness:g} mean free paths, index {what.eta}"
        body, depth = block(1 - GAP, 1 - GAP, thickness * path), -thickness * path / 2
        draw(scene, body, add_body(scene, name, what, scale=10), name, translation=(x, y, depth))
        value = [seen(what.eta, what.dipole(k).slab(thickness)) for k in range(3)]
        pixels.append(region(grid.area(cell, 2), value, 0.025, f"{name}: F + (1 - F) R_d (2 - CDF(thickness))"))
    return scene, by_method("dipole", expected(
        "Slabs under a white sky. What would be light from below in a thick one comes from behind.",
        grid.size(), 256, "closed form, see its regions", pixels=pixels,
    ))  # fmt: skip


# --- places beside an edge ------------------------------------------------------------------------------------------

PLACES = 48  # pixels of a row, in twos
PIXEL = 0.25  # mean free paths
FAR = 60.0  # mean free paths: where nothing is felt of a body's other sides
BESIDE = medium((0.99, 0.9, 0.5), (1.0, 1.0, 1.0))  # one mean free path is 1 m


def add_row(scene: Gltf, first: float) -> None:
    """A camera before the plane z = 0 whose picture begins at x = first."""
    half = (PLACES * PIXEL / 2, PIXEL)
    scene.add_orthographic_camera((first + half[0], 0, 2), FRONT, *half)


def row_regions(
    first: float, value: Callable[[float, int], float], parts: Sequence[tuple[int, int, float]], text: str
) -> list[Expected]:
    """The mean of value(x, channel) over pixels [begin, end), as the film's filter blurs it, to a tolerance."""
    out = []
    for begin, end, tolerance in parts:
        steps = [begin + (i + 0.5) / 4 + blur for i in range(4 * (end - begin)) for blur in (-BLUR, BLUR)]
        mean = [sum(value(first + PIXEL * at, k) for at in steps) / len(steps) for k in range(3)]
        where = f"x from {first + PIXEL * begin:g} to {first + PIXEL * end:g}"
        out.append(region((begin / PLACES, 0, end / PLACES, 1), mean, tolerance, f"{text}, {where}"))
    return out


def eighths(*tolerances: float) -> list[tuple[int, int, float]]:
    """As many of the last ones as there are tolerances."""
    begins = range(0, PLACES, PLACES // 8)[-len(tolerances) :]
    return [(begin, begin + PLACES // 8, tolerance) for begin, tolerance in zip(begins, tolerances)]


def subsurface_edge() -> tuple[Gltf, Expected]:
    """A block's edge under a white sky: light comes out of the other side too."""
    scene = Gltf()
    first = -0.5  # the sky; the edge is at x = 0
    add_row(scene, first)
    white_sky(scene)
    draw(scene, block(FAR, 2 * FAR, FAR), add_body(scene, "block", BESIDE), translation=(FAR / 2, 0, -FAR / 2))
    parts = [(4, 6, 0.04), (6, 8, 0.03), (8, 12, 0.03), (12, 18, 0.03), *eighths(*(0.025,) * 5)]

    def value(x: float, k: int) -> float:
        return seen(BESIDE.eta, BESIDE.dipole(k).edge(x))

    text = "F + (1 - F) R_d (1 - Q + tail / 2)"
    return scene, by_method("dipole", expected(
        "The edge of a block under a white sky, brighter than its faces.",
        (PLACES, 2), 4096, "closed form, see its regions", pixels=row_regions(first, value, parts, text),
    ))  # fmt: skip


SUN = (1.0, 2.0, 4.0)  # W/m^2
LIT_ON_ONE_SIDE = "E (1 - F)^2 / (pi c) R_d Q"


def half_lit() -> tuple[Gltf, float]:
    """A camera whose picture begins at the x that is returned, and a sun straight from behind it that lights the half x
    < 0 of the plane z = 0."""
    scene = Gltf()
    first = -PLACES * PIXEL / 2
    add_row(scene, first)
    scene.add_punctual_light("directional", "sun", [e / SUN[2] for e in SUN], SUN[2], (0, 0, 4), (0, 0, 0))
    screen = scene.add_lambert("screen", (0, 0, 0), double_sided=True)
    draw(scene, sheet(2 * FAR, 4 * FAR), screen, translation=(FAR, 0, 3), rotation=rotation(X_AXIS, 90))
    return scene, first


def in_half_light(x: float, channel: int) -> float:
    return SUN[channel] * BESIDE.dipole(channel).lit(-x)


def subsurface_shadow() -> tuple[Gltf, Expected]:
    """A plane of which the half x < 0 is in the sun: light comes out of the other half."""
    scene, first = half_lit()
    draw(scene, block(2 * FAR, 2 * FAR, FAR), add_body(scene, "block", BESIDE), translation=(0, 0, -FAR / 2))
    parts = eighths(0.015, 0.015, 0.03, 0.03, 0.05, 0.15, 0.15, 0.15)
    pixels = row_regions(first, in_half_light, parts, LIT_ON_ONE_SIDE)
    return scene, by_method("dipole", expected(
        "Under the edge of a shadow: light goes on below the surface.",
        (PLACES, 2), 4096, "closed form, see its regions", pixels=pixels,
    ))  # fmt: skip


def subsurface_touching() -> tuple[Gltf, Expected]:
    """Two blocks of one material that touch, one of them in the sun: no light goes from body to body."""
    scene, first = half_lit()
    material = add_body(scene, "both", BESIDE)
    for name, side in (("lit", -1), ("dark", 1)):
        draw(scene, block(FAR, 2 * FAR, FAR), material, name, translation=(side * FAR / 2, 0, -FAR / 2))
    parts = [(0, 6, 0.02), (6, 12, 0.02), (12, 18, 0.03), (18, 22, 0.04)]
    pixels = row_regions(first, in_half_light, parts, LIT_ON_ONE_SIDE)
    pixels.append(region((26 / PLACES, 0, 1, 1), (0, 0, 0), 0.01, "black: the other body"))
    return scene, by_method("dipole", expected(
        "Two blocks that touch, one in the sun and one in the shadow: only one of them is to be seen.",
        (PLACES, 2), 2048, "closed form, see its regions", pixels=pixels,
    ))  # fmt: skip


# --- subsurface-furnace ---------------------------------------------------------------------------------------------


def subsurface_furnace() -> tuple[Gltf, Expected]:
    """Bodies that absorb nothing, under a white sky."""
    scene = Gltf()
    grid = Grid(4, 3, 10, apart=30)
    grid.add_camera(scene)
    white_sky(scene)
    grey, colored = (0.2, 0.2, 0.2), (0.7, 0.3, 0.1)
    bodies = (ball(0.42), block(0.6, 0.5, 0.4), frustum("cylinder", 0.6, 0.3, 0.3), frustum("cone", 0.7, 0.35, 0))
    turn = rotation(X_AXIS, 40)
    for cell, body in enumerate(bodies):
        name, g = f"matched {body.name}", (0, 0.8, 0.8, -0.6)[cell]
        material = scattering(scene, name, grey, 0.3, g, **CLEAR_INTERFACE)
        draw(scene, body, material, name, translation=grid.centre(cell), rotation=turn)
    for cell, body in enumerate(bodies, 4):
        ior = (1.5, 1.33, 1.1, 1.5)[cell - 4]
        name = f"index {ior}, {body.name}"
        material = scattering(scene, name, grey, 0.3, 0.5 * (cell % 2), ior, **CLEAR_INTERFACE)
        draw(scene, body, material, name, translation=grid.centre(cell), rotation=turn)
    for cell, g in ((8, 0), (9, 0.8)):
        material = scattering(scene, f"colours, g {g}", colored, 0.3, g, **CLEAR_INTERFACE)
        ring = torus(0.28, 0.13, 24, 12).without("uvs")
        scene.add_object(f"ring {cell}", ring, material, translation=grid.centre(cell), rotation=turn)
    dense = scattering(scene, "diffuse interface", grey, 0.3, **DIFFUSE_INTERFACE)
    draw(scene, ball(0.42), dense, "diffuse interface", translation=grid.centre(10))
    white = medium((1, 1, 1), (0.1, 0.05, 0.2))
    mesh = sphere(0.42, 24, 12).without("uvs")
    scene.add_object("dense", mesh, add_body(scene, "dense", white), translation=grid.centre(11))
    texts = ("index 1, one way or the other: 1", "an interface around it: 1")
    pixels = []
    for row, text in enumerate(texts):
        pixels.append(region((0, row / grid.rows, 1, (row + 1) / grid.rows), WHITE, 0.0005, text))
    for cell, text in ((8, "three channels"), (9, "three channels, forwards"), (10, "diffuse"), (11, "dense")):
        pixels.append(region(grid.area(cell), WHITE, 0.015, f"{text}: 1"))
    return scene, by_method("random-walk", expected(
        "Bodies that scatter and absorb nothing, under a white sky: nothing is to be seen.",
        grid.size(), 256, "closed form: 1", WHITE, 0.001, pixels,
    ))  # fmt: skip
