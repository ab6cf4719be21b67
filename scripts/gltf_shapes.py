"""Vectors, rotations and triangle meshes as plain lists. Counter-clockwise is the front; y is up."""

import math
from dataclasses import dataclass, field
from typing import Callable, Iterable, Sequence

Vec = Sequence[float]
Vec3 = tuple[float, float, float]
Quat = tuple[float, float, float, float]  # x, y, z, w, as glTF stores it


def add(a: Vec, b: Vec) -> Vec3:
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def sub(a: Vec, b: Vec) -> Vec3:
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def mul(a: Vec, s: float) -> Vec3:
    return a[0] * s, a[1] * s, a[2] * s


def dot(a: Vec, b: Vec) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vec, b: Vec) -> Vec3:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def normalize(a: Vec) -> Vec3:
    return mul(a, 1 / math.sqrt(dot(a, a)))


def rotation(axis: Vec, degrees: float) -> Quat:
    """The turn by an angle about a unit axis."""
    half = math.radians(degrees) / 2
    x, y, z = mul(axis, math.sin(half))
    return x, y, z, math.cos(half)


def compose(a: Quat, b: Quat) -> Quat:
    """First b, then a."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )


def rotate(q: Quat, v: Vec) -> Vec3:
    t = mul(cross(q[:3], v), 2)
    return add(add(v, mul(t, q[3])), cross(q[:3], t))


def look_at(eye: Vec, target: Vec) -> Quat:
    """The rotation of a camera or light (they look along -z) at `eye` towards `target`, its top up; straight down,
    its right is +x and its top is -z."""
    z = normalize(sub(eye, target))
    up = (0, 1, 0) if abs(z[1]) < 1 - 1e-9 else (0, 0, -math.copysign(1, z[1]))
    x = normalize(cross(up, z))
    y = cross(z, x)
    return _from_axes(x, y, z)


def _from_axes(x: Vec, y: Vec, z: Vec) -> Quat:
    """The rotation that takes the unit axes to x, y, z."""
    trace = x[0] + y[1] + z[2]
    candidates = [trace, x[0] - y[1] - z[2], y[1] - x[0] - z[2], z[2] - x[0] - y[1]]
    best = candidates.index(max(candidates))
    s = 2 * math.sqrt(1 + candidates[best])
    if best == 0:
        return (y[2] - z[1]) / s, (z[0] - x[2]) / s, (x[1] - y[0]) / s, s / 4
    if best == 1:
        return s / 4, (x[1] + y[0]) / s, (z[0] + x[2]) / s, (y[2] - z[1]) / s
    if best == 2:
        return (x[1] + y[0]) / s, s / 4, (y[2] + z[1]) / s, (z[0] - x[2]) / s
    return (z[0] + x[2]) / s, (y[2] + z[1]) / s, s / 4, (x[1] - y[0]) / s


@dataclass
class Geometry:
    """Triangles; attribute lists are empty or hold one element per vertex."""

    positions: list[Vec3] = field(default_factory=list)
    triangles: list[tuple[int, int, int]] = field(default_factory=list)
    normals: list[Vec3] = field(default_factory=list)
    uvs: list[tuple[float, float]] = field(default_factory=list)
    uvs1: list[tuple[float, float]] = field(default_factory=list)
    colors: list[tuple[float, float, float, float]] = field(default_factory=list)

    def without(self, *attributes: str) -> "Geometry":
        """A copy that lacks these attributes (without normals, glTF asks for flat shading)."""
        copy = Geometry(**self.__dict__)
        for attribute in attributes:
            setattr(copy, attribute, [])
        return copy

    def moved(self, offset: Vec = (0, 0, 0), turn: Quat = (0, 0, 0, 1), scale: float = 1) -> "Geometry":
        """A copy, scaled, then turned, then moved."""
        copy = Geometry(**self.__dict__)
        copy.positions = [add(rotate(turn, mul(p, scale)), offset) for p in self.positions]
        copy.normals = [rotate(turn, n) for n in self.normals]
        return copy

    def inside_out(self) -> "Geometry":
        copy = Geometry(**self.__dict__)
        copy.triangles = [(a, c, b) for a, b, c in self.triangles]
        copy.normals = [mul(n, -1) for n in self.normals]
        return copy

    def painted(self, color: Callable[[Vec3], Vec]) -> "Geometry":
        """A copy with vertex colours, opaque, from the positions."""
        copy = Geometry(**self.__dict__)
        copy.colors = [(*color(p), 1.0) for p in self.positions]
        return copy


def merge(parts: Iterable[Geometry]) -> Geometry:
    """All parts as one; they must have the same attributes."""
    whole = Geometry()
    for part in parts:
        base = len(whole.positions)
        whole.triangles += [(a + base, b + base, c + base) for a, b, c in part.triangles]
        for name in ("positions", "normals", "uvs", "uvs1", "colors"):
            getattr(whole, name).extend(getattr(part, name))
    return whole


def polygon(corners: Sequence[Vec]) -> Geometry:
    """A convex polygon, counter-clockwise, as a fan without normals or uvs."""
    fan = [(0, i, i + 1) for i in range(1, len(corners) - 1)]
    return Geometry(positions=[tuple(c) for c in corners], triangles=fan)


def quad(center: Vec, u: Vec, v: Vec) -> Geometry:
    """The parallelogram center +- u +- v, facing u x v; texture v grows against the axis v (the top is v = 0)."""
    signs = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    return Geometry(
        positions=[add(center, add(mul(u, s), mul(v, t))) for s, t in signs],
        triangles=[(0, 1, 2), (0, 2, 3)],
        normals=[normalize(cross(u, v))] * 4,
        uvs=[((s + 1) / 2, (1 - t) / 2) for s, t in signs],
    )


def floor(half: float, y: float = 0, center: Vec = (0, 0)) -> Geometry:
    return quad((center[0], y, center[1]), (half, 0, 0), (0, 0, -half))


def box(center: Vec, size: Vec) -> Geometry:
    """An axis-parallel box of these full sides."""
    x, y, z = (size[0] / 2, 0, 0), (0, size[1] / 2, 0), (0, 0, size[2] / 2)
    minus = {axis: mul(axis, -1) for axis in (x, y, z)}
    sides = [(x, minus[z], y), (minus[x], z, y), (y, x, minus[z]), (minus[y], x, z), (z, x, y), (minus[z], minus[x], y)]
    return merge(quad(add(center, out), u, v) for out, u, v in sides)


def lathe(profile: Sequence[tuple[float, float]], segments: int, smooth: bool = True) -> Geometry:
    """Turns a profile of (radius, y), from top to bottom, about the y axis. `smooth` takes the normals across the
    profile's corners; otherwise each band has its own. Texture u goes around, v along."""
    bands = [profile] if smooth else [profile[i : i + 2] for i in range(len(profile) - 1)]
    return merge(_lathe_band(band, segments, profile[0][1], profile[-1][1]) for band in bands)


