"""What transmits: thin walls, slabs, nested media, prisms. Scenes of closed forms, and a still life.

Light is unpolarised at each interface, as the renderer has it. Radiance is by channel: red, green, blue.
"""

import math
from dataclasses import dataclass
from functools import reduce
from typing import Any, Callable, Sequence

from gltf_builder import Gltf
from gltf_shapes import Quat, Vec, Vec3, compose, cylinder, rotation
from image_files import environment_hdr, png, to_srgb
from scene_recipes.expectations import Expected, Region, expected, measured, region
from scene_recipes.shapes import (
    BODIES, FRONT, TURNS, UPWARDS, X_AXIS, Y_AXIS, Z_AXIS, ball, block, draw, frustum, sheet, white_sky,
)  # fmt: skip

# --- interfaces and layers ------------------------------------------------------------------------------------------

Layers = tuple[float, float, float]  # reflectance from the front and from the back, transmittance of L / n^2


def refracted(n: float, sine: float) -> float:
    """The cosine in a medium of index n of a ray whose sine in vacuum is given."""
    return math.sqrt(1 - (sine / n) ** 2)


def fresnel(before: float, after: float, sine: float) -> float:
    c1, c2 = refracted(before, sine), refracted(after, sine)
    across = (before * c1 - after * c2) / (before * c1 + after * c2)
    along = (after * c1 - before * c2) / (after * c1 + before * c2)
    return (across**2 + along**2) / 2


def interface(before: float, after: float, sine: float = 0, tint: float = 1) -> Layers:
    f = fresnel(before, after, sine)
    return f, f, (1 - f) * tint


def absorber(color: float, distance: float, path: float) -> Layers:
    """Beer and Lambert's law, as KHR_materials_volume has it."""
    return 0, 0, color ** (path / distance)


def stack(*layers: Layers) -> Layers:
    """All reflections between parallel layers, added up from the front to the back."""

    def pair(a: Layers, b: Layers) -> Layers:
        series = 1 / (1 - a[1] * b[0])
        return a[0] + a[2] ** 2 * b[0] * series, b[1] + b[2] ** 2 * a[1] * series, a[2] * b[2] * series

    return reduce(pair, layers)


# --- materials ------------------------------------------------------------------------------------------------------

WHITE = (1.0, 1.0, 1.0)
CLEAR = (WHITE, 1.0)  # attenuation colour at a distance


@dataclass(frozen=True)
class Glass:
    """A material that transmits everything; a thin wall where `thin`."""

    name: str
    ior: float = 1.5
    tint: Vec = WHITE
    attenuation: tuple[Vec, float] = CLEAR
    priority: int = 0
    dispersion: float = 0
    roughness: float = 0
    thin: bool = False

    def add_to(self, scene: Gltf, **more: dict[str, Any]) -> int:
        """`more`: other extensions, and what they add to those here."""
        extensions: dict[str, Any] = {"KHR_materials_transmission": {"transmissionFactor": 1}}
        if self.ior != 1.5:
            extensions["KHR_materials_ior"] = {"ior": self.ior}
        if not self.thin:
            volume: dict[str, Any] = {"thicknessFactor": 1}
            if self.attenuation is not CLEAR:
                volume |= {"attenuationColor": self.attenuation[0], "attenuationDistance": self.attenuation[1]}
            extensions["KHR_materials_volume"] = volume
        if self.dispersion:
            extensions["KHR_materials_dispersion"] = {"dispersion": self.dispersion}
        if self.priority:
            extensions["PARIAN_materials_priority"] = {"priority": self.priority}
        for name, object_ in more.items():
            extensions[name] = extensions.get(name, {}) | object_
        return scene.add_material(self.name, self.tint, roughness=self.roughness, extensions=extensions)

    def slab(self, thickness: float, channel: int, sine: float = 0) -> Layers:
        """Two parallel faces in air."""
        face = interface(1, self.ior, sine, self.tint[channel])
        return stack(face, self.inside(thickness / refracted(self.ior, sine), channel), face)

    def inside(self, path: float, channel: int) -> Layers:
        return absorber(self.attenuation[0][channel], self.attenuation[1], path)


# --- a grid of cells under a parallel camera ------------------------------------------------------------------------

CELL = 24  # pixels of a cell's side, 1 m
BLUR = 0.4155  # pixels: the standard deviation of the film's filter along an axis (Blackman-Harris, radius 1.5)


@dataclass
class Grid:
    """Cells of 1 m, side by side for a parallel camera, each `apart` metres behind the one before. They are about the
    origin: the larger the coordinates, the more do offsets against rounding take from a path in a medium."""

    columns: int
    rows: int
    apart: float

    def add_camera(self, scene: Gltf) -> None:
        depth = self.apart * (self.columns * self.rows + 1)
        scene.add_orthographic_camera((0, 0, depth / 2), FRONT, self.columns / 2, self.rows / 2, zfar=depth)

    def size(self) -> tuple[int, int]:
        return self.columns * CELL, self.rows * CELL

    def centre(self, cell: int) -> Vec3:
        column, row = cell % self.columns, cell // self.columns
        depth = self.apart * (cell + 0.5 - self.columns * self.rows / 2)
        return column + 0.5 - self.columns / 2, self.rows / 2 - row - 0.5, -depth

    def area(self, cell: int, x0: float, y0: float, x1: float, y1: float) -> Region:
        """In pixels of the cell, from its top left; whole ones."""
        left, top = cell % self.columns * CELL, cell // self.columns * CELL
        width, height = self.size()
        return (left + x0) / width, (top + y0) / height, (left + x1) / width, (top + y1) / height

    def whole(self, cell: int) -> Region:
        return self.area(cell, 0, 0, CELL, CELL)

    def middle(self, cell: int, half: int) -> Region:
        middle = CELL // 2
        return self.area(cell, middle - half, middle - half, middle + half, middle + half)


