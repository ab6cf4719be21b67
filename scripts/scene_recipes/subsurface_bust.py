"""A bust of marble, lit from behind; and its head, for other scenes."""

import math
from bisect import bisect_right
from typing import Sequence

from gltf_builder import Gltf
from gltf_shapes import Geometry, Vec3, add, cross, floor, lathe, normalize, quad, rotation, sub
from image_files import environment_hdr
from scene_recipes.expectations import Expected, measured

# Cuts through a bust 1 m tall: their height, half width, and how far they reach to the front (+z) and to the back.
CUTS = (
    (0.00, 0.255, 0.13, 0.13), (0.06, 0.33, 0.165, 0.15), (0.16, 0.385, 0.18, 0.165), (0.25, 0.365, 0.16, 0.16),
    (0.315, 0.28, 0.125, 0.145), (0.36, 0.19, 0.1, 0.132), (0.4, 0.13, 0.088, 0.118), (0.44, 0.112, 0.084, 0.108),
    (0.475, 0.11, 0.086, 0.11), (0.5, 0.116, 0.11, 0.116), (0.525, 0.124, 0.138, 0.124), (0.56, 0.132, 0.149, 0.136),
    (0.62, 0.138, 0.154, 0.15), (0.68, 0.144, 0.158, 0.166), (0.74, 0.15, 0.16, 0.178), (0.80, 0.154, 0.166, 0.184),
    (0.86, 0.149, 0.156, 0.18), (0.91, 0.13, 0.13, 0.158), (0.95, 0.098, 0.095, 0.12), (0.98, 0.056, 0.053, 0.068),
    (0.995, 0.0, 0.0, 0.0),
)  # fmt: skip
NECK = 0.43
# (around, height, their widths, how far out): features of the face, alike on both sides, each a normal density.
FEATURES = (
    (0.34, 0.762, 0.17, 0.02, -0.02), (0.33, 0.758, 0.1, 0.012, 0.011), (0.3, 0.797, 0.28, 0.011, 0.011),
    (0.62, 0.695, 0.25, 0.03, 0.012), (0.0, 0.632, 0.17, 0.008, 0.012), (0.0, 0.61, 0.14, 0.008, 0.013),
    (0.0, 0.621, 0.2, 0.0035, -0.009), (0.0, 0.586, 0.2, 0.009, -0.011), (0.0, 0.552, 0.2, 0.016, 0.016),
    (0.11, 0.69, 0.07, 0.011, 0.014), (0.5, 0.61, 0.2, 0.03, -0.008),
)  # fmt: skip


def cut(height: float) -> list[float]:
    """Half width, front and back at a height, by a smooth curve through CUTS (Catmull and Rom)."""
    i = min(max(bisect_right([c[0] for c in CUTS], height) - 1, 0), len(CUTS) - 2)
    a, b, c, d = (CUTS[min(max(k, 0), len(CUTS) - 1)] for k in (i - 1, i, i + 1, i + 2))
    t = (height - b[0]) / (c[0] - b[0])
    out = []
    for k in (1, 2, 3):
        enter, leave = ((q[k] - p[k]) / (q[0] - p[0]) * (c[0] - b[0]) for p, q in ((a, c), (b, d)))
        value = (2 * t**3 - 3 * t**2 + 1) * b[k] + (t**3 - 2 * t**2 + t) * enter
        out.append(value + (3 * t**2 - 2 * t**3) * c[k] + (t**3 - t**2) * leave)
    return out


def bell(x: float, width: float) -> float:
    return math.exp(-0.5 * (x / width) ** 2)


def step(x: float, width: float) -> float:
    """From 0 to 1 about x = 0."""
    return 1 / (1 + math.exp(-min(max(x / width, -30.0), 30.0)))


def relief(around: float, height: float) -> float:
    """How far the surface lies out of the cut; `around` in (-pi, pi], 0 to the front."""
    side = abs(around)
    out = sum(
        depth * (bell(side - at, wide) + (bell(side + at, wide) if at else 0)) * bell(height - y, tall)
        for at, y, wide, tall, depth in FEATURES
    )
    down = min(max((0.785 - height) / 0.09, 0.0), 1.0)  # the nose
    out += (0.012 + 0.042 * down) * bell(around, 0.075 + 0.05 * down) * step(height - 0.687, 0.004) * step(
        0.79 - height, 0.008
    )
    ear = math.hypot((side - 1.72) / 0.17, (height - 0.715) / 0.052)
    out += (0.034 * bell(ear - 0.95, 0.22) + 0.008) * step(1.15 - ear, 0.06)
    hair = step(height - (0.855 - 0.12 * step(side - 1.25, 0.12) - 0.2 * step(side - 2.0, 0.12)), 0.006)
    curls = math.sin(21 * around + 5 * math.sin(31 * height)) * math.sin(95 * height + 4 * math.sin(7 * around))
    out += hair * (0.014 + 0.007 * curls) * step(0.975 - height, 0.006)
    folds = step(0.24 - height, 0.02)
    return out + folds * 0.012 * math.sin(11 * around + 26 * height + 2 * math.sin(2 * around))


