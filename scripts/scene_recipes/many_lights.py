"""A floor under ten thousand lights."""

import math
import random
from typing import Sequence

from gltf_builder import Gltf
from gltf_shapes import Geometry, Vec, Vec3, add, cross, dot, floor, look_at, mul, normalize, sub
from scene_recipes.expectations import Expected, expected, region
from scene_recipes.lobes import BLACK

DOME_RADIUS = 2.0
GLOWS = {  # radiance
    "dim": (0.05, 0.05, 0.08),
    "red": (6.0, 1.0, 0.4),
    "green": (0.6, 4.0, 1.0),
    "blue": (1.0, 1.5, 24.0),
}


def many_lights() -> tuple[Gltf, Expected]:
    """A dome of 10,000 triangles, each a light, a few of them bright, over a Lambert floor."""
    rho, half, size = (0.8, 0.5, 0.3), 1.0, (64, 64)
    chance = random.Random(11)
    scene = Gltf()
    glows = {name: scene.add_lambert(name, BLACK, emission=radiance) for name, radiance in GLOWS.items()}
    halves = []
    for i, name in enumerate(("left half", "right half")):
        shell = half_dome(rings=50, segments=50, begin=math.pi * i)
        groups: dict[str, list[tuple[int, int, int]]] = {glow: [] for glow in GLOWS}
        for triangle in shell.triangles:
            low = shell.positions[triangle[0]][1] < 0.4
            usual, rare = ("red", "blue") if i else ("green", "red")
            glow = chance.choices(("dim", usual, rare), (0.96, 0.035, 0.02 if low else 0.002))[0]
            groups[glow].append(triangle)
        parts = [(Geometry(shell.positions, triangles), glows[glow]) for glow, triangles in groups.items() if triangles]
        scene.add_node(name, mesh=scene.add_mesh(name, *parts))
        halves.append((shell.positions, groups))
    scene.add_object("floor", floor(DOME_RADIUS).without("normals", "uvs"), scene.add_lambert("rho .8 .5 .3", rho))
    eye = (0, 1, 0)
    scene.add_orthographic_camera(eye, look_at(eye, (0, 0, 0)), half, half)

    def radiance(area: Sequence[float], steps: int) -> list[float]:
        """The mean over a part of the image, by midpoints."""
        total = [0.0, 0.0, 0.0]
        for i in range(steps):
            for j in range(steps):
                x = (2 * (area[0] + (area[2] - area[0]) * (i + 0.5) / steps) - 1) * half
                z = (2 * (area[1] + (area[3] - area[1]) * (j + 0.5) / steps) - 1) * half
                total = add(total, dome_irradiance((x, 0, z), halves))
        return [r / math.pi * t / steps**2 for r, t in zip(rho, total)]

    areas = ((0, 0, 0.25, 0.25), (0.75, 0, 1, 0.25), (0, 0.75, 0.25, 1), (0.75, 0.75, 1, 1))
    formula = "rho/pi sum of Le times Lambert's formula for the irradiance of a triangle, over 10,000 triangles"
    pixels = [region(area, radiance(area, 2), 0.02, formula) for area in areas]
    return scene, expected(
        "A floor under a dome of 10,000 glowing triangles, one in 25 some hundred times brighter than the others.",
        size, 64, f"closed form: {formula}", radiance((0, 0, 1, 1), 8), 0.005, pixels,
    )  # fmt: skip


def half_dome(rings: int, segments: int, begin: float) -> Geometry:
    """Half of an upper hemisphere, but for a small hole at the pole, of 2 rings segments triangles that look inwards."""
    shell = Geometry()
    for i in range(rings + 1):
        up = math.pi / 2 * i / (rings + 1)
        for j in range(segments + 1):
            phi = begin + math.pi * j / segments
            out = DOME_RADIUS * math.cos(up)
            shell.positions.append((out * math.cos(phi), DOME_RADIUS * math.sin(up), out * math.sin(phi)))
    for i in range(rings):
        for j in range(segments):
            a = i * (segments + 1) + j
            shell.triangles += [(a, a + 1, a + segments + 2), (a, a + segments + 2, a + segments + 1)]
    return shell


def dome_irradiance(at: Vec, halves: Sequence[tuple[Sequence[Vec], dict[str, list[tuple[int, int, int]]]]]) -> Vec3:
    """On the floor: half the sum over triangles of Le and, over their edges, of the angle under which the edge is seen
    times the vertical component of the unit normal of its plane through the point (Lambert 1760)."""
    total = BLACK
    for positions, groups in halves:
        seen = [normalize(sub(p, at)) for p in positions]
        for glow, triangles in groups.items():
            angles = 0.0
            for triangle in triangles:
                for k in range(3):
                    a, b = seen[triangle[k]], seen[triangle[k - 2]]
                    normal = cross(a, b)
                    sine = math.sqrt(dot(normal, normal))
                    angles += math.atan2(sine, dot(a, b)) * normal[1] / sine
            total = add(total, mul(GLOWS[glow], abs(angles) / 2))
    return total