# What is seen through a slab, and what it mirrors: to the sides the sky is as in front.
BEHIND, BEFORE = (1.0, 0.5, 0.25), (1.0, 2.0, 4.0)


def two_skies(scene: Gltf) -> None:
    """BEHIND within 25 degrees of -z, BEFORE elsewhere; what lies between is some 6 degrees wide."""
    sky = environment_hdr(64, 32, lambda w: BEHIND if w[2] < -0.9 else BEFORE)
    scene.set_environment(scene.add_image("sky.hdr", sky))


def seen(layers: Callable[[int], Layers]) -> list[float]:
    """The radiance of layers under two_skies()."""
    found = [layers(k) for k in range(3)]
    return [f[0] * before + f[2] * behind for f, before, behind in zip(found, BEFORE, BEHIND)]


def mean_of_cells(values: Sequence[tuple[float, Sequence[float]]], cells: int, rest: Vec) -> list[float]:
    """Of a picture of `cells` square metres: (area, value) of what is there, and `rest` elsewhere."""
    return [r + sum(area * (v[k] - r) for area, v in values) / cells for k, r in enumerate(rest)]


# --- glass-panes ----------------------------------------------------------------------------------------------------

TINT = (0.3, 0.6, 0.9)


def tilted(degrees: float) -> Quat:
    """Turns what faces +z upwards, so that its mirror image of the camera's rays passes above the other cells."""
    return rotation(X_AXIS, -degrees)


def glass_panes() -> tuple[Gltf, Expected]:
    """Thin walls, at several angles: F of what is before them, (1 - F) tint of what is behind."""
    scene = Gltf()
    grid = Grid(6, 2, 50)
    grid.add_camera(scene)
    two_skies(scene)
    pixels, areas = [], []

    def pane(cell: int, material: int, value: Sequence[float], degrees: float, what: str) -> None:
        turn = compose(tilted(degrees), UPWARDS)
        body = sheet(0.8, 0.8 / abs(math.cos(math.radians(degrees))))
        draw(scene, body, material, what, translation=grid.centre(cell), rotation=turn)
        pixels.append(region(grid.middle(cell, 7), value, 0.02, f"{what}, {degrees:g} degrees"))
        areas.append((0.64, value))

    clear, tinted = Glass("clear", thin=True), Glass("tinted", tint=TINT, thin=True)
    water, diamond = Glass("water", 1.33, thin=True), Glass("diamond", 2.4, (0.5, 0.9, 0.7), thin=True)
    views = ((clear, 0), (clear, 45), (clear, 60), (tinted, 0), (tinted, 60), (tinted, 135), (water, 60), (diamond, 30))
    for cell, (glass, degrees) in enumerate(views):
        sine = math.sin(math.radians(degrees))
        value = seen(lambda k: interface(1, glass.ior, sine, glass.tint[k]))
        pane(cell, glass.add_to(scene), value, degrees, f"{glass.name}: F before + (1 - F) tint behind")

    # KHR_materials_specular: f0 = color factor F(0), f90 = factor; what is transmitted is white.
    factor, color, sine = 0.6, (0.5, 1.0, 0.2), math.sin(math.radians(60))
    f0 = fresnel(1, 1.5, 0)
    rise = (fresnel(1, 1.5, sine) - f0) / (1 - f0)
    reflected = [factor * (c * f0 + (1 - c * f0) * rise) for c in color]
    coated = clear.add_to(scene, KHR_materials_specular={"specularFactor": factor, "specularColorFactor": color})
    value = seen(lambda k: (reflected[k], reflected[k], 1 - max(reflected)))
    pane(8, coated, value, 60, "specular: f before + (1 - max f) behind, f = f0 + (f90 - f0) (F - F0) / (1 - F0)")

    # The texture's red channel: 1 on the left, 0 on the right, against its green and blue. Without a coat.
    factor, half = 0.75, scene.add_image("left.png", png(16, 16, 3, lambda u, v: [u < 0.5, u > 0.5, u > 0.5]))
    texture = scene.texture_info(scene.add_texture(half, nearest=True))
    switched = tinted.add_to(
        scene,
        KHR_materials_transmission={"transmissionFactor": factor, "transmissionTexture": texture},
        KHR_materials_specular={"specularFactor": 0},
    )
    skies = list(zip(TINT, BEHIND, BEFORE))
    parts = [[t * (f * behind + (1 - f) * before) for t, behind, before in skies] for f in (factor, 0)]
    value = [sum(pair) / 2 for pair in zip(*parts)]
    pane(9, switched, value, 0, "transmissionTexture, both halves: tint (f behind + (1 - f) before)")
    for x, part in zip((5, 14), parts):
        pixels.append(region(grid.area(9, x, 5, x + 5, 19), part, 0.02, "one half of it, f = .75 or 0"))

    # Two panes, one behind the other.
    value = seen(lambda k: stack(*[interface(1, glass.ior, 0, glass.tint[k]) for glass in (diamond, tinted)]))
    pane(10, diamond.add_to(scene), value, 0, "two panes: T = T1 T2 / (1 - F1 F2), R = F1 + T1^2 F2 / (1 - F1 F2)")
    x, y, z = grid.centre(10)
    draw(scene, sheet(0.8, 0.8), tinted.add_to(scene), "second pane", translation=(x, y, z - 0.2), rotation=UPWARDS)

    # Without KHR_materials_specular, ior 1 is no interface.
    nothing = Glass("nothing", 1, (0.3, 0.6, 0.9), thin=True)
    value = seen(lambda k: interface(1, 1, 0, nothing.tint[k]))
    pane(11, nothing.add_to(scene), value, 0, "index 1: tint behind")
    source = "closed form: each pane's value on .64 of its cell, the sky behind on the rest"
    mean = mean_of_cells(areas, grid.columns * grid.rows, BEHIND)
    return scene, expected(
        "Thin panes over a sky that is (1, .5, .25) behind them and (1, 2, 4) before them: clear, tinted, from behind, "
        "of several indices and angles, with a specular colour, with a texture, and one behind another.",
        grid.size(), 128, source, mean, 0.005, pixels,
    )  # fmt: skip


