"""Light from everywhere: Lambert surfaces whose radiance is known in closed form."""

import math
from typing import Sequence

from gltf_builder import Gltf
from gltf_shapes import Vec, box, icosphere, look_at
from image_files import environment_hdr
from scene_recipes.expectations import Expected, expected, region


def furnace_sphere() -> tuple[Gltf, Expected]:
    """A convex Lambert body in a constant environment: rho everywhere on it, whatever its shape."""
    rho = (0.8, 0.5, 0.2)
    ball = icosphere(1, 3).without("normals")
    scene = Gltf()
    scene.add_object("ball", ball, scene.add_lambert("rho .8 .5 .2", rho))
    scene.set_environment(scene.add_image("white.hdr", environment_hdr(8, 4, lambda w: (1.0, 1.0, 1.0))))
    scene.add_camera((0, 0, 3), yfov_degrees=60, aspect=1)
    covered = silhouette_share(ball.positions, distance=3, yfov_degrees=60)
    mean = [1 - covered * (1 - r) for r in rho]
    centre = region((0.3125, 0.3125, 0.6875, 0.6875), rho, 0.002, "rho Le: a convex Lambert body in a constant environment Le = 1")
    source = f"closed form: 1 - c (1 - rho), c = {covered:.6f} the area of the convex hull of the projected ball"
    return scene, expected(
        "A faceted Lambert ball under a constant white sky: each facet has the same colour, rho.",
        (64, 64), 64, source, mean, 0.003, [centre],
    )  # fmt: skip


def silhouette_share(positions: Sequence[Vec], distance: float, yfov_degrees: float) -> float:
    """The share of a square image that a convex body about the origin covers, seen from (0, 0, distance)."""
    cot = 1 / math.tan(math.radians(yfov_degrees) / 2)
    points = sorted({(cot * x / (distance - z), cot * y / (distance - z)) for x, y, z in positions})

    def half_hull(ordered: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
        hull: list[tuple[float, float]] = []
        for p in ordered:
            while len(hull) > 1 and _turn(hull[-2], hull[-1], p) <= 0:
                hull.pop()
            hull.append(p)
        return hull[:-1]

    hull = half_hull(points) + half_hull(points[::-1])
    doubled = sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(hull, hull[1:] + hull[:1]))
    return doubled / 2 / 4


def _turn(a: Vec, b: Vec, c: Vec) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def furnace_box() -> tuple[Gltf, Expected]:
    """Inside a closed box whose walls emit and reflect: every ray brings back Le / (1 - rho)."""
    rho = (0.2, 0.5, 0.8)
    scene = Gltf()
    walls = scene.add_lambert("walls", rho, emission=(1, 1, 1))
    scene.add_object("box", box((0, 0, 0), (3, 2, 4)).inside_out().without("normals", "uvs"), walls)
    scene.add_camera((-0.7, 0.3, 1.2), (0.9, -0.4, -1.5), yfov_degrees=70, aspect=1)
    value = [1 / (1 - r) for r in rho]
    return scene, expected(
        "The camera stands in a closed box of glowing Lambert walls: nothing but one colour.",
        (64, 64), 64, "closed form: Le / (1 - rho), Le = 1, rho = .2 .5 .8", value, 0.01,
    )  # fmt: skip


def environment_gradient() -> tuple[Gltf, Expected]:
    """The sky's red, green and blue are 1 + x, 1 + y, 1 + z of the direction: an exchanged or flipped axis shows.

    The map's size puts the two viewing directions on texel centres, where every filter gives the same value."""
    rho, side, half = 0.6, 1.2, 1.25
    scene = Gltf()
    cube = box((0, 0, 0), (side,) * 3).without("normals", "uvs")
    scene.add_object("cube", cube, scene.add_lambert("rho .6", (rho,) * 3))
    sky = environment_hdr(252, 130, lambda w: (1 + w[0], 1 + w[1], 1 + w[2]))
    scene.set_environment(scene.add_image("gradient.hdr", sky))
    for name, eye in (("towards", (2, 2, 2)), ("away", (-2, -2, -2))):
        scene.add_orthographic_camera(eye, look_at(eye, (0, 0, 0)), half, half, name)
    behind, bright, even = 1 - 1 / math.sqrt(3), rho * 5 / 3, rho
    hexagon, image = math.sqrt(3) * side**2, (2 * half) ** 2  # the cube along its diagonal; all that is seen
    mean = [((image - hexagon) * behind + hexagon * (bright + 2 * even) / 3) / image] * 3
    facing = "rho (1 + 2/3 on the axis that the face looks along)"
    pixels = [
        region((0.40625, 0.1875, 0.59375, 0.375), (even, bright, even), 0.02, f"+y face: {facing}"),
        region((0.59375, 0.5, 0.78125, 0.6875), (bright, even, even), 0.02, f"+x face: {facing}"),
        region((0.21875, 0.5, 0.40625, 0.6875), (even, even, bright), 0.02, f"+z face: {facing}"),
        region((0.0, 0.0, 0.125, 0.125), [behind] * 3, 0.01, "sky: 1 - 1/sqrt(3) behind the cube's far corner"),
    ]
    source = "closed form: sky 1 - 1/sqrt(3); the cube's hexagon, sqrt(3) s^2, in thirds of rho 5/3, rho, rho"
    return scene, expected(
        "A cube under a sky of 1 + x, 1 + y, 1 + z as red, green and blue: each face glows in its axis's colour "
        "(camera 1 sees the three dark faces, rho / 3 on the axis).",
        (64, 64), 256, source, mean, 0.01, pixels,  # .hdr keeps 8 bits: up to .4%
    )  # fmt: skip
