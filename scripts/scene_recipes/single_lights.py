"""One light over a Lambert plane, seen from above: radiance in closed form, evaluated here, so that a parameter and
its result change together."""

import math
from typing import Callable, Optional, Sequence

from gltf_builder import Gltf
from gltf_shapes import Vec, floor, look_at
from scene_recipes.expectations import Expected, Region, expected, region

ALBEDO = 0.5  # of the plane
TINT = (1.0, 0.5, 0.25)  # of each light: the channels must not be exchanged
HEIGHT = 2.0  # of the punctual lights above the plane


def plane_scene(half_width: float, half_height: float, orthographic_from: Optional[float] = None) -> Gltf:
    """A plane at y = 0 from above: the image's x is the world's x, its y (downwards) the world's z. A perspective
    camera at y = 4, or an orthographic one at the height given (below the lights that have a back)."""
    scene = Gltf()
    scene.add_object("plane", floor(20).without("normals", "uvs"), scene.add_lambert("rho .5", (ALBEDO,) * 3))
    if orthographic_from is not None:
        eye = (0, orthographic_from, 0)
        scene.add_orthographic_camera(eye, look_at(eye, (0, 0, 0)), half_width, half_height)
    else:
        yfov = 2 * math.degrees(math.atan(half_height / 4))
        scene.add_camera((0, 4, 0), (0, 0, 0), yfov_degrees=yfov, aspect=half_width / half_height)
    return scene


def tinted(value: float) -> list[float]:
    return [value * t for t in TINT]


def around(x: float, z: float, half: Vec, size: tuple[int, int]) -> Region:
    """Eight by eight whole pixels around the place (x, z)."""
    left = round((x / half[0] + 1) / 2 * size[0]) - 4
    top = round((z / half[1] + 1) / 2 * size[1]) - 4
    return left / size[0], top / size[1], (left + 8) / size[0], (top + 8) / size[1]


def average(value: Callable[[float, float], float], area: Region, half: Vec, steps: int = 64) -> float:
    """The mean of a function of (x, z) over a region of the image (midpoint rule)."""
    x0, y0, x1, y1 = area
    total = 0.0
    for i in range(steps):
        x = (2 * (x0 + (x1 - x0) * (i + 0.5) / steps) - 1) * half[0]
        for j in range(steps):
            z = (2 * (y0 + (y1 - y0) * (j + 0.5) / steps) - 1) * half[1]
            total += value(x, z)
    return total / steps**2


def spots(
    value: Callable[[float, float], float],
    places: Sequence[tuple[float, float]],
    half: Vec,
    size: tuple[int, int],
    tolerance: float,
    formula: str,
) -> list[Expected]:
    """Regions around places on the plane, with the mean of `value` over each."""
    out = []
    for x, z in places:
        area = around(x, z, half, size)
        source = f"{formula}; averaged around x = {x:g}, z = {z:g} ({value(x, z):.6f} in red at the point)"
        out.append(region(area, tinted(average(value, area, half)), tolerance, source))
    return out


def light_point() -> tuple[Gltf, Expected]:
    """A point light above a plane: inverse square and cosine."""
    intensity, half, size = 10.0, 1.5, (64, 64)
    scene = plane_scene(half, half)
    scene.add_punctual_light("point", "point", TINT, intensity, (0, HEIGHT, 0))

    def radiance(x: float, z: float) -> float:
        return ALBEDO / math.pi * intensity * HEIGHT / (HEIGHT**2 + x * x + z * z) ** 1.5

    solid_angle = 4 * math.asin(half**2 / (half**2 + HEIGHT**2))
    mean = ALBEDO / math.pi * intensity * solid_angle / (2 * half) ** 2
    formula = "rho/pi I h / (h^2 + x^2 + z^2)^(3/2)"
    pixels = spots(radiance, [(0, 0), (1, 0), (-1, -1)], (half, half), size, 0.005, formula)
    source = "closed form: rho/pi I Omega / A, Omega = 4 asin(a^2 / (a^2 + h^2)) of the square A = 4 a^2 in view"
    return scene, expected(
        "A point light, 2 m above a grey plane, from above.",
        size, 64, source, tinted(mean), 0.003, pixels,
    )  # fmt: skip


def light_spot() -> tuple[Gltf, Expected]:
    """A spot light looking down: glTF's squared linear falloff between the two cones."""
    intensity, half, size = 10.0, 1.5, (64, 64)
    inner, outer = math.cos(math.radians(20)), math.cos(math.radians(30))
    scene = plane_scene(half, half)
    cone = {"innerConeAngle": math.acos(inner), "outerConeAngle": math.acos(outer)}
    scene.add_punctual_light("spot", "spot", TINT, intensity, (0, HEIGHT, 0), (0, 0, 0), spot=cone)

    def radiance(x: float, z: float) -> float:
        distance2 = HEIGHT**2 + x * x + z * z
        falloff = min(max((HEIGHT / math.sqrt(distance2) - outer) / (inner - outer), 0.0), 1.0) ** 2
        return ALBEDO / math.pi * intensity * falloff * HEIGHT / distance2**1.5

    flux = 2 * math.pi * intensity * ((1 - inner) + (inner - outer) / 3)
    mean = ALBEDO / math.pi * flux / (2 * half) ** 2
    formula = "rho/pi I f h / r^3, f = clamp((cos t - cos 30) / (cos 20 - cos 30))^2"
    pixels = spots(radiance, [(0, 0), (0.9, 0), (0, -0.9)], (half, half), size, 0.01, formula)
    source = "closed form: rho/pi Phi / A, Phi = 2 pi I ((1 - cos 20) + (cos 20 - cos 30) / 3) = .533212 I"
    return scene, expected(
        "A spot light of 20 and 30 degrees, 2 m above a grey plane, from above.",
        size, 64, source, tinted(mean), 0.005, pixels,
    )  # fmt: skip


