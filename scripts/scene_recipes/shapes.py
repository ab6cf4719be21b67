"""Analytic shapes (KHR_implicit_shapes drawn by PARIAN_shape): two scenes of closed forms and a still life."""

import math
from dataclasses import dataclass, field
from typing import Any, Callable, Optional, Sequence

from gltf_builder import Gltf
from gltf_shapes import Quat, Vec, Vec3, add, compose, cross, dot, icosphere, mul, rotate, rotation, sub, torus
from image_files import environment_hdr, png, to_srgb
from scene_recipes.expectations import Expected, Region, expected, measured, region
from scene_recipes.furnaces import silhouette_share

X_AXIS, Y_AXIS, Z_AXIS = (1, 0, 0), (0, 1, 0), (0, 0, 1)


@dataclass
class Body:
    """A convex shape about the origin, as KHR_implicit_shapes has it."""

    name: str
    kind: str
    parameters: dict[str, Any] = field(default_factory=dict)

    def corners(self, steps: int = 1024) -> list[Vec3]:
        """Points whose convex hull it is; of a cylinder's rims, so many."""
        if self.kind == "cylinder":
            turn = [(math.cos(a), math.sin(a)) for a in (2 * math.pi * i / steps for i in range(steps))]
            half = self.parameters["height"] / 2
            rims = ((self.parameters["radiusTop"], half), (self.parameters["radiusBottom"], -half))
            return [(r * c, y, r * s) for r, y in rims for c, s in (turn if r > 0 else [(0.0, 0.0)])]
        p = self.parameters
        size = p["size"] if self.kind == "box" else (p["sizeX"], 0, p["sizeZ"])
        return [(x * size[0], y * size[1], z * size[2]) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]


def ball(radius: float) -> Body:
    return Body("sphere", "sphere", {"radius": radius})


def frustum(name: str, height: float, bottom: float, top: float) -> Body:
    """A cylinder of two radii: a cone where one of them is 0."""
    return Body(name, "cylinder", {"height": height, "radiusBottom": bottom, "radiusTop": top})


def block(*size: float) -> Body:
    return Body("box", "box", {"size": list(size)})


def sheet(x: float, z: float) -> Body:
    return Body("plane", "plane", {"sizeX": x, "sizeZ": z})


def draw(scene: Gltf, body: Body, material: int, name: Optional[str] = None, **placement: Any) -> int:
    return scene.add_shape_node(name or body.name, scene.add_shape(body.kind, **body.parameters), material, **placement)


def hull_area(points: Sequence[tuple[float, float]]) -> float:
    """The area of the convex hull of points of a plane."""
    return 4 * silhouette_share([(x, y, 0) for x, y in points], distance=1, yfov_degrees=90)


def white_sky(scene: Gltf) -> None:
    scene.set_environment(scene.add_image("white.hdr", environment_hdr(8, 4, lambda w: (1.0, 1.0, 1.0))))


# --- shapes-furnace -------------------------------------------------------------------------------------------------

CELL = 24  # pixels of a cell's side, 1 m
COLUMNS, ROWS = 7, 4
FILTER = 1.5  # pixels around a place that it shows in
APART = 50.0  # metres from a body to the next one behind it
RHO = (0.8, 0.5, 0.2)
QUADRANTS = ((230, 60, 60), (60, 200, 60), (60, 90, 230), (230, 210, 60))  # 8-bit sRGB; top left, top right, below
BODIES = (
    ball(0.4), frustum("cylinder", 0.54, 0.26, 0.26), frustum("cone", 0.56, 0.32, 0), block(0.5, 0.36, 0.42),
    frustum("frustum", 0.52, 0.34, 0.16), sheet(0.6, 0.52), frustum("upturned cone", 0.56, 0, 0.32),
)  # fmt: skip
TURNS = ((X_AXIS, 70), (X_AXIS, 35), (X_AXIS, -60), (X_AXIS, 30), (X_AXIS, -48), (X_AXIS, 65), (X_AXIS, 55))
FRONT, UPWARDS, DOWNWARDS = (0, 0, 0, 1), rotation(X_AXIS, 90), rotation(X_AXIS, -90)
# Bodies with a texture: how they are turned to the camera, and the shares of the silhouette that lie above v = .5 and
# below it.
TEXTURED = (
    (ball(0.42), FRONT, (0.5, 0.5)),
    (frustum("cylinder side", 0.76, 0.38, 0.38), FRONT, (0.5, 0.5)),
    (frustum("frustum side", 0.76, 0.4, 0.3), FRONT, (0.65 / 1.4, 0.75 / 1.4)),
    (frustum("top cap", 0.3, 0.3, 0.42), UPWARDS, (0.5, 0.5)),
    (frustum("bottom cap", 0.3, 0.42, 0.2), DOWNWARDS, (0.5, 0.5)),
    (block(0.76, 0.76, 0.5), FRONT, (0.5, 0.5)),
    (sheet(0.76, 0.76), UPWARDS, (0.5, 0.5)),
)