def place(around: float, height: float) -> Vec3:
    width, front, back = cut(height)
    x, z = width * math.sin(around), (front if abs(around) < math.pi / 2 else back) * math.cos(around)
    out = relief(around, height) if width > 0 else 0
    return x + out * math.sin(around), height, z + out * math.cos(around)


def spread(low: float, high: float, count: int, dense: Sequence[tuple[float, float, float]]) -> list[float]:
    """So many values, closer together where `dense` says so: (at, width, how much)."""
    fine = [low + (high - low) * i / 2000 for i in range(2001)]
    sums = [0.0]
    for x in fine[1:]:
        sums.append(sums[-1] + 1 + sum(much * bell(x - at, width) for at, width, much in dense))
    out = []
    for i in range(count):
        share = sums[-1] * i / (count - 1)
        k = min(max(bisect_right(sums, share) - 1, 0), 1999)
        out.append(fine[k] + (fine[k + 1] - fine[k]) * (share - sums[k]) / (sums[k + 1] - sums[k]))
    return out


def bust(segments: int, rings: int, bottom: float = 0) -> Geometry:
    """Closed. Texture u goes around from the back, v down."""
    turns = spread(-math.pi, math.pi, segments + 1, ((0, 0.5, 2), (1.72, 0.15, 2), (-1.72, 0.15, 2)))
    heights = spread(bottom, CUTS[-1][0], rings + 1, ((0.7, 0.1, 2.5), (0.99, 0.03, 1)))
    out = Geometry()
    for height in reversed(heights):
        out.positions += [place(around, height) for around in turns[:-1]]
        out.positions.append(out.positions[-segments])  # the seam
        v = (CUTS[-1][0] - height) / (CUTS[-1][0] - bottom)
        out.uvs += [((around + math.pi) / (2 * math.pi), v) for around in turns]
    columns = segments + 1
    for i in range(rings):
        for j in range(segments):
            a, b = i * columns + j, (i + 1) * columns + j
            out.triangles += [(a, b, b + 1)] + ([(a, b + 1, a + 1)] if i else [])
    out.normals = smooth_normals(out)
    add_bottom(out, columns)
    return out


def smooth_normals(body: Geometry) -> list[Vec3]:
    """By the sum over the triangles at each place, of vertices that share it alike."""
    sums: dict[Vec3, Vec3] = {}
    for triangle in body.triangles:
        p, q, r = (body.positions[i] for i in triangle)
        normal = cross(sub(q, p), sub(r, p))
        for corner in (p, q, r):
            sums[corner] = add(sums.get(corner, (0, 0, 0)), normal)
    return [normalize(sums[p]) for p in body.positions]


def add_bottom(body: Geometry, columns: int) -> None:
    """A flat one, below the last ring."""
    ring = body.positions[-columns:]
    first = len(body.positions)
    body.positions += [*ring, (0.0, ring[0][1], 0.0)]
    body.normals += [(0.0, -1.0, 0.0)] * (columns + 1)
    body.uvs += [(0.5, 1.0)] * (columns + 1)
    body.triangles += [(first + columns, first + j + 1, first + j) for j in range(columns - 1)]


def subsurface_bust() -> tuple[Gltf, Expected]:
    """As if 17 cm tall: light from behind shines through what is thin."""
    scene = Gltf()
    marble = {"PARIAN_materials_subsurface": {"name": "marble", "scale": 6}}
    material = scene.add_material("marble", roughness=0.5, extensions=marble)
    turned = rotation((0, 1, 0), -12)
    scene.add_object("bust", bust(104, 92).without("uvs"), material, translation=(0, 0.3, 0), rotation=turned)
    stone = scene.add_material("plinth", (0.035, 0.032, 0.03), roughness=0.3)
    plinth = [(0, 0.3), (0.3, 0.3), (0.32, 0.28), (0.25, 0.22), (0.25, 0.1), (0.33, 0.04), (0.33, 0), (0, 0)]
    scene.add_object("plinth", lathe(plinth, 64, smooth=False).without("uvs"), stone)
    dark = scene.add_material("floor", (0.05, 0.045, 0.04), roughness=0.45)
    scene.add_object("floor", floor(8).without("uvs"), dark)
    wall = scene.add_lambert("wall", (0.06, 0.065, 0.075))
    scene.add_object("wall", quad((0, 3, -3.5), (10, 0, 0), (0, 3, 0)).without("uvs"), wall)
    scene.add_rect_light("behind", (1, 0.87, 0.72), 70, (0.7, 0.9), (1.6, 2.3, -1.5), (0, 0.95, 0))
    scene.add_rect_light("rim", (0.75, 0.87, 1), 16, (0.4, 1.2), (-2.1, 1.5, -1.0), (0, 0.95, 0))
    scene.add_rect_light("key", (0.9, 0.95, 1), 6, (1.2, 1.2), (-2.2, 2.0, 2.0), (0, 0.9, 0))
    sky = environment_hdr(16, 8, lambda w: (0.012, 0.013, 0.016))
    scene.set_environment(scene.add_image("sky.hdr", sky))
    scene.add_camera((0.1, 1.05, 3.0), (0.0, 0.8, 0), yfov_degrees=22, aspect=16 / 9)
    return scene, measured(
        "A bust of marble as if 17 cm tall, lit from behind: its ears and edges shine.", (480, 270)
    )