# --- glass-slabs ----------------------------------------------------------------------------------------------------


def glass_slabs() -> tuple[Gltf, Expected]:
    """Boxes with an inside: all reflections between their faces, and what is absorbed between."""
    scene = Gltf()
    grid = Grid(5, 2, 2)
    grid.add_camera(scene)
    two_skies(scene)
    pixels = []
    thick = 0.1
    clear = Glass("clear")
    absorbing = Glass("absorbing", attenuation=((0.9, 0.6, 0.3), thick))
    image = scene.add_image("thickness.png", png(8, 8, 3, lambda u, v: [u, v, u]))
    texture = scene.texture_info(scene.add_texture(image))
    painted = {"KHR_materials_volume": {"thicknessFactor": 7, "thicknessTexture": texture}}
    views: tuple[tuple[Glass, float, dict[str, Any]], ...] = (
        (clear, 0, {}), (clear, 60, {}), (absorbing, 0, {}), (absorbing, 60, {}), (absorbing, 60, painted),
        (Glass("diamond", 2.4, attenuation=((0.5, 0.8, 1.0), thick)), 0, {}),
        (Glass("fog", 1, attenuation=((0.7, 0.5, 0.3), 2 * thick)), 60, {}),
        (Glass("tinted water", 1.33, TINT), 60, {}),
        (Glass("tinted and absorbing", 1.7, (0.4, 0.7, 0.9), ((0.3, 0.5, 0.9), 0.3)), 30, {}),
    )  # fmt: skip
    for cell, (glass, degrees, more) in enumerate(views):
        radians = math.radians(degrees)
        body, turn = block(0.8, 0.8 / math.cos(radians), thick), tilted(degrees)
        draw(scene, body, glass.add_to(scene, **more), glass.name, translation=grid.centre(cell), rotation=turn)
        value = seen(lambda k: glass.slab(thick, k, math.sin(radians)))
        what = f"{glass.name}{', thickness textured' if more else ''}, {degrees:g} degrees: R before + T behind, "
        what += "T = (1 - F)^2 tint^2 t / (1 - F^2 t^2)"
        pixels.append(region(grid.area(cell, 5, 7, 19, 17), value, 0.02, what))
    # What counts is the length in the world, in a node that is mirrored and scaled as well.
    material, scale = absorbing.add_to(scene), (-0.8, 0.8, 2 * thick)
    draw(scene, block(1, 1, 1), material, "scaled", translation=grid.centre(9), scale=scale)
    value = seen(lambda k: absorbing.slab(2 * thick, k))
    pixels.append(region(grid.middle(9, 7), value, 0.02, "absorbing, scaled to twice the thickness and mirrored"))
    return scene, expected(
        "Slabs over the sky of glass-panes: clear and absorbing, straight and tilted, one with a thickness texture (of "
        "no effect), one of index 1, one tinted, one scaled.",
        grid.size(), 200, "closed form, see its regions", None, 0.005, pixels,
    )  # fmt: skip


# --- glass-nested ---------------------------------------------------------------------------------------------------

EMISSION = (4.0, 2.0, 1.0)


