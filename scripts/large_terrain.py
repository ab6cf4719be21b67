"""A terrain: mountains over valleys, as a height field of one mesh; needs numpy."""

import math
from typing import Iterator

import numpy as np

from large_glb import FLOAT, INDICES, UINT32, VERTICES, GlbWriter, bounds
from large_noise import SIDE, bumps, fractal, hashed, noise, png_of, texel_centres, to_srgb

WIDTH, HEIGHT = 1000.0, 210.0  # m
VERTICES_AT_ONCE = 1 << 19
FINEST = 13  # octaves of the ridges; a coarse grid has fewer


def heights(x: np.ndarray, z: np.ndarray, octaves: int) -> np.ndarray:
    """In metres, of a grid of places in [0, 1]: rows z, columns x. Ridges (Musgrave's multifractal: a ridge is rough
    where the one above it is) over broad masses that leave valleys between them."""
    border = [np.clip(np.minimum(at, 1 - at) / 0.16, 0, 1) for at in (x, z)]
    border = (border[0] * border[0])[None, :] * (border[1] * border[1])[:, None]  # no mountain is cut by the edge
    mass = np.clip(0.62 + 1.1 * fractal(x * 3.2 + 0.37, z * 3.2 + 0.61, 1, 3), 0.02, 1) * (0.15 + 0.85 * border)
    total, weight = np.zeros_like(mass), np.ones_like(mass)
    for i in range(octaves):
        frequency, height = 3.1 * 2**i, 0.47**i
        ridge = 1 - np.abs(noise(x * frequency + 0.17 * i, z * frequency + 0.29 * i, 20 + i)) * np.float32(1.45)
        ridge = ridge * ridge * weight
        total += ridge * np.float32(height)
        weight = np.clip(ridge * np.float32(1.7), 0, 1)
    return (mass**1.6 * (total * 0.62 - 0.1) * HEIGHT).astype(np.float32)


def octaves_for(step: float) -> int:
    """Those whose waves a grid of this step (of the whole width) can show."""
    return max(1, min(FINEST, int(math.log2(0.25 / (3.1 * step))) + 1))


def strips(rows: int, columns: int) -> Iterator[tuple[int, int]]:
    step = max(1, VERTICES_AT_ONCE // columns)
    for begin in range(0, rows, step):
        yield begin, min(begin + step, rows)


def upward(height: np.ndarray, step: float) -> np.ndarray:
    """Unit normals of a height field."""
    dz, dx = np.gradient(height, np.float32(step))
    normal = np.stack([-dx, np.ones_like(dx), -dz], -1)
    return normal / np.sqrt((normal * normal).sum(-1, keepdims=True))


def grid_triangles(begin: int, end: int, columns: int) -> np.ndarray:
    """Of the quads below the rows of vertices [begin, end), whose fronts are up; rows follow z, columns x."""
    a = np.arange(begin, end, dtype="<u4")[:, None] * columns + np.arange(columns - 1, dtype="<u4")[None, :]
    b = a + np.uint32(columns)
    return np.stack([a, b, b + 1, a, b + 1, a + 1], -1)


def ground_colors() -> np.ndarray:
    """Meadows in the valleys, rock where it is steep, snow on what is high and flat enough."""
    at = texel_centres()
    height = heights(at, at, octaves_for(1 / SIDE))
    flat = upward(height, WIDTH / SIDE)[..., 1]
    spots = fractal(at * 40, at * 40, 70, 5)
    grain = (hashed(np.arange(SIDE)[None, :], np.arange(SIDE)[:, None], 3) * np.float32(2**-32) - 0.5)[..., None]

    def step(low: float, high: float, value: np.ndarray) -> np.ndarray:
        t = np.clip((value - low) / (high - low), 0, 1)[..., None]
        return t * t * (3 - 2 * t)

    color = np.array([0.16, 0.2, 0.06]) + spots[..., None] * np.array([0.1, 0.07, 0.04])
    for other, share in (
        ((0.34, 0.29, 0.2), step(25, 75, height + 25 * spots)),
        ((0.24, 0.22, 0.2), step(0.86, 0.7, flat + 0.1 * spots)),
        ((0.86, 0.88, 0.92), step(75, 95, height + 30 * spots) * step(0.6, 0.75, flat + 0.1 * spots)),
    ):
        color = color + share * (np.array(other) * (1 + 0.4 * spots[..., None]) - color)
    return color * (1 + 0.15 * grain)


def write_terrain(writer: GlbWriter, triangles: int, textured: bool) -> str:
    quads = max(1, round(math.sqrt(triangles / 2)))
    side, step = quads + 1, WIDTH / quads
    at = np.arange(side) / quads
    octaves = octaves_for(1 / quads)
    views = [writer.view(side * side * size, VERTICES) for size in ((12, 12, 8) if textured else (12, 12))]
    index_view = writer.view(quads * quads * 24, INDICES)
    lowest, highest = math.inf, -math.inf
    for begin, end in strips(side, side):
        first, last = max(begin - 1, 0), min(end + 1, side)  # a row more on each side, for the slopes
        height = heights(at, at[first:last], octaves)
        keep = slice(begin - first, end - first)
        normals = upward(height, step)[keep].astype("<f4")
        height = height[keep]
        positions = np.empty((end - begin, side, 3), "<f4")
        positions[..., 0], positions[..., 1] = (at - 0.5) * WIDTH, height
        positions[..., 2] = ((at[begin:end] - 0.5) * WIDTH)[:, None]
        views[0].write(positions)
        views[1].write(normals)
        if textured:
            uvs = np.empty((end - begin, side, 2), "<f4")
            uvs[..., 0], uvs[..., 1] = at, at[begin:end, None]
            views[2].write(uvs)
        lowest, highest = min(lowest, float(height.min())), max(highest, float(height.max()))
    for begin, end in strips(quads, side):
        index_view.write(grid_triangles(begin, end, side))
    edge = WIDTH / 2
    box = bounds((-edge, lowest, -edge), (edge, highest, edge))
    attributes = {"POSITION": writer.accessor(views[0], FLOAT, "VEC3", side * side, **box)}
    attributes["NORMAL"] = writer.accessor(views[1], FLOAT, "VEC3", side * side)
    more, texture = {}, None
    if textured:
        attributes["TEXCOORD_0"] = writer.accessor(views[2], FLOAT, "VEC2", side * side)
        texture = writer.texture(png_of(to_srgb(ground_colors())))
        tiled = {"KHR_texture_transform": {"scale": [24, 24]}}
        more["normalTexture"] = {"index": writer.texture(bumps(0.5)), "extensions": tiled}
        writer.used.add("KHR_texture_transform")
    material = writer.material("ground", (1, 1, 1) if textured else (0.42, 0.38, 0.33), texture, **more)
    indices = writer.accessor(index_view, UINT32, "SCALAR", quads * quads * 6)
    primitive = {"attributes": attributes, "indices": indices, "material": material}
    writer.append("nodes", {"name": "terrain", "mesh": writer.append("meshes", {"primitives": [primitive]})})
    writer.camera((0, 300, 830), (0, 20, 20), 0.55, 16 / 9)
    return f"{2 * quads * quads} triangles, {side * side} vertices"
