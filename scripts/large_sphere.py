"""A displaced sphere, by numpy or without it: the same file."""

import math
import sys
from array import array
from typing import Any, Iterator, Optional

from gltf_shapes import Vec3
from large_glb import FLOAT, INDICES, UINT32, VERTICES, GlbWriter, bounds

try:
    import numpy
except ImportError:
    numpy = None

# The displacement: waves over the unit sphere, (direction of growth, frequency, height).
WAVES = [
    ((0.36, 0.48, 0.80), 5.0, 0.06),
    ((-0.80, 0.36, 0.48), 11.0, 0.03),
    ((0.48, -0.80, 0.36), 23.0, 0.015),
    ((0.60, 0.64, -0.48), 61.0, 0.005),
    ((-0.28, 0.96, 0.00), 157.0, 0.002),
]
ROWS_AT_ONCE = 1 << 19  # vertices, about

# Of some rows: positions, normals, texture coordinates, and the bounds of the positions.
Rows = tuple[Any, Any, Any, list[float], list[float]]


def grid_size(triangles: int) -> tuple[int, int]:
    """Segments around and rings from pole to pole: a sphere of 2 s (r - 1) triangles, s = 2 r."""
    rings = max(3, round(math.sqrt(triangles / 4 + 0.25) + 0.5))
    return 2 * rings, rings