def light_directional() -> tuple[Gltf, Expected]:
    """A directional light at 60 degrees: one colour."""
    irradiance = 4.0
    scene = plane_scene(1.5, 1.5, orthographic_from=2)
    towards_sun = (math.sqrt(3), 1, 0)
    scene.add_punctual_light("directional", "sun", TINT, irradiance, towards_sun, (0, 0, 0))
    value = tinted(ALBEDO / math.pi * irradiance * math.cos(math.radians(60)))
    return scene, expected(
        "A directional light, 60 degrees from the normal of a grey plane.",
        (64, 64), 16, "closed form: rho/pi E cos 60, E = 4", value, 0.001,
    )  # fmt: skip


def light_rectangle() -> tuple[Gltf, Expected]:
    """A rectangle light, twice as wide as high, 1 m above a plane of which the image shows just as much."""
    radiance_out, half, size = 2.0, (1.5, 0.75), (128, 64)
    scene = plane_scene(*half, orthographic_from=0.5)
    scene.add_rect_light("rectangle", TINT, radiance_out, (2 * half[0], 2 * half[1]), (0, 1, 0), (0, 0, 0))

    def radiance(x: float, z: float) -> float:
        sides = [(half[0] + sx * x, half[1] + sz * z) for sx in (-1, 1) for sz in (-1, 1)]
        return ALBEDO * radiance_out * sum(corner_form_factor(a, b) for a, b in sides)

    mean = ALBEDO * radiance_out * opposed_rectangles(2 * half[0], 2 * half[1])
    formula = "rho Le (sum of the form factors of the four rectangles that meet above the point)"
    pixels = spots(radiance, [(0, 0), (1.2, 0), (0, 0.6)], half, size, 0.02, formula)
    return scene, expected(
        "A rectangle light of 3 x 1.5 m, 1 m above a grey plane; the image shows the 3 x 1.5 m below it.",
        size, 256, "closed form: rho Le F, F between two equal opposed rectangles, 3 x 1.5 at distance 1",
        tinted(mean), 0.005, pixels,
    )  # fmt: skip


def corner_form_factor(a: float, b: float) -> float:
    """From a plane element to a parallel rectangle a x b at distance 1, one corner straight above it (negative sides
    count negatively)."""
    p, q = math.hypot(1, a), math.hypot(1, b)
    return (a / p * math.atan(b / p) + b / q * math.atan(a / q)) / (2 * math.pi)


def opposed_rectangles(x: float, y: float) -> float:
    """Between two equal opposed rectangles x by y at distance 1 (Howell's catalogue, C-11)."""
    px, py = math.hypot(1, x), math.hypot(1, y)
    total = 0.5 * math.log(px**2 * py**2 / (1 + x * x + y * y))
    total += x * py * math.atan(x / py) + y * px * math.atan(y / px) - x * math.atan(x) - y * math.atan(y)
    return 2 / (math.pi * x * y) * total


def light_disk() -> tuple[Gltf, Expected]:
    """A disk light, 1 m above a plane."""
    radiance_out, radius, half, size = 4.0, 0.8, 1.5, (64, 64)
    scene = plane_scene(half, half, orthographic_from=0.5)
    scene.add_disk_light("disk", TINT, radiance_out, 2 * radius, (0, 1, 0), (0, 0, 0))

    def radiance(x: float, z: float) -> float:
        a2 = x * x + z * z
        z1 = 1 + a2 + radius**2
        return ALBEDO * radiance_out * 0.5 * (1 - (z1 - 2 * radius**2) / math.sqrt(z1 * z1 - 4 * a2 * radius**2))

    mean = average(radiance, (0, 0, 1, 1), (half, half), 256)
    formula = "rho Le (1 - (1 + a^2 - R^2) / sqrt((1 + a^2 + R^2)^2 - 4 a^2 R^2)) / 2, a from the axis"
    pixels = spots(radiance, [(0, 0), (0.8, 0), (-0.8, 0.8)], (half, half), size, 0.02, formula)
    return scene, expected(
        "A disk light of 1.6 m across, 1 m above a grey plane, from above.",
        size, 256, f"closed form: mean over the image of {formula}", tinted(mean), 0.005, pixels,
    )  # fmt: skip