def glass_nested() -> tuple[Gltf, Expected]:
    """Media that touch, overlap or are apart, in layers, and glass around a lamp."""
    scene = Gltf()
    grid = Grid(4, 2, 2)
    grid.add_camera(scene)
    two_skies(scene)
    glass = Glass("glass", attenuation=((0.8, 0.95, 0.9), 0.1), priority=1)
    water = Glass("water", 1.33, attenuation=((0.5, 0.8, 0.95), 0.2))
    strong_water = Glass("water above glass", 1.33, attenuation=water.attenuation, priority=2)
    air = Glass("air", 1)
    materials = {g: g.add_to(scene) for g in (glass, water, strong_water, air)}
    lamp = scene.add_lambert("lamp", (0, 0, 0), emission=EMISSION)
    pixels, areas = [], []

    def add(cell: int, value: Sequence[float], what: str, *parts: tuple[Glass, float, float]) -> None:
        """Slabs of (material, from, to), in metres before the cell's centre."""
        x, y, z = grid.centre(cell)
        for material, near, far in parts:
            at = (x, y, z + (near + far) / 2)
            draw(scene, block(0.8, 0.8, near - far), materials[material], f"{material.name} {cell}", translation=at)
        pixels.append(region(grid.middle(cell, 7), value, 0.02, what))
        areas.append((0.64, value))

    def sandwich(wall: float, inner: float) -> list[float]:
        """Glass, water, glass."""
        outside, contact = interface(1, glass.ior), interface(glass.ior, water.ior)

        def layers(k: int) -> Layers:
            return stack(
                outside, glass.inside(wall, k), contact, water.inside(inner, k), contact, glass.inside(wall, k), outside
            )

        return seen(layers)

    walls = ((glass, 0.2, 0.1), (glass, -0.1, -0.2))
    add(0, sandwich(0.1, 0.2), "water that touches its glass", *walls, (water, 0.1, -0.1))
    add(1, sandwich(0.1, 0.2), "water that reaches into glass of a higher priority", *walls, (water, 0.13, -0.15))
    add(2, sandwich(0.07, 0.26), "water of a higher priority", *walls, (strong_water, 0.13, -0.13))
    apart = seen(lambda k: stack(glass.slab(0.1, k), water.slab(0.16, k), glass.slab(0.1, k)))
    add(3, apart, "gaps of air between glass and water", *walls, (water, 0.08, -0.08))
    full = seen(lambda k: glass.slab(0.4, k))
    add(4, full, "water inside glass of a higher priority is not there", (glass, 0.2, -0.2), (water, 0.1, -0.1))
    bubble = seen(lambda k: stack(water.slab(0.1, k), water.slab(0.2, k)))
    add(5, bubble, "a bubble in water of the same priority", (water, 0.2, -0.2), (air, 0.1, 0.0))

    # Lamps in media: n^2 times as much radiance is in there.
    def lit(medium: float, layers: Callable[[int], Layers]) -> list[float]:
        found = [layers(k) for k in range(3)]
        return [f[0] * before + f[2] * le / medium**2 for f, before, le in zip(found, BEFORE, EMISSION)]

    def glass_on_water(k: int) -> Layers:
        contact = interface(glass.ior, water.ior)
        return stack(interface(1, glass.ior), glass.inside(0.1, k), contact, water.inside(0.1, k))

    for cell, reach in ((6, 0.1), (7, 0.15)):
        what = f"a lamp in water {'touching' if reach == 0.1 else 'reaching into'} glass: R before + T Le / 1.33^2"
        add(cell, lit(water.ior, glass_on_water), what, (glass, 0.2, 0.1), (water, reach, -0.2))
        x, y, z = grid.centre(cell)
        draw(scene, sheet(0.8, 0.8), lamp, f"lamp {cell}", translation=(x, y, z), rotation=UPWARDS)

    source = "closed form: each slab's value on .64 of its cell, the sky behind on the rest"
    return scene, expected(
        "Glass and water over the sky of glass-panes: touching, overlapping by priority, apart, a bubble, and black "
        "lamps in the water.",
        grid.size(), 128, source, mean_of_cells(areas, grid.columns * grid.rows, BEHIND), 0.005, pixels,
    )  # fmt: skip


# --- glass-furnace --------------------------------------------------------------------------------------------------