def vertices_numpy(segments: int, rings: int, uvs: bool) -> Iterator[Rows]:
    """The poles' rows have a vertex per column, as have all."""
    step = max(1, ROWS_AT_ONCE // segments)
    phi = (numpy.arange(segments + 1) % segments * (2 * math.pi / segments))[None, :]
    for begin in range(0, rings + 1, step):
        rows = numpy.arange(begin, min(begin + step, rings + 1))[:, None]
        theta = math.pi * rows / rings
        sphere = [numpy.sin(theta) * numpy.cos(phi), numpy.cos(theta) + 0 * phi, -numpy.sin(theta) * numpy.sin(phi)]
        radius, gradient = 1.0, [0.0, 0.0, 0.0]
        for axis, frequency, height in WAVES:
            phase = frequency * sum(a * c for a, c in zip(axis, sphere))
            radius = radius + height * numpy.sin(phase)
            slope = height * frequency * numpy.cos(phase)
            gradient = [g + slope * a for g, a in zip(gradient, axis)]
        radial = sum(g * c for g, c in zip(gradient, sphere))
        normal = [radius * c - (g - radial * c) for g, c in zip(gradient, sphere)]
        length = numpy.sqrt(sum(n * n for n in normal))
        positions = numpy.stack([radius * c for c in sphere], -1).astype("<f4")
        normals = numpy.stack([n / length for n in normal], -1).astype("<f4")
        texture = numpy.empty((*positions.shape[:2], 2), "<f4") if uvs else b""
        if uvs:
            texture[..., 0], texture[..., 1] = numpy.arange(segments + 1) / segments, rows / rings
        low, high = positions.min((0, 1)), positions.max((0, 1))
        yield positions, normals, texture, low.tolist(), high.tolist()


def displaced(c: Vec3) -> tuple[Vec3, Vec3]:
    """The point of the surface over the unit vector c, and its normal: of r(c) c it is r c minus the part of r's
    gradient that is tangent to the sphere."""
    radius, gx, gy, gz = 1.0, 0.0, 0.0, 0.0
    for (ax, ay, az), frequency, height in WAVES:
        phase = frequency * (ax * c[0] + ay * c[1] + az * c[2])
        radius += height * math.sin(phase)
        slope = height * frequency * math.cos(phase)
        gx, gy, gz = gx + slope * ax, gy + slope * ay, gz + slope * az
    keep = radius + gx * c[0] + gy * c[1] + gz * c[2]
    x, y, z = keep * c[0] - gx, keep * c[1] - gy, keep * c[2] - gz
    scale = 1 / math.sqrt(x * x + y * y + z * z)
    return (radius * c[0], radius * c[1], radius * c[2]), (x * scale, y * scale, z * scale)


def vertices_plain(segments: int, rings: int, uvs: bool) -> Iterator[Rows]:
    circle = [2 * math.pi * (j % segments) / segments for j in range(segments + 1)]
    turns = [(math.cos(phi), math.sin(phi)) for phi in circle]
    for i in range(rings + 1):
        positions, normals, texture = array("f"), array("f"), array("f")
        s, c = math.sin(math.pi * i / rings), math.cos(math.pi * i / rings)
        for j, (cos_phi, sin_phi) in enumerate(turns):
            position, normal = displaced((s * cos_phi, c, -s * sin_phi))
            positions.extend(position)
            normals.extend(normal)
            if uvs:
                texture.extend((j / segments, i / rings))
        low, high = ([limit(positions[k::3]) for k in range(3)] for limit in (min, max))
        yield little_endian(positions), little_endian(normals), little_endian(texture), low, high


def triangles_plain(segments: int, rings: int) -> Iterator[bytes]:
    for i in range(rings):
        indices = array("I")
        row = i * (segments + 1)
        for a in range(row, row + segments):
            b = a + segments + 1
            if i < rings - 1:
                indices.extend((a, b, b + 1))
            if i > 0:
                indices.extend((a, b + 1, a + 1))
        yield little_endian(indices)


def triangles_numpy(segments: int, rings: int) -> Iterator[Any]:
    step = max(1, ROWS_AT_ONCE // segments)
    for begin in range(0, rings, step):
        rows = numpy.arange(begin, min(begin + step, rings), dtype="<u4")[:, None]
        a = rows * (segments + 1) + numpy.arange(segments, dtype="<u4")[None, :]
        b = a + numpy.uint32(segments + 1)
        pairs = numpy.stack([a, b, b + 1, a, b + 1, a + 1], -1).reshape(*a.shape, 2, 3)
        keep = numpy.ones(pairs.shape[:3], bool)
        keep[rows[:, 0] == 0, :, 1] = keep[rows[:, 0] == rings - 1, :, 0] = False  # half of a pole's quad has no area
        yield pairs[keep]


def little_endian(values: array) -> bytes:
    if sys.byteorder == "big":
        values.byteswap()
    return values.tobytes()


def write_sphere(writer: GlbWriter, triangles: int, picture: Optional[bytes], plain: bool) -> str:
    """Without a picture there are no texture coordinates. What was written, in words."""
    segments, rings = grid_size(triangles)
    count, triangle_count = (segments + 1) * (rings + 1), 2 * segments * (rings - 1)
    fast = numpy is not None and not plain
    vertices, faces = (vertices_numpy, triangles_numpy) if fast else (vertices_plain, triangles_plain)
    uvs = picture is not None
    views = [writer.view(count * size, VERTICES) for size in ((12, 12, 8) if uvs else (12, 12))]
    index_view = writer.view(triangle_count * 12, INDICES)
    low, high = [math.inf] * 3, [-math.inf] * 3
    for *arrays, row_low, row_high in vertices(segments, rings, uvs):
        for view, data in zip(views, arrays):
            view.write(data)
        low, high = list(map(min, low, row_low)), list(map(max, high, row_high))
    for indices in faces(segments, rings):
        index_view.write(indices)
    attributes = {"POSITION": writer.accessor(views[0], FLOAT, "VEC3", count, **bounds(low, high))}
    attributes["NORMAL"] = writer.accessor(views[1], FLOAT, "VEC3", count)
    if uvs:
        attributes["TEXCOORD_0"] = writer.accessor(views[2], FLOAT, "VEC2", count)
    grey = (0.6, 0.58, 0.55) if picture is None else (1, 1, 1)
    material = writer.material("grey", grey, writer.texture(picture) if picture is not None else None)
    indices = writer.accessor(index_view, UINT32, "SCALAR", 3 * triangle_count)
    primitive = {"attributes": attributes, "indices": indices, "material": material}
    writer.append("nodes", {"name": "body", "mesh": writer.append("meshes", {"primitives": [primitive]})})
    writer.camera((0, 0, 3.6), (0, 0, 0))
    return f"{triangle_count} triangles, {count} vertices"