def _lathe_band(profile: Sequence[tuple[float, float]], segments: int, top: float, bottom: float) -> Geometry:
    out = Geometry()
    columns = segments + 1
    last = len(profile) - 1
    for i, (radius, y) in enumerate(profile):
        before, after = profile[max(i - 1, 0)], profile[min(i + 1, last)]
        slope = math.atan2(after[0] - before[0], before[1] - after[1])
        for j in range(columns):
            phi = 2 * math.pi * j / segments
            c, s = (1.0, 0.0) if j == segments else (math.cos(phi), math.sin(phi))
            out.positions.append((radius * c, y, -radius * s))
            out.normals.append((math.cos(slope) * c, math.sin(slope), -math.cos(slope) * s))
            out.uvs.append((j / segments, (top - y) / (top - bottom) if top != bottom else 0.0))
    for i in range(last):
        for j in range(segments):
            a, b = i * columns + j, (i + 1) * columns + j
            if profile[i + 1][0] > 0:
                out.triangles.append((a, b, b + 1))
            if profile[i][0] > 0:
                out.triangles.append((a, b + 1, a + 1))
    return out


def sphere(radius: float = 1, segments: int = 48, rings: int = 24) -> Geometry:
    """A sphere in longitude and latitude."""
    angles = [math.pi * i / rings for i in range(rings + 1)]
    profile = [(radius * math.sin(a) if 0 < i < rings else 0.0, radius * math.cos(a)) for i, a in enumerate(angles)]
    ball = lathe(profile, segments)
    ball.normals = [normalize(p) for p in ball.positions]
    columns = segments + 1
    ball.uvs = [(uv[0], (i // columns) / rings) for i, uv in enumerate(ball.uvs)]
    return ball


def icosphere(radius: float = 1, level: int = 2) -> Geometry:
    """An icosahedron whose triangles are split in four `level` times."""
    g = (1 + math.sqrt(5)) / 2
    corners = [(-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g)]
    corners += [(0, -1, -g), (0, 1, -g), (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1)]
    unit = [normalize(c) for c in corners]
    faces = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2)]
    faces += [(10, 7, 6), (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11)]
    faces += [(6, 2, 10), (8, 6, 7), (9, 8, 1)]
    for _ in range(level):
        middle: dict[tuple[int, int], int] = {}

        def half(a: int, b: int) -> int:
            key = (min(a, b), max(a, b))
            if key not in middle:
                middle[key] = len(unit)
                unit.append(normalize(add(unit[a], unit[b])))
            return middle[key]

        split = []
        for a, b, c in faces:
            ab, bc, ca = half(a, b), half(b, c), half(c, a)
            split += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
        faces = split
    return Geometry(positions=[mul(p, radius) for p in unit], triangles=faces, normals=list(unit))


def cylinder(radius: float, height: float, segments: int = 48) -> Geometry:
    """A capped cylinder from y = 0 to y = height."""
    return lathe([(0, height), (radius, height), (radius, 0), (0, 0)], segments, smooth=False)


def cone(radius: float, height: float, segments: int = 48) -> Geometry:
    """A capped cone: base at y = 0, apex at y = height."""
    return lathe([(0, height), (radius, 0), (0, 0)], segments, smooth=False)


def torus(major: float, minor: float, segments: int = 64, sides: int = 24) -> Geometry:
    """A ring around the y axis."""
    out = Geometry()
    for i in range(segments + 1):
        phi = 2 * math.pi * (i % segments) / segments
        for j in range(sides + 1):
            theta = 2 * math.pi * (j % sides) / sides
            normal = (math.cos(theta) * math.cos(phi), math.sin(theta), -math.cos(theta) * math.sin(phi))
            out.positions.append(add(mul((math.cos(phi), 0, -math.sin(phi)), major), mul(normal, minor)))
            out.normals.append(normal)
            out.uvs.append((i / segments, 1 - j / sides))
    for i in range(segments):
        for j in range(sides):
            a, b = i * (sides + 1) + j, (i + 1) * (sides + 1) + j
            out.triangles += [(a, b, b + 1), (a, b + 1, a + 1)]
    return out
