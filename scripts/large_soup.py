"""A soup: many small meshes, each a node of its own, boxes, blobs and clouds of loose triangles; needs numpy."""

import math
from typing import Any, Optional

import numpy as np

from large_glb import FLOAT, INDICES, UINT16, VERTICES, GlbWriter
from large_noise import mottled

LOOSE = 500  # triangles of a cloud
PIECES_AT_ONCE = 1000
COLORS = [(0.6, 0.2, 0.12), (0.7, 0.5, 0.15), (0.2, 0.35, 0.5), (0.65, 0.63, 0.6), (0.15, 0.3, 0.15), (0.3, 0.15, 0.35)]


def blob_grid() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Directions, texture coordinates and triangles of a sphere of 500 triangles."""
    segments, rings = 25, 11
    theta = np.linspace(0, math.pi, rings + 1)[:, None]
    phi = (np.arange(segments + 1) % segments * (2 * math.pi / segments))[None, :]
    sphere = [np.sin(theta) * np.cos(phi), np.cos(theta) + 0 * phi, -np.sin(theta) * np.sin(phi)]
    uvs = np.broadcast_arrays(np.arange(segments + 1) / segments, theta / math.pi)
    a = np.arange(rings)[:, None] * (segments + 1) + np.arange(segments)
    b = a + segments + 1
    pairs = np.stack([a, b, b + 1, a, b + 1, a + 1], -1).reshape(rings, segments, 2, 3)
    keep = np.ones(pairs.shape[:3], bool)
    keep[0, :, 1] = keep[-1, :, 0] = False
    return np.stack(sphere, -1).reshape(-1, 3), np.stack(uvs, -1).reshape(-1, 2), pairs[keep]


def box_grid() -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Positions on the cube from -1 to 1, normals, texture coordinates and triangles: 504 in 6 sides of 7 x 6 quads."""
    u, v = np.meshgrid(np.arange(8) / 7, np.arange(7) / 6)
    a = (np.arange(6)[:, None] * 8 + np.arange(7)).reshape(-1, 1)
    quads = np.concatenate([a, a + 1, a + 9, a, a + 9, a + 8], 1).reshape(-1, 3)
    flat = np.stack([2 * u - 1, 2 * v - 1, np.ones_like(u)], -1).reshape(-1, 3)
    positions, normals = [], []
    for axis in range(3):
        for sign in (1, -1):
            # A turn of the axes, and for the far side a half turn about one of them, keep the front outside.
            turned = np.roll(flat * (sign, 1, sign), axis, 1)
            positions.append(turned)
            normals.append(np.broadcast_to(np.roll([0, 0, sign], axis), turned.shape))
    uvs = np.tile(np.stack([u, v], -1).reshape(-1, 2), (6, 1))
    triangles = np.concatenate([quads + 56 * side for side in range(6)])
    return np.concatenate(positions), np.concatenate(normals), uvs, triangles