def shapes_furnace() -> tuple[Gltf, Expected]:
    """Convex Lambert bodies in a constant environment: rho, whatever their shape. A parallel camera sees them side by
    side, but they stand one behind the other, too far apart to light one another (by less than 1e-4)."""
    scene = Gltf()
    white_sky(scene)
    size = (COLUMNS * CELL, ROWS * CELL)
    scene.add_orthographic_camera((0, 0, 0), (0, 0, 0, 1), COLUMNS / 2, ROWS / 2, zfar=2000)
    gray = scene.add_lambert("rho .8 .5 .2", RHO)
    rows = (add_turned(scene, gray), add_stretched(scene, gray), add_quadrants(scene))
    pixels = [area for regions, _ in rows for area in regions]
    add_white_group(scene)
    white_row = (0, 3 / ROWS, 1, 1)
    pixels.append(region(white_row, (1, 1, 1), 0.002, "white bodies that touch: 1, whatever they see of one another"))
    mean = [1 - sum(missing[k] for _, missing in rows) / (COLUMNS * ROWS) for k in range(3)]
    source = "closed form: 1 - sum of c (1 - rho), c the share of the image that a body's silhouette covers: an "
    source += "ellipse of pi |m0 x m1|, m the rows of its matrix, or the convex hull of its projected corners and rims"
    return scene, expected(
        "Every analytic shape in a white furnace: turned; stretched aslant, every second one mirrored; textured in "
        "quadrants, seen upright; and, in the white row at the bottom, white ones that touch.",
        size, 128, source, mean, 0.001, pixels,
    )  # fmt: skip


def add_turned(scene: Gltf, material: int) -> tuple[list[Expected], list[float]]:
    """The first row: what its regions show, and what it lacks to the white sky, in cells."""
    pixels, covered = [], 0.0
    for column, body in enumerate(BODIES):
        turn = compose(rotation(Z_AXIS, 20 + 25 * column), rotation(*TURNS[column]))
        draw(scene, body, material, f"turned {body.name}", translation=cell_centre(column, 0), rotation=turn)
        area, whole = shadow(body, lambda v, turn=turn: rotate(turn, v))
        pixels += silhouette_regions(column, 0, area, whole)
        covered += area
    return pixels, [covered * (1 - r) for r in RHO]


def add_stretched(scene: Gltf, material: int) -> tuple[list[Expected], list[float]]:
    """The second row: turned, then scaled unequally by a parent, which shears; every second one mirrored."""
    pixels, covered = [], 0.0
    for column, body in enumerate(BODIES):
        turn = compose(rotation(Z_AXIS, 35), compose(rotation(Y_AXIS, 30), rotation(*TURNS[column])))
        factors = (-1.1, 0.8, 1.3) if column % 2 else (0.75, 1.02, 0.6)
        child = draw(scene, body, material, f"stretched {body.name}", rotation=turn)
        scene.add_node(f"stretch {column}", translation=cell_centre(column, 1), scale=factors, children=[child])
        area, whole = shadow(body, lambda v, q=turn, s=factors: tuple(a * b for a, b in zip(rotate(q, v), s)))
        pixels += silhouette_regions(column, 1, area, whole)
        covered += area
    return pixels, [covered * (1 - r) for r in RHO]