def glass_furnace() -> tuple[Gltf, Expected]:
    """Bodies under a white sky that absorb nothing: 1, whatever their shape, index, dispersion and roughness."""
    scene = Gltf()
    grid = Grid(7, 3, 30)
    grid.add_camera(scene)
    white_sky(scene)
    rows = ((1.5, 1.33, 2.4, 1.5, 1.1, 1.5, 1.7), (2.4, 1.5, 1.33, 1.7, 1.5, 1.7, 1.1))
    for cell, ior in enumerate(rows[0] + rows[1]):
        body, turn = BODIES[cell % 7], rotation(*TURNS[cell % 7])
        material = Glass(f"index {ior}", ior, thin=body.kind == "plane").add_to(scene)
        if cell < 7:
            turn = compose(rotation(Z_AXIS, 20 + 25 * cell), turn)
            draw(scene, body, material, f"turned {body.name}", translation=grid.centre(cell), rotation=turn)
            continue
        child = draw(scene, body, material, f"stretched {body.name}", rotation=turn)
        factors = (-1.1, 0.8, 1.3) if cell % 2 else (0.75, 1.02, 0.6)
        scene.add_node(f"stretch {cell}", translation=grid.centre(cell), scale=factors, children=[child])
    for radius, ior in ((0.4, 1.5), (0.3, 1.33), (0.2, 1.0), (0.1, 2.4)):
        draw(scene, ball(radius), Glass("nested", ior).add_to(scene), "nested", translation=grid.centre(14))
    hollow = Glass("thin", thin=True).add_to(scene)
    draw(scene, ball(0.4), hollow, "thin", translation=grid.centre(15))
    exact = (*grid.whole(0)[:2], *grid.whole(13)[2:]), (*grid.whole(14)[:2], *grid.whole(15)[2:])
    what = ("clear bodies of every shape: 1", "four balls in one another, and a thin one: 1")
    pixels = [region(area, WHITE, 3e-4, text) for area, text in zip(exact, what)]
    disperses = Glass("disperses", 1.6, dispersion=1).add_to(scene)
    for cell in (16, 17, 18):
        turn = compose(rotation(Z_AXIS, 40), rotation(*TURNS[cell - 15]))
        draw(scene, BODIES[cell - 15], disperses, "disperses", translation=grid.centre(cell), rotation=turn)
    area = (*grid.whole(16)[:2], *grid.whole(18)[2:])
    pixels.append(region(area, WHITE, 0.005, "cylinder, cone and box that disperse: 1 in each channel"))
    for cell, frosted in ((19, Glass("frosted", roughness=0.6)), (20, Glass("frosted thin", roughness=0.8, thin=True))):
        draw(scene, ball(0.4), frosted.add_to(scene), frosted.name, translation=grid.centre(cell))
        text = f"{frosted.name} ball: 1, with what its facets scatter more than once"
        pixels.append(region(grid.whole(cell), WHITE, 0.005, text))
    return scene, expected(
        "Clear glass under a white sky: every shape turned, stretched and mirrored, balls in one another, a thin one, "
        "glass that disperses, frosted balls: nothing is to be seen but noise.",
        grid.size(), 64, "closed form: 1", WHITE, 0.001, pixels,
    )  # fmt: skip


# --- glass-balls ----------------------------------------------------------------------------------------------------

LAMP_IN_GLASS, BALL = 0.3, 0.4  # radii


def glass_balls() -> tuple[Gltf, Expected]:
    """Balls that absorb, and balls with a lamp inside, under a white sky, too far apart to light each other."""
    scene = Gltf()
    grid = Grid(3, 3, 30)
    grid.add_camera(scene)
    white_sky(scene)
    pixels: list[Expected] = []
    values = add_absorbing_balls(scene, grid, pixels) + add_lamps_in_balls(scene, grid, pixels)
    source = "closed form: the integrals over the balls' disks, 1 elsewhere"
    return scene, expected(
        "Balls under a white sky: absorbing, of several indices; tinted, solid and thin; and black lamps in glass and "
        "in diamond.",
        grid.size(), 256, source, [sum(column) / len(values) for column in zip(*values)], 0.002, pixels,
    )  # fmt: skip


def add_absorbing_balls(scene: Gltf, grid: Grid, pixels: list[Expected]) -> list[list[float]]:
    """The first seven cells; returns their means."""
    balls = (
        Glass("e^-1 across", attenuation=((math.exp(-1), 0.6, 0.2), 2 * BALL)),
        Glass("water", 1.33, attenuation=((0.3, 0.6, 0.9), BALL)),
        Glass("index 1", 1, attenuation=((0.5, 0.3, 0.1), BALL)),
        Glass("diamond", 2.4, attenuation=((0.2, 0.4, 0.7), BALL)),
        Glass("tinted", tint=TINT),
        Glass("tinted and absorbing", 1.7, (0.9, 0.7, 0.8), ((0.4, 0.8, 0.6), BALL)),
        Glass("thin", 1.5, TINT, thin=True),
    )
    values = []
    for cell, glass in enumerate(balls):
        draw(scene, ball(BALL), glass.add_to(scene), glass.name, translation=grid.centre(cell))

        def radiance(impact: float, k: int, glass: Glass = glass) -> float:
            """The chords of all reflections are equally long."""
            sine = impact / BALL
            f, _, t = interface(1, glass.ior, sine, glass.tint[k])
            tau = 1 if glass.thin else glass.inside(2 * BALL * refracted(glass.ior, sine), k)[2]
            return f + t * t * tau / (1 - f * tau)

        text = f"{glass.name}: F + (1 - F)^2 tint^2 t / (1 - F t)"
        values.append(add_ball_regions(grid, cell, radiance, text, pixels))
    return values


def add_lamps_in_balls(scene: Gltf, grid: Grid, pixels: list[Expected]) -> list[list[float]]:
    """Black lamps so large that every ray into the ball around them ends there. Radiance inside is n^2 as much."""
    lamp = scene.add_lambert("lamp", (0, 0, 0), emission=EMISSION)
    values = []
    for cell, glass in ((7, Glass("glass")), (8, Glass("diamond", 2.4))):
        assert LAMP_IN_GLASS * glass.ior > BALL
        draw(scene, ball(BALL), glass.add_to(scene), f"around a lamp: {glass.name}", translation=grid.centre(cell))
        draw(scene, ball(LAMP_IN_GLASS), lamp, "lamp", translation=grid.centre(cell))

        def radiance(impact: float, k: int, ior: float = glass.ior) -> float:
            f = fresnel(1, ior, impact / BALL)
            return f + (1 - f) * EMISSION[k] / ior**2

        values.append(add_ball_regions(grid, cell, radiance, f"a lamp in {glass.name}: F + (1 - F) Le / n^2", pixels))
    return values


