#!/usr/bin/env python3
"""Writes a .glb with one displaced sphere of about N triangles, for benchmarks of large meshes.

    scripts/make_mesh.py N OUT.glb

Smooth normals, a grey Lambert surface, a sky from an embedded .hdr, a camera that frames it. Uses numpy where it is
installed (a million triangles take about a second); without it the same mesh takes some ten times longer.
"""

import argparse
import json
import math
import struct
import sys
from array import array
from pathlib import Path
from typing import Any

from gltf_shapes import Vec3, mul
from image_files import environment_hdr

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


def grid_size(triangles: int) -> tuple[int, int]:
    """Segments around and rings from pole to pole: a sphere of 2 s (r - 1) triangles, s = 2 r."""
    rings = max(3, round(math.sqrt(triangles / 4 + 0.25) + 0.5))
    return 2 * rings, rings


def vertices_numpy(segments: int, rings: int) -> tuple[bytes, bytes]:
    """Positions and normals as packed float32: the poles' rows have a vertex per column, as have all."""
    theta = numpy.linspace(0, math.pi, rings + 1)[:, None]
    phi = (numpy.arange(segments + 1) % segments * (2 * math.pi / segments))[None, :]
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
    return positions.tobytes(), normals.tobytes()


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


def vertices_plain(segments: int, rings: int) -> tuple[bytes, bytes]:
    positions, normals = array("f"), array("f")
    circle = [2 * math.pi * (j % segments) / segments for j in range(segments + 1)]
    turns = [(math.cos(phi), math.sin(phi)) for phi in circle]
    for i in range(rings + 1):
        s, c = math.sin(math.pi * i / rings), math.cos(math.pi * i / rings)
        for cos_phi, sin_phi in turns:
            position, normal = displaced((s * cos_phi, c, -s * sin_phi))
            positions.extend(position)
            normals.extend(normal)
    return little_endian(positions), little_endian(normals)


def triangles_plain(segments: int, rings: int) -> bytes:
    indices = array("I")
    for i in range(rings):
        row = i * (segments + 1)
        for a in range(row, row + segments):
            b = a + segments + 1
            if i < rings - 1:
                indices.extend((a, b, b + 1))
            if i > 0:
                indices.extend((a, b + 1, a + 1))
    return little_endian(indices)


def triangles_numpy(segments: int, rings: int) -> bytes:
    a = (numpy.arange(rings)[:, None] * (segments + 1) + numpy.arange(segments)[None, :]).astype("<u4")
    b = a + segments + 1
    pairs = numpy.stack([numpy.stack([a, b, b + 1], -1), numpy.stack([a, b + 1, a + 1], -1)], 2)
    keep = numpy.ones(pairs.shape[:3], bool)
    keep[0, :, 1] = keep[-1, :, 0] = False  # the poles: half of each quad has no area
    return pairs[keep].tobytes()


def little_endian(values: array) -> bytes:
    if sys.byteorder == "big":
        values.byteswap()
    return values.tobytes()


def sky(w: Vec3) -> Vec3:
    """Grey-blue, with a broad warm lamp to the upper left."""
    towards = max(0.0, (-0.5 * w[0] + 0.7 * w[1] + 0.5 * w[2]) / math.sqrt(0.99))
    warm = 6.0 * towards**40
    base = mul((0.45, 0.55, 0.7), 0.6 + 0.4 * w[1])
    return base[0] + warm, base[1] + 0.9 * warm, base[2] + 0.75 * warm


def document(counts: tuple[int, int], sections: list[bytes], bounds: tuple[list[float], list[float]]) -> dict[str, Any]:
    """The glTF around the sections positions, normals, indices and the sky's picture."""
    vertex_count, index_count = counts
    views, offset = [], 0
    for data, target in zip(sections, (34962, 34962, 34963, None)):
        view = {"buffer": 0, "byteOffset": offset, "byteLength": len(data)}
        views.append(view | ({"target": target} if target else {}))
        offset += len(data) + -len(data) % 4
    vec3 = {"componentType": 5126, "count": vertex_count, "type": "VEC3"}
    lambert = {"KHR_materials_specular": {"specularFactor": 0}}
    grey = {"baseColorFactor": [0.6, 0.58, 0.55, 1], "metallicFactor": 0, "roughnessFactor": 1}
    environments = {"EXT_lights_environment": {"environments": [{"source": 0, "intensity": 1}]}}
    return {
        "asset": {"version": "2.0", "generator": "Parian scripts/make_mesh.py"},
        "extensionsUsed": ["EXT_lights_environment", "KHR_materials_specular"],
        "extensions": environments,
        "scene": 0,
        "scenes": [{"nodes": [0, 1], "extensions": {"EXT_lights_environment": {"environment": 0}}}],
        "nodes": [{"name": "body", "mesh": 0}, {"name": "camera", "camera": 0, "translation": [0, 0, 3.6]}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.68, "aspectRatio": 1, "znear": 0.01}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2, "material": 0}]}],
        "materials": [{"name": "grey", "pbrMetallicRoughness": grey, "extensions": lambert}],
        "images": [{"bufferView": 3, "mimeType": "image/vnd.radiance"}],
        "accessors": [
            {"bufferView": 0, **vec3, "min": bounds[0], "max": bounds[1]},
            {"bufferView": 1, **vec3},
            {"bufferView": 2, "componentType": 5125, "count": index_count, "type": "SCALAR"},
        ],
        "bufferViews": views,
        "buffers": [{"byteLength": offset}],
    }


def float_bounds(positions: bytes) -> tuple[list[float], list[float]]:
    values = array("f", positions)
    if sys.byteorder == "big":
        values.byteswap()
    return [min(values[i::3]) for i in range(3)], [max(values[i::3]) for i in range(3)]


def write_glb(path: Path, gltf: dict[str, Any], sections: list[bytes]) -> None:
    text = json.dumps(gltf, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    size = gltf["buffers"][0]["byteLength"]
    with open(path, "wb") as file:
        file.write(struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + size))
        file.write(struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", size, b"BIN\0"))
        for data in sections:
            file.write(data + b"\0" * (-len(data) % 4))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("triangles", type=int, metavar="N", help="how many triangles, about")
    parser.add_argument("out", type=Path, metavar="OUT.glb")
    parser.add_argument("--no-numpy", action="store_true", help="do without numpy")
    args = parser.parse_args()
    if args.triangles < 1 or args.triangles > 500_000_000:
        parser.error("N must be between 1 and 500000000")
    segments, rings = grid_size(args.triangles)
    fast = numpy is not None and not args.no_numpy
    vertices, triangles = (vertices_numpy, triangles_numpy) if fast else (vertices_plain, triangles_plain)
    positions, normals = vertices(segments, rings)
    sections = [positions, normals, triangles(segments, rings), environment_hdr(128, 64, sky)]
    counts = (len(positions) // 12, len(sections[2]) // 4)
    write_glb(args.out, document(counts, sections, float_bounds(positions)), sections)
    print(f"{args.out}: {counts[1] // 3} triangles, {counts[0]} vertices")


if __name__ == "__main__":
    main()