def cell_centre(column: int, row: int) -> Vec3:
    depth = APART * (1 + row * COLUMNS + column)
    return column + 0.5 - COLUMNS / 2, ROWS / 2 - row - 0.5, -depth


def shadow(body: Body, placed: Callable[[Vec], Vec3]) -> tuple[float, bool]:
    """The area of the silhouette along z of a body under a linear map, which must keep off the edge of its cell; and
    whether it covers the pixels in the middle."""
    if body.kind != "sphere":
        seen = [placed(p)[:2] for p in body.corners()]
        assert max(abs(c) for p in seen for c in p) < 0.5 - FILTER / CELL, body
        area = hull_area(seen)
        middle = (2 + FILTER) / CELL
        return area, hull_area(seen + [(x, y) for x in (-middle, middle) for y in (-middle, middle)]) < area * 1.000001
    columns = [placed(axis) for axis in (X_AXIS, Y_AXIS, Z_AXIS)]
    rows = [[c[i] for c in columns] for i in (0, 1)]
    assert body.parameters["radius"] * max(math.sqrt(dot(r, r)) for r in rows) < 0.5 - FILTER / CELL, body
    across = cross(*rows)
    return math.pi * body.parameters["radius"] ** 2 * math.sqrt(dot(across, across)), True


def pixel_region(column: int, row: int, x: int, y: int, half: int) -> Region:
    """Pixels around (x, y) of a cell."""
    width, height = COLUMNS * CELL, ROWS * CELL
    x, y = column * CELL + x, row * CELL + y
    return (x - half) / width, (y - half) / height, (x + half) / width, (y + half) / height


def silhouette_regions(column: int, row: int, area: float, covers_middle: bool) -> list[Expected]:
    middle = CELL // 2
    whole = pixel_region(column, row, middle, middle, middle)
    inside = pixel_region(column, row, middle, middle, 2)
    out = [region(whole, [1 - area * (1 - r) for r in RHO], 0.005, f"1 - c (1 - rho), c = {area:.6f}")]
    return [region(inside, RHO, 0.04, "rho"), *out] if covers_middle else out


def linear(stored: Sequence[int]) -> list[float]:
    """8-bit sRGB as the light it stands for."""
    return [((c / 255 + 0.055) / 1.055) ** 2.4 for c in stored]