def add_ball_regions(
    grid: Grid, cell: int, radiance: Callable[[float, int], float], text: str, pixels: list[Expected]
) -> list[float]:
    """The cell, the ball's middle and a part of its right, where radiance depends on the distance from the axis and the
    channel; returns the mean of the cell. (Where it bends, the film's filter would show: its two points per axis.)"""
    steps = 2048
    impacts = [BALL * math.sqrt((i + 0.5) / steps) for i in range(steps)]
    whole = [1 - math.pi * BALL**2 * (1 - sum(radiance(b, k) for b in impacts) / steps) for k in range(3)]
    pixels.append(region(grid.whole(cell), whole, 0.005, f"{text}, averaged over the cell"))
    for x0, y0, x1, y1 in ((8, 8, 16, 16), (16, 8, 19, 16)):
        at_x, at_y = [
            [(a / 8 + 1 / 16 - CELL / 2 + blur) / CELL for a in range(8 * low, 8 * high) for blur in (-BLUR, BLUR)]
            for low, high in ((x0, x1), (y0, y1))
        ]
        points = [math.hypot(x, y) for x in at_x for y in at_y]
        value = [sum(radiance(b, k) for b in points) / len(points) for k in range(3)]
        pixels.append(region(grid.area(cell, x0, y0, x1, y1), value, 0.04, text))
    return whole


# --- glass-inside ---------------------------------------------------------------------------------------------------


def glass_inside() -> tuple[Gltf, Expected]:
    """From inside glass, upwards: the whole sky in Snell's window, n^2 as bright, and around it the black bottom."""
    scene = Gltf()
    white_sky(scene)
    glass = Glass("glass", attenuation=((1.0, 0.8, 0.6), 1.0))
    draw(scene, block(200, 3, 200), glass.add_to(scene), "glass", translation=(0, -0.5, 0))  # its top at y = 1
    draw(scene, sheet(190, 190), scene.add_lambert("bottom", (0, 0, 0)), translation=(0, -1, 0))
    scene.add_camera((0, 0, 0), (0, 1, 0), yfov_degrees=90, aspect=1)

    def radiance(distance: float, k: int) -> float:
        """At a place of the image at distance 1 from the eye."""
        length = math.hypot(1, distance)
        sine = glass.ior * distance / length
        if sine >= 1:
            return 0
        return glass.ior**2 * interface(glass.ior, 1, sine)[2] * glass.inside(length, k)[2]

    edge = 1 / math.sqrt(glass.ior**2 - 1)
    steps = 4096
    at = [edge * math.sqrt((i + 0.5) / steps) for i in range(steps)]
    mean = [math.pi * edge**2 / 4 * sum(radiance(d, k) for d in at) / steps for k in range(3)]
    pixels = []
    size = 64
    text = "n^2 (1 - F) t"
    for x0, y0, x1, y1, what in ((30, 30, 34, 34, "above"), (48, 28, 52, 36, "aslant"), (30, 8, 34, 12, "aslant")):
        at_x, at_y = [[(a + 0.5) / 256 - 1 for a in range(8 * b, 8 * e)] for b, e in ((x0, x1), (y0, y1))]
        points = [math.hypot(x, y) for x in at_x for y in at_y]
        value = [sum(radiance(d, k) for d in points) / len(points) for k in range(3)]
        pixels.append(region((x0 / size, y0 / size, x1 / size, y1 / size), value, 0.005, f"{text}, {what}"))
    pixels.append(region((0, 0, 0.125, 0.125), (0, 0, 0), 0.01, "total reflection of the black bottom"))
    source = f"closed form: n^2 (1 - F) t over the disk of radius 1 / sqrt(n^2 - 1), t by a path of 1 / cos"
    return scene, expected(
        "A camera inside glass of index 1.5 looks up to a white sky: a window of 2.25 (1 - F), 2.16 in red straight "
        "above, absorbed with the path in green and blue, and black around it.",
        (size, size), 64, source, mean, 0.005, pixels,
    )  # fmt: skip


# --- glass-prism ----------------------------------------------------------------------------------------------------

PRISM = Glass("prism", 1.6, dispersion=1)
APEX = 60.0  # degrees
SLIT, SLIT_TEXEL = 51.0, 2.0  # degrees from -z towards +x, the centre of a texel; and how wide that is
SLIT_RADIANCE = 1.25
PEAKS, WIDTHS = (605, 542, 452), (30, 32, 22)  # nanometres: each channel's response to wavelengths is a normal density


def cauchy(glass: Glass, wavelength: float) -> float:
    """KHR_materials_dispersion: n = A + B / l^2 through n(d) and the Abbe number of the lines F, d, C."""
    f, d, c = (1 / line**2 for line in (486.1, 587.6, 656.3))
    return glass.ior + (glass.ior - 1) * glass.dispersion / 20 / (f - c) * (1 / wavelength**2 - d)


def deviation(n: float, incidence: float) -> tuple[float, float]:
    """Degrees by which a prism turns a ray that meets it at an angle; and the share that gets through both faces."""
    first = math.sin(math.radians(incidence))
    inside = math.radians(APEX) - math.asin(first / n)
    second = n * math.sin(inside)
    if second >= 1:
        return math.inf, 0
    through = (1 - fresnel(1, n, first)) * (1 - fresnel(1, n, second))
    return incidence + math.degrees(math.asin(second)) - APEX, through