def blobs(count: int, numbers: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Positions and normals of spheres displaced by three waves each; the normal is r c minus what of r's gradient is
    tangent to the sphere."""
    c = blob_grid()[0][None]
    axis = numbers.normal(size=(3, count, 1, 3))
    phase = numbers.uniform(0, 2 * math.pi, (3, count, 1))
    radius, gradient = np.ones((count, c.shape[1])), np.zeros((count, c.shape[1], 3))
    for a, p, height in zip(axis * 2.5, phase, (0.16, 0.12, 0.08)):
        wave = (a * c).sum(-1) + p
        radius += height * np.sin(wave)
        gradient += height * np.cos(wave)[..., None] * a
    normal = radius[..., None] * c - (gradient - (gradient * c).sum(-1, keepdims=True) * c)
    return radius[..., None] * c, normal / np.sqrt((normal * normal).sum(-1, keepdims=True))


def shards(count: int, numbers: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Loose triangles all over a ball: no vertex belongs to two."""
    centre = numbers.normal(size=(count, LOOSE, 1, 3))
    centre *= numbers.random((count, LOOSE, 1, 1)) ** (1 / 3) / np.sqrt((centre * centre).sum(-1, keepdims=True))
    corners = centre + numbers.normal(scale=0.09, size=(count, LOOSE, 3, 3))
    normal = np.cross(corners[:, :, 1] - corners[:, :, 0], corners[:, :, 2] - corners[:, :, 0])
    normal /= np.sqrt((normal * normal).sum(-1, keepdims=True))
    return corners.reshape(count, -1, 3), np.repeat(normal, 3, 1)


class Kind:
    """Pieces that have the same number of vertices and of triangles, one after the other in the same views."""

    def __init__(self, writer: GlbWriter, count: int, uvs: Any, triangles: Any, textured: bool) -> None:
        self.vertices, self.uvs, self.triangles = len(uvs), uvs.astype("<f4"), triangles
        sizes = (12, 12, 8) if textured else (12, 12)
        self.views = [writer.view(count * self.vertices * size, VERTICES, size) for size in sizes]
        self.index_view = writer.view(count * triangles.nbytes, INDICES) if triangles is not None else None
        self.written = 0

    def write(self, writer: GlbWriter, positions: np.ndarray, normals: np.ndarray, material: list[int]) -> list[int]:
        """The meshes of some pieces."""
        count = len(positions)
        arrays = [positions.astype("<f4"), normals.astype("<f4"), np.broadcast_to(self.uvs, (count, *self.uvs.shape))]
        for view, array in zip(self.views, arrays):
            view.write(np.ascontiguousarray(array))
        if self.index_view:
            self.index_view.write(np.ascontiguousarray(np.broadcast_to(self.triangles, (count, *self.triangles.shape))))
        lows, highs = arrays[0].min(1).tolist(), arrays[0].max(1).tolist()
        return [self._mesh(writer, lows[i], highs[i], material[i]) for i in range(count)]

    def _mesh(self, writer: GlbWriter, low: list[float], high: list[float], material: int) -> int:
        attributes = {}
        for view, name, kind in zip(self.views, ("POSITION", "NORMAL", "TEXCOORD_0"), ("VEC3", "VEC3", "VEC2")):
            offset = self.written * self.vertices * (8 if kind == "VEC2" else 12)
            more = {"min": low, "max": high} if name == "POSITION" else {}
            attributes[name] = writer.accessor(view, FLOAT, kind, self.vertices, offset, **more)
        primitive = {"attributes": attributes, "material": material}
        if self.index_view:
            offset = self.written * self.triangles.nbytes
            size = self.triangles.size
            primitive["indices"] = writer.accessor(self.index_view, UINT16, "SCALAR", size, offset)
        self.written += 1
        return writer.append("meshes", {"primitives": [primitive]})


def add_nodes(writer: GlbWriter, meshes: list[int], half: float, numbers: np.random.Generator) -> None:
    """Each mesh in a cube of that half width, turned and scaled anyhow."""
    count = len(meshes)
    place = numbers.uniform(-half, half, (count, 3)).round(3).tolist()
    turn = numbers.normal(size=(count, 4))
    turn = (turn / np.sqrt((turn * turn).sum(-1, keepdims=True))).round(6).tolist()
    scale = (numbers.uniform(0.2, 0.6, (count, 1)) * numbers.uniform(0.5, 1.5, (count, 3))).round(3).tolist()
    for mesh, t, r, s in zip(meshes, place, turn, scale):
        writer.append("nodes", {"mesh": mesh, "translation": t, "rotation": r, "scale": s})


def write_soup(writer: GlbWriter, triangles: int, loose: float, textured: bool) -> str:
    pieces = max(1, round(triangles / LOOSE))
    clouds = round(pieces * loose)
    boxes = (pieces - clouds) // 2
    half = 0.62 * pieces ** (1 / 3)
    picture = writer.texture(mottled((0.4, 0.4, 0.4), (1, 1, 1))) if textured else None
    materials = [writer.material(f"color {i}", color, picture) for i, color in enumerate(COLORS)]
    box, box_normals, box_uvs, box_triangles = box_grid()
    _, blob_uvs, blob_triangles = blob_grid()
    flat = np.tile(np.array([(0, 0), (1, 0), (0, 1)]), (LOOSE, 1))

    def copies(count: int, numbers: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
        return np.broadcast_to(box, (count, *box.shape)), np.broadcast_to(box_normals, (count, *box.shape))

    drawn = 0
    for seed, (count, make, uvs, faces) in enumerate(
        (
            (boxes, copies, box_uvs, box_triangles.astype("<u2")),
            (pieces - clouds - boxes, blobs, blob_uvs, blob_triangles.astype("<u2")),
            (clouds, shards, flat, None),
        )
    ):
        if not count:
            continue
        numbers = np.random.default_rng(seed)
        kind = Kind(writer, count, uvs, faces, textured)
        for begin in range(0, count, PIECES_AT_ONCE):
            some = min(PIECES_AT_ONCE, count - begin)
            colors = [materials[i] for i in numbers.integers(len(materials), size=some).tolist()]
            add_nodes(writer, kind.write(writer, *make(some, numbers), colors), half, numbers)
        drawn += count * (LOOSE if faces is None else len(faces))
    writer.camera((1.1 * half, 0.9 * half, 4 * half), (0, -0.05 * half, 0), 0.68, 1)
    return f"{drawn} triangles in {pieces} meshes, {clouds * LOOSE} of them loose"