def add_quadrants(scene: Gltf) -> tuple[list[Expected], list[float]]:
    """The third row: a texture whose quadrants show as the picture's quadrants on each body."""

    def shader(u: float, v: float) -> Vec:
        return [c / 255 for c in QUADRANTS[2 * (v > 0.5) + (u > 0.5)]]

    texture = scene.add_texture(scene.add_image("quadrants.png", png(16, 16, 3, shader)), nearest=True)
    painted = scene.add_lambert("quadrants", (1, 1, 1), pbr={"baseColorTexture": scene.texture_info(texture)})
    pixels, missing = [], [0.0, 0.0, 0.0]
    for column, (body, turn, shares) in enumerate(TEXTURED):
        draw(scene, body, painted, f"painted {body.name}", translation=cell_centre(column, 2), rotation=turn)
        area, _ = shadow(body, lambda v, turn=turn: rotate(turn, v))
        pixels += quadrant_regions(column, 2, body.name)
        for quadrant, stored in enumerate(QUADRANTS):
            share = area * shares[quadrant // 2] / 2
            missing = [m + share * (1 - rho) for m, rho in zip(missing, linear(stored))]
    return pixels, missing


def quadrant_regions(column: int, row: int, name: str) -> list[Expected]:
    """3 x 3 pixels of each quadrant, out of the filter's reach of the next one."""
    out = []
    for quadrant, stored in enumerate(QUADRANTS):
        right, low = quadrant % 2, quadrant // 2
        x, y = column * CELL + CELL // 2 + (2 if right else -5), row * CELL + CELL // 2 + (2 if low else -5)
        width, height = COLUMNS * CELL, ROWS * CELL
        area = (x / width, y / height, (x + 3) / width, (y + 3) / height)
        where = f"{'low' if low else 'upp'}er {'right' if right else 'left'} quadrant of the {name}"
        out.append(region(area, linear(stored), 0.1, f"{where}: rho, 8-bit sRGB {stored[0]} {stored[1]} {stored[2]}"))
    return out


def add_white_group(scene: Gltf) -> None:
    """White bodies in a row on a white board, each touching the next, as one mirrored and turned tree."""
    white = scene.add_lambert("white", (1, 1, 1))
    parts = [draw(scene, block(5.6, 0.1, 0.8), white, "white board", translation=(0, -0.35, 0))]
    left = -2.35
    for body, half in zip(BODIES, (0.4, 0.26, 0.32, 0.25, 0.34, 0.3, 0.32)):
        lift = -0.3 + (body.parameters["height"] / 2 if body.kind == "cylinder" else 0)
        lift = {"sphere": 0.1, "box": -0.12, "plane": -0.04}.get(body.kind, lift)
        turn = rotation(X_AXIS, 60) if body.kind == "plane" else None
        parts.append(draw(scene, body, white, f"white {body.name}", translation=(left + half, lift, 0), rotation=turn))
        left += 2 * half + 1e-3
    at, tilt = cell_centre(COLUMNS // 2, 3), rotation(X_AXIS, 25)
    scene.add_node("white group", translation=at, rotation=tilt, scale=(-1, 1, 1), children=parts)


# --- shapes-scales --------------------------------------------------------------------------------------------------

SCALES = (1e-2, 1.0, 1e2, 1e5, 1e7)  # of the columns
STEP = 0.32  # between columns, at distance 1 along the axis of view
PITCH = 30.0  # of the camera, downwards
HALF_WIDTH, HALF_HEIGHT = 0.81, 0.54  # of the image at distance 1
LAMP, DISK, EMITTER = 0.29, 0.02, -0.3  # how high in the image the bodies of a column are
LAMP_RADIUS, DISK_RADIUS, DISK_RHO = 0.1, 0.13, 0.6
DISK_TOLERANCE = 0.09  # lamps are chosen by power: all but the largest are found by the disks' own directions only
LAMP_LE, EMITTER_LE = (4.0, 3.0, 2.0), (1.0, 0.5, 0.25)
EMITTERS = (
    frustum("cylinder", 0.15, 0.06, 0.06), frustum("cone", 0.2, 0.09, 0), block(0.14, 0.14, 0.14),
    frustum("frustum", 0.18, 0.1, 0.05), frustum("thin cylinder", 0.2, 0.02, 0.02),
)  # fmt: skip


def shapes_scales() -> tuple[Gltf, Expected]:
    """The same column five times, larger and farther in the same proportion: each must look as large and as bright.

    A lamp (a sphere) over a Lambert disk (a thin cylinder), and below them a glowing body. The columns do not light one
    another: what is larger lies below the planes of the smaller disks, and what is smaller is too small (1e-5)."""
    scene = Gltf()
    tilt = rotation(X_AXIS, -PITCH)
    size = (150, 100)
    yfov = 2 * math.degrees(math.atan(HALF_HEIGHT))
    ahead = rotate(tilt, (0, 0, -1))
    scene.add_camera((0, 0, 0), ahead, yfov_degrees=yfov, aspect=HALF_WIDTH / HALF_HEIGHT)
    lamp = scene.add_lambert("lamp", (0, 0, 0), emission=LAMP_LE)
    glow = scene.add_lambert("glow", (0, 0, 0), emission=EMITTER_LE)
    gray = scene.add_lambert("rho .6", (DISK_RHO,) * 3)
    pixels = []
    total = [0.0, 0.0, 0.0]
    for column, (scale, body) in enumerate(zip(SCALES, EMITTERS)):
        x = (column - 2) * STEP
        spots = [(x, y, -1) for y in (LAMP, DISK, EMITTER)]
        lamp_at, disk_at, body_at = [rotate(tilt, spot) for spot in spots]
        turn = compose(rotation(Z_AXIS, 25), rotation(X_AXIS, 20 + 15 * column))
        disk = frustum("disk", 2e-4, DISK_RADIUS, DISK_RADIUS)
        parts = [
            draw(scene, scaled(ball(LAMP_RADIUS), scale), lamp, "lamp", translation=mul(lamp_at, scale)),
            draw(scene, scaled(disk, scale), gray, translation=mul(disk_at, scale)),
            draw(scene, scaled(body, scale), glow, translation=mul(body_at, scale), rotation=turn),
        ]
        scene.add_node(f"scale {scale:g}", children=parts)
        back = (*mul(tilt, -1), tilt[3])
        corners = [rotate(back, add(body_at, rotate(turn, p))) for p in body.corners()]
        lamp_area, body_area = seen_sphere(spots[0], LAMP_RADIUS), seen_body(corners, x, EMITTER)
        disk_sum = disk_integral(disk_at, lamp_at, ahead)
        for area, light in ((lamp_area, LAMP_LE), (body_area, EMITTER_LE), (disk_sum, LAMP_LE)):
            total = [t + area * le for t, le in zip(total, light)]
        frame = cell(x, LAMP, 0.16, 0.16, size)
        text = f"Le a / A, a = pi sin^2 t cos t / (cos^2 o - sin^2 t)^(3/2): a sphere of radius {LAMP_RADIUS * scale:g}"
        pixels.append(region(frame, [lamp_area / extent(frame) * le for le in LAMP_LE], 0.005, text))
        frame = cell(x, EMITTER, 0.16, 0.16, size)
        text = f"Le a / A, a the convex hull of the projected {body.name}, scale {scale:g}"
        pixels.append(region(frame, [body_area / extent(frame) * le for le in EMITTER_LE], 0.005, text))
        frame = cell(x, DISK, 0.065, 0.03, size)
        value = average_on_disk(frame, disk_at, lamp_at, tilt)
        text = f"rho Le (r / d)^2 cos, averaged: a Lambert disk under the lamp, scale {scale:g}"
        pixels.append(region(frame, [value * le for le in LAMP_LE], DISK_TOLERANCE, text))
    image = 4 * HALF_WIDTH * HALF_HEIGHT
    source = "closed form: Le a / A of the lamps (ellipses) and the glowing bodies (convex hulls), rho Le (r / d)^2 "
    source += "cos on the disks"
    return scene, expected(
        "Lamp, disk and a glowing body in five columns, at scales of .01, 1, 100, 1e5 and 1e7 (spheres of radius 1e-3 "
        "to 1e6) and as much farther away: lamps and disks look as if they were equal.",
        size, 128, source, [t / image for t in total], 0.005, pixels,
    )  # fmt: skip


def scaled(body: Body, scale: float) -> Body:
    def times(value: Any) -> Any:
        return [v * scale for v in value] if isinstance(value, list) else value * scale

    return Body(body.name, body.kind, {key: times(value) for key, value in body.parameters.items()})


def seen_sphere(centre: Vec, radius: float) -> float:
    """The area of a sphere's picture, an ellipse, at distance 1 along -z."""
    distance = math.sqrt(dot(centre, centre))
    sine2, cosine_off = (radius / distance) ** 2, -centre[2] / distance
    return math.pi * sine2 * math.sqrt(1 - sine2) / (cosine_off**2 - sine2) ** 1.5


def seen_body(corners: Sequence[Vec], x: float, y: float) -> float:
    """The area of the picture, at distance 1 along -z, of a convex body, which must keep within a frame at (x, y)."""
    seen = [(p[0] / -p[2], p[1] / -p[2]) for p in corners]
    assert all(abs(u - x) < 0.14 and abs(v - y) < 0.14 for u, v in seen)
    return hull_area(seen)


def disk_radiance(p: Vec, lamp: Vec) -> float:
    """Of a point of an upward Lambert surface, for Le = 1: the lamp is wholly above its horizon."""
    away = sub(lamp, p)
    distance2 = dot(away, away)
    return DISK_RHO * LAMP_RADIUS**2 / distance2 * away[1] / math.sqrt(distance2)


def disk_integral(centre: Vec, lamp: Vec, ahead: Vec, steps: int = 64) -> float:
    """The integral of the radiance over a disk's picture at distance 1."""
    total = 0.0
    for i in range(steps):
        radius = DISK_RADIUS * (i + 0.5) / steps
        for j in range(4 * steps):
            angle = 2 * math.pi * (j + 0.5) / (4 * steps)
            p = add(centre, (radius * math.cos(angle), 0, radius * math.sin(angle)))
            piece = radius * DISK_RADIUS / steps * 2 * math.pi / (4 * steps)
            total += disk_radiance(p, lamp) * piece * -p[1] / dot(p, ahead) ** 3
    return total


def cell(x: float, y: float, half_width: float, half_height: float, size: tuple[int, int]) -> Region:
    """Whole pixels around a place of the image plane at distance 1."""
    sides = [(x - half_width, y + half_height), (x + half_width, y - half_height)]
    corners = [((1 + a / HALF_WIDTH) / 2 * size[0], (1 - b / HALF_HEIGHT) / 2 * size[1]) for a, b in sides]
    (x0, y0), (x1, y1) = [(round(a), round(b)) for a, b in corners]
    return x0 / size[0], y0 / size[1], x1 / size[0], y1 / size[1]


def extent(area: Region) -> float:
    """Of a region, in the image plane at distance 1."""
    return (area[2] - area[0]) * 2 * HALF_WIDTH * (area[3] - area[1]) * 2 * HALF_HEIGHT


def average_on_disk(area: Region, disk: Vec, lamp: Vec, tilt: Quat, steps: int = 64) -> float:
    """The mean radiance over a region that lies within a disk's picture."""
    total = 0.0
    for i in range(steps):
        u = area[0] + (area[2] - area[0]) * (i + 0.5) / steps
        for j in range(steps):
            v = area[1] + (area[3] - area[1]) * (j + 0.5) / steps
            ray = rotate(tilt, ((2 * u - 1) * HALF_WIDTH, (1 - 2 * v) * HALF_HEIGHT, -1))
            p = mul(ray, disk[1] / ray[1])
            assert math.dist(p, disk) < DISK_RADIUS
            total += disk_radiance(p, lamp)
    return total / steps**2


# --- shapes-still-life ----------------------------------------------------------------------------------------------


def shapes_still_life() -> tuple[Gltf, Expected]:
    """Shapes and meshes on a table, lit by a large round lamp, a small one, and a glowing cone."""
    scene = Gltf()
    add_table(scene)
    add_columns(scene)
    add_globe(scene)
    add_balls(scene)
    add_pencils(scene)
    add_lamps(scene)
    sky = environment_hdr(32, 16, lambda w: mul((0.8, 0.9, 1.0), 0.3 + 0.15 * w[1]))
    scene.set_environment(scene.add_image("sky.hdr", sky))
    scene.add_camera((0.1, 1.75, 5.6), (0.02, 0.66, 0), yfov_degrees=26, aspect=1.5)
    return scene, measured(
        "A still life of analytic shapes: columns, a globe on its stand, balls, an egg, a pebble, pencils, a lamp; and "
        "two meshes with them, a ring and a faceted ball."
    )


def add_table(scene: Gltf) -> None:
    wood = scene.add_material("table", (0.4, 0.25, 0.15), roughness=0.45)
    draw(scene, block(4.4, 0.12, 2.6), wood, "table top", translation=(0, -0.06, 0))
    wall = scene.add_lambert("wall", (0.5, 0.48, 0.43))
    draw(scene, sheet(10, 6), wall, "wall", translation=(0, 1.5, -2.0), rotation=UPWARDS)
    floor = scene.add_lambert("floor", (0.3, 0.27, 0.24))
    draw(scene, sheet(10, 6), floor, "floor", translation=(0, -1.2, 1))


def add_columns(scene: Gltf) -> None:
    """A whole column and a broken one of plaster: blocks, tapering shafts, rounded by flat ellipsoids."""
    plaster = scene.add_lambert("plaster", (0.74, 0.7, 0.64))
    for name, at, height in (("column", (-1.38, 0, -0.62), 1.2), ("stump", (-0.72, 0, -0.78), 0.52)):
        shaft = frustum("shaft", height, 0.18, 0.18 - 0.03 * height)
        parts = [
            draw(scene, block(0.5, 0.1, 0.5), plaster, "plinth", translation=(0, 0.05, 0)),
            draw(scene, ball(0.23), plaster, "cushion", translation=(0, 0.13, 0), scale=(1, 0.25, 1)),
            draw(scene, shaft, plaster, translation=(0, 0.15 + height / 2, 0)),
        ]
        if name == "column":
            top = 0.15 + height
            parts.append(draw(scene, frustum("echinus", 0.1, 0.145, 0.23), plaster, translation=(0, top + 0.05, 0)))
            parts.append(draw(scene, block(0.5, 0.08, 0.5), plaster, "abacus", translation=(0, top + 0.14, 0)))
        scene.add_node(name, translation=at, rotation=rotation(Y_AXIS, 24), children=parts)
    ring = torus(0.2, 0.07, 40, 16).without("uvs")
    copper = scene.add_material("copper", (0.93, 0.56, 0.42), metallic=1, roughness=0.42)
    scene.add_object("ring", ring, copper, translation=(-0.72, 0.74, -0.78))


def add_globe(scene: Gltf) -> None:
    """A map on a sphere, its axis aslant, on a turned stand."""

    def globe(u: float, v: float) -> Vec:
        longitude, latitude = 2 * math.pi * (u - 0.5), math.pi * (0.5 - v)
        x, y = math.cos(latitude) * math.sin(longitude), math.sin(latitude)
        z = math.cos(latitude) * math.cos(longitude)
        height = math.sin(2.1 * x + 1.3 * y + 0.4) * math.cos(2.3 * z - 1.1 * x)
        height += 0.55 * math.sin(4.7 * y - 3.1 * z + 1) + 0.35 * math.sin(7 * x + 3 * z) * math.cos(6 * y + 2)
        height += 0.12 * math.sin(17 * x - 13 * y) * math.cos(15 * z)
        lines = min(abs((12 * u + 0.5) % 1 - 0.5) / 12 * 2 * math.cos(latitude), abs((6 * v + 0.5) % 1 - 0.5) / 6)
        if abs(latitude) > 1.22 + 0.06 * math.sin(5 * longitude):
            color: Vec = (0.75, 0.76, 0.74)
        elif height > 0.18:
            color = (0.42, 0.36, 0.17) if height > 0.62 else (0.2, 0.3, 0.1)
        else:
            color = (0.05, 0.16, 0.27) if height < -0.25 else (0.08, 0.23, 0.34)
        return [to_srgb(c * (0.6 if lines < 0.004 else 1)) for c in color]

    texture = scene.add_texture(scene.add_image("globe.png", png(256, 128, 3, globe)), wrap_t="clamp")
    pbr = {"baseColorTexture": scene.texture_info(texture)}
    paper = scene.add_material("globe", roughness=0.3, pbr=pbr)
    brass = scene.add_material("brass", (0.87, 0.66, 0.34), metallic=1, roughness=0.4)
    dark = scene.add_material("dark wood", (0.12, 0.06, 0.035), roughness=0.4)
    axis = [
        draw(scene, ball(0.42), paper, "globe", rotation=rotation(Y_AXIS, 40)),
        draw(scene, frustum("axle", 0.98, 0.016, 0.016), brass),
        draw(scene, ball(0.03), brass, "upper knob", translation=(0, 0.49, 0)),
    ]
    parts = [
        scene.add_node("axis", translation=(0, 0.72, 0), rotation=rotation(Z_AXIS, -23.4), children=axis),
        draw(scene, frustum("foot", 0.07, 0.27, 0.2), dark, translation=(0, 0.035, 0)),
        draw(scene, frustum("stem", 0.26, 0.07, 0.03), dark, translation=(0, 0.2, 0)),
    ]
    scene.add_node("globe on its stand", translation=(0.2, 0, -0.5), children=parts)


def add_balls(scene: Gltf) -> None:
    """What lies in front: round, pointed, tapering, and flattened by scales."""
    gold = scene.add_material("gold", (1.0, 0.74, 0.35), metallic=1, roughness=0.34)
    draw(scene, ball(0.27), gold, "golden ball", translation=(-0.6, 0.27, 0.25))
    clay = scene.add_lambert("clay", (0.6, 0.22, 0.12))
    draw(scene, frustum("cone", 0.62, 0.25, 0), clay, translation=(-1.24, 0.31, 0.32))
    egg = scene.add_material("egg", (0.82, 0.72, 0.58), roughness=0.45)
    lean = compose(rotation(Y_AXIS, 30), rotation(Z_AXIS, 90))
    draw(scene, ball(0.5), egg, "egg", translation=(0.1, 0.14, 0.62), rotation=lean, scale=(0.28, 0.38, 0.28))
    slate = scene.add_material("slate", (0.11, 0.13, 0.16), roughness=0.55)
    turned = rotation(Y_AXIS, -20)
    draw(scene, ball(0.5), slate, "pebble", translation=(-0.3, 0.07, 0.84), rotation=turned, scale=(0.4, 0.14, 0.26))
    violet = scene.add_material("violet", (0.3, 0.16, 0.4), roughness=0.35)
    facets = icosphere(0.2, 1).without("normals")
    scene.add_object("faceted ball", facets, violet, translation=(0.66, 0.19, 0.34), rotation=rotation(Y_AXIS, 15))


def add_pencils(scene: Gltf) -> None:
    """A tapering cup of teal glaze with pencils, and one that lies before it."""
    teal = scene.add_material("teal glaze", (0.02, 0.24, 0.25), roughness=0.28)
    cup = (1.22, 0, 0.02)
    draw(scene, frustum("cup", 0.4, 0.17, 0.23), teal, translation=add(cup, (0, 0.2, 0)))
    wood = scene.add_lambert("pencil wood", (0.72, 0.5, 0.3))
    paints = ((0.7, 0.1, 0.06), (0.82, 0.5, 0.06), (0.1, 0.26, 0.5), (0.16, 0.4, 0.16))
    for i, color in enumerate(paints):
        paint = scene.add_material(f"pencil paint {i}", color, roughness=0.35)
        lead = scene.add_lambert(f"pencil lead {i}", mul(color, 0.7))
        parts = [
            draw(scene, frustum("pencil", 0.66, 0.035, 0.035), paint, translation=(0, 0.33, 0)),
            draw(scene, frustum("sharpened", 0.09, 0.035, 0.0105), wood, translation=(0, 0.705, 0)),
            draw(scene, frustum("lead", 0.0386, 0.0105, 0), lead, translation=(0, 0.7693, 0)),
        ]
        if i < 3:
            around = rotation(Y_AXIS, 120 * i + 70)
            turn = compose(around, rotation(Z_AXIS, -11))
            at = add(cup, add((0, 0.2, 0), rotate(around, (0.09, 0, 0))))
        else:
            turn = compose(rotation(Y_AXIS, 158), rotation(Z_AXIS, -90))
            at = (1.48, 0.035, 0.58)
        scene.add_node(f"pencil {i}", translation=at, rotation=turn, children=parts)


def add_lamps(scene: Gltf) -> None:
    """A large round lamp out of view, a small one on a stand, and a glowing cone."""
    white = scene.add_lambert("large lamp", (0, 0, 0), emission=(29, 26, 21.5))
    draw(scene, ball(0.8), white, "large lamp", translation=(-3.2, 3.6, 2.6))
    warm = scene.add_lambert("small lamp", (0, 0, 0), emission=(4.2, 2.9, 1.5))
    iron = scene.add_material("iron", (0.08, 0.08, 0.085), roughness=0.45)
    stand = [
        draw(scene, frustum("lamp foot", 0.05, 0.16, 0.13), iron, translation=(0, 0.025, 0)),
        draw(scene, frustum("lamp pole", 0.9, 0.018, 0.018), iron, translation=(0, 0.5, 0)),
        draw(scene, ball(0.15), warm, "small lamp", translation=(0, 1.09, 0)),
    ]
    scene.add_node("lamp", translation=(1.5, 0, -0.75), children=stand)
    ember = scene.add_lambert("glowing cone", (0.1, 0.1, 0.1), emission=(2.4, 0.7, 0.25))
    draw(scene, frustum("glowing cone", 0.26, 0.1, 0), ember, translation=(0.98, 0.13, 0.72))