def incidence_for(n: float) -> float:
    """The angle at which a prism must be met to turn a ray to the slit; less than for the least deviation."""
    low, high = math.degrees(math.asin(n * math.sin(math.radians(APEX) - math.asin(1 / n)))), 50.0
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if deviation(n, middle)[0] > SLIT else (low, middle)
    return low


def glass_prism() -> tuple[Gltf, Expected]:
    """Prisms before a slit of light, each turned so that it sees the slit in another wavelength."""
    scene = Gltf()
    grid = Grid(6, 2, 2)
    grid.add_camera(scene)

    def slit(w: Vec3) -> Vec:
        """One column of texels, which shows as a tent between its neighbours."""
        from_back = math.degrees(math.atan2(w[0], -w[2]))
        return (SLIT_RADIANCE if abs(from_back - SLIT) < SLIT_TEXEL / 2 else 0.0,) * 3

    scene.set_environment(scene.add_image("slit.hdr", environment_hdr(round(360 / SLIT_TEXEL), 8, slit)))
    pixels = []
    body = cylinder(0.4, 0.8, segments=3).moved((0, -0.4, 0)).without("normals", "uvs")
    plain = Glass("prism without dispersion", PRISM.ior)
    materials = {glass: glass.add_to(scene) for glass in (PRISM, plain)}

    def prism(cell: int, glass: Glass, incidence: float, value: Sequence[float], tolerance: float, what: str) -> None:
        turn = rotation(Y_AXIS, 90 - incidence)
        scene.add_object(what, body, materials[glass], translation=grid.centre(cell), rotation=turn)
        # The lit face, from the apex on the left; what enters near its end meets the base.
        apex = 0.4 * math.cos(math.radians(210 - incidence))
        along = 0.4 * math.sqrt(3) * math.cos(math.radians(incidence))
        left, right = (math.ceil(CELL * (0.5 + apex + share * along)) for share in (0.14, 0.76))
        pixels.append(region(grid.area(cell, left, 4, right, 20), value, tolerance, what))

    def tent(n: float, incidence: float) -> float:
        turned, through = deviation(n, incidence)
        return through * SLIT_RADIANCE * max(0.0, 1 - abs(turned - SLIT) / SLIT_TEXEL)

    for cell, wavelength in enumerate((620, 590, 560, 530, 490, 450)):
        incidence = incidence_for(cauchy(PRISM, wavelength))
        value = []
        for peak, width in zip(PEAKS, WIDTHS):
            steps = [(i + 0.5) / 100 for i in range(-500, 500)]
            total = sum(math.exp(-s * s / 2) * tent(cauchy(PRISM, peak + s * width), incidence) for s in steps)
            value.append(total / 100 / math.sqrt(2 * math.pi))
        prism(cell, PRISM, incidence, value, 0.05, f"{wavelength} nm at the slit: the integral of response, T and slit")
    for cell, offset in enumerate((-1.0, -0.5, 0.0, 0.6, 1.2, 5.0), 6):
        incidence = incidence_for(PRISM.ior) + offset
        value = [tent(PRISM.ior, incidence)] * 3
        prism(cell, plain, incidence, value, 0.01, f"no dispersion, {offset:g} degrees from the slit: T slit")
    return scene, expected(
        "Prisms that disperse, before a slit of light: turned from one to the next, they show it red, yellow, green, "
        "blue. Below, prisms that do not, which show it white or not.",
        grid.size(), 320, "closed form, see its regions", None, 0.01, pixels,
    )  # fmt: skip


# --- glass-still-life -----------------------------------------------------------------------------------------------


def glass_still_life() -> tuple[Gltf, Expected]:
    """A glass of water, balls with bubbles, a frosted cube, a prism, panes and a soap bubble on a checked cloth."""
    scene = Gltf()
    add_cloth(scene)
    add_glass_of_water(scene, (-1.0, 0, -0.05))
    add_paperweights(scene)
    amber = Glass("frosted amber", attenuation=((0.9, 0.6, 0.2), 0.5), roughness=0.3)
    turn = rotation(Y_AXIS, 32)
    cube = block(0.5, 0.5, 0.5)
    draw(scene, cube, amber.add_to(scene), "frosted cube", translation=(0.62, 0.251, -0.4), rotation=turn)
    flint = Glass("flint", 1.65, dispersion=0.9).add_to(scene)
    body = cylinder(0.27, 0.62, segments=3).without("normals", "uvs")
    scene.add_object("prism", body, flint, translation=(1.12, 0.001, 0.55), rotation=rotation(Y_AXIS, 68))
    for i, (tint, x) in enumerate((((0.95, 0.35, 0.3), 1.18), ((0.3, 0.65, 0.95), 1.5))):
        pane = Glass(f"pane {i}", tint=tint, thin=True).add_to(scene)
        turn = compose(rotation(Y_AXIS, -20), UPWARDS)
        at = (x, 0.45 + 0.1 * i, -0.95 - 0.2 * i)
        draw(scene, sheet(0.55, 0.9), pane, f"pane {i}", translation=at, rotation=turn)

    def thickness(u: float, v: float) -> Vec:
        """In the green channel: it flows down, in waves."""
        return 0, 0.8 * v + 0.1 * math.sin(9 * v + 2 * math.sin(2 * math.pi * u)) * v * (1 - v), 0

    texture = scene.add_texture(scene.add_image("soap.png", png(64, 64, 3, thickness)))
    film: dict[str, Any] = {"iridescenceFactor": 1, "iridescenceIor": 1.33}
    film |= {"iridescenceThicknessMinimum": 80, "iridescenceThicknessMaximum": 900}
    film["iridescenceThicknessTexture"] = scene.texture_info(texture)
    soap = Glass("soap", 1.33, thin=True).add_to(scene, KHR_materials_iridescence=film)
    draw(scene, ball(0.3), soap, "soap bubble", translation=(-0.02, 1.1, -0.5))
    sky = environment_hdr(32, 16, lambda w: [c * (0.35 + 0.25 * w[1]) for c in (0.8, 0.9, 1.0)])
    scene.set_environment(scene.add_image("sky.hdr", sky))
    scene.add_rect_light("window", (1, 0.96, 0.9), 10, (2.4, 1.8), (-2.6, 2.6, 1.6), (0, 0.4, 0))
    scene.add_camera((0.1, 1.6, 5.4), (0.08, 0.55, 0), yfov_degrees=26, aspect=1.5)
    return scene, measured(
        "A glass of water with a pencil in it, a ball of green glass with bubbles, a blue drop, a frosted cube, a "
        "prism, tinted panes and a soap bubble."
    )


def add_cloth(scene: Gltf) -> None:
    """A checked cloth on the table and up the wall."""

    def checks(u: float, v: float) -> Vec:
        lines = (u < 0.5) + (v < 0.5)
        return [to_srgb(c) for c in ((0.62, 0.6, 0.55), (0.4, 0.42, 0.45), (0.12, 0.16, 0.22))[lines]]

    texture = scene.add_texture(scene.add_image("checks.png", png(32, 32, 3, checks)), nearest=True)
    cloth = scene.add_lambert(
        "cloth", WHITE, pbr={"baseColorTexture": scene.texture_info(texture, transform={"scale": [24, 24]})}
    )
    draw(scene, sheet(8, 8), cloth, "table", translation=(0, 0, 1.2))
    wall = scene.add_lambert("wall", (0.55, 0.5, 0.45))
    draw(scene, sheet(12, 6), wall, "wall", translation=(0, 3, -1.9), rotation=UPWARDS)


def add_glass_of_water(scene: Gltf, at: Vec) -> None:
    """Solid glass, in which priorities hollow out air and water: their walls are where the higher one ends."""
    glass = Glass("tumbler", attenuation=((0.85, 0.95, 0.9), 0.2), priority=1)
    air = Glass("inside of the tumbler", 1, priority=2)
    water = Glass("water", 1.33, attenuation=((0.6, 0.85, 0.95), 1), priority=3)
    parts = []
    for material, bottom, top in ((glass, 0.001, 1.0), (air, 0.09, 1.05), (water, 0.089, 0.66)):
        wall = 0.03 if material is not glass else 0

        def radius(y: float, wall: float = wall) -> float:
            return 0.27 + 0.09 * y - wall

        body = frustum(material.name, top - bottom, radius(bottom), radius(top))
        parts.append(draw(scene, body, material.add_to(scene), translation=(0, (bottom + top) / 2, 0)))
    pencil = scene.add_lambert("pencil", (0.85, 0.5, 0.04))
    lead = scene.add_lambert("lead", (0.05, 0.05, 0.06))
    lean = rotation(Z_AXIS, -19)
    parts += [
        draw(scene, frustum("pencil", 1.2, 0.035, 0.035), pencil, translation=(0.147, 0.7, -0.05), rotation=lean),
        draw(scene, frustum("end", 0.08, 0.035, 0.035), lead, translation=(0.355, 1.305, -0.05), rotation=lean),
    ]
    scene.add_node("glass of water", translation=at, children=parts)


def add_paperweights(scene: Gltf) -> None:
    """A ball with bubbles of air (of equal priority: what a ray entered last is there), and a drop."""
    green = Glass("green glass", 1.52, attenuation=((0.25, 0.75, 0.4), 0.5)).add_to(scene)
    air = Glass("air", 1).add_to(scene)
    parts = [draw(scene, ball(0.34), green, "green ball")]
    bubbles = ((0.1, 0, 0.05, 0.05), (0.05, -0.14, -0.1, 0.08), (0.06, 0.13, -0.13, 0.02), (0.04, 0.1, 0.17, 0.1))
    for radius, *at in bubbles:
        parts.append(draw(scene, ball(radius), air, "bubble", translation=at))
    scene.add_node("paperweight", translation=(-0.2, 0.341, 0.5), children=parts)
    blue = Glass("blue glass", 1.5, attenuation=((0.2, 0.4, 0.85), 0.3)).add_to(scene)
    at, turn, scale = (0.34, 0.141, 0.95), rotation(Y_AXIS, 25), (0.5, 0.28, 0.36)
    draw(scene, ball(0.5), blue, "drop", translation=at, rotation=turn, scale=scale)
