"""A forest: three trees, each drawn by EXT_mesh_gpu_instancing, on rolling ground; needs numpy."""

import math
from typing import Iterator, Optional

import numpy as np

from large_glb import FLOAT, INDICES, UINT16, UINT32, VERTICES, GlbWriter, bounds
from large_noise import mottled
from large_terrain import grid_triangles
from large_tree import SPECIES, Shape, make_tree

SPACING = 4.2  # m between trees
FEWEST, MOST = 60, 20_000  # triangles of a tree
PLACES_AT_ONCE = 1 << 18
# The hills: waves over the ground, (direction of growth per metre, height in metres).
HILLS = [((0.011, 0.007), 5.0), ((-0.017, 0.023), 3.0), ((0.047, 0.019), 1.0), ((-0.0012, -0.0021), 30.0)]


def ground(x: np.ndarray, z: np.ndarray) -> np.ndarray:
    return sum(height * np.sin(a * x + b * z + 1.7 * height) for (a, b), height in HILLS)


def places(count: int, columns: int, seed: int) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """x and z of the trees in parts: one in each cell of a grid whose row 0 is the nearest to the camera."""
    for begin in range(0, count, PLACES_AT_ONCE):
        cell = np.arange(begin, min(begin + PLACES_AT_ONCE, count))
        numbers = np.random.default_rng([seed, begin])
        shift = numbers.uniform(0.1, 0.9, (len(cell), 2))
        order = numbers.permutation(len(cell))  # so that neighbours are of different species
        x = (cell % columns + shift[:, 0] - columns / 2) * SPACING
        z = -(cell // columns + shift[:, 1]) * SPACING
        yield x[order], z[order]


def split(count: int) -> list[int]:
    """Of so many trees, how many of each species."""
    ends = [round(count * sum(s.share for s in SPECIES[:i])) for i in range(len(SPECIES) + 1)]
    return [b - a for a, b in zip(ends, ends[1:])]


def write_instances(writer: GlbWriter, count: int, columns: int) -> list[dict[str, int]]:
    """For each species the attributes of its instances."""
    parts = [min(PLACES_AT_ONCE, count - begin) for begin in range(0, count, PLACES_AT_ONCE)]
    counts = [sum(split(part)[s] for part in parts) for s in range(len(SPECIES))]
    views = [[writer.view(number * size) if number else None for size in (12, 16, 12)] for number in counts]
    for part, (x, z) in enumerate(places(count, columns, 1)):
        numbers = np.random.default_rng([2, part])
        half = numbers.uniform(0, math.pi, len(x))
        lean = numbers.normal(scale=0.02, size=(2, len(x)))
        rotation = np.stack([lean[0], np.sin(half), lean[1], np.cos(half)], -1)
        rotation /= np.sqrt((rotation * rotation).sum(-1, keepdims=True))
        girth = numbers.uniform(0.7, 1.2, len(x))
        scale = np.stack([girth, girth * numbers.uniform(0.8, 1.3, len(x)), girth], -1)
        arrays = (np.stack([x, ground(x, z) - 0.1, z], -1), rotation, scale)
        begin = 0
        for number, triple in zip(split(len(x)), views):
            for view, array in zip(triple, arrays):
                if number:
                    view.write(array[begin : begin + number].astype("<f4"))
            begin += number
    attributes = []
    for number, triple in zip(counts, views):
        kinds = zip(("TRANSLATION", "ROTATION", "SCALE"), ("VEC3", "VEC4", "VEC3"), triple)
        attributes.append({name: writer.accessor(v, FLOAT, kind, number) for name, kind, v in kinds if number})
    return attributes


def primitive(writer: GlbWriter, shape: Shape, material: int, textured: bool) -> dict[str, object]:
    count = len(shape.positions)
    attributes = {}
    arrays = {"POSITION": shape.positions, "NORMAL": shape.normals} | ({"TEXCOORD_0": shape.uvs} if textured else {})
    for name, array in arrays.items():
        array = np.ascontiguousarray(array, "<f4")
        view = writer.view(array.nbytes, VERTICES)
        view.write(array)
        more = bounds(array.min(0), array.max(0)) if name == "POSITION" else {}
        attributes[name] = writer.accessor(view, FLOAT, f"VEC{array.shape[1]}", count, **more)
    component, kind = (UINT16, "<u2") if count < 65535 else (UINT32, "<u4")
    indices = np.ascontiguousarray(shape.triangles, kind)
    view = writer.view(indices.nbytes, INDICES)
    view.write(indices)
    indices = writer.accessor(view, component, "SCALAR", indices.size)
    return {"attributes": attributes, "indices": indices, "material": material}


def ground_shape(width: float, depth: float, quads: int) -> Shape:
    """A grid from a little before the camera to behind the last tree."""
    x = np.linspace(-0.5, 0.5, quads + 1) * (width + 200)
    z = np.linspace(-depth - 100, 100, quads + 1)
    height = ground(x[None, :], z[:, None])
    positions = np.stack(np.broadcast_arrays(x[None, :], height, z[:, None]), -1).reshape(-1, 3)
    dz, dx = np.gradient(height, z, x)
    normals = np.stack([-dx, np.ones_like(dx), -dz], -1)
    normals /= np.sqrt((normals * normals).sum(-1, keepdims=True))
    triangles = grid_triangles(0, quads, quads + 1).reshape(-1, 3)
    return Shape(positions, normals.reshape(-1, 3), positions[:, ::2] / 30, triangles)


def write_forest(writer: GlbWriter, triangles: int, instances: Optional[int], textured: bool) -> str:
    each = min(max(triangles // (instances or 200), FEWEST), MOST)
    quads = min(max(8, int(math.sqrt(triangles / 20))), 512)
    trees = [make_tree(species, each, 10 + i) for i, species in enumerate(SPECIES)]
    sizes = [len(wood.triangles) + len(leaves.triangles) for wood, leaves in trees]
    mean = sum(size * species.share for size, species in zip(sizes, SPECIES))
    count = instances or max(1, round((triangles - 2 * quads * quads) / mean))
    columns = max(1, math.ceil(math.sqrt(count)))
    writer.used.add("EXT_mesh_gpu_instancing")
    picture = writer.texture(mottled((0.5, 0.5, 0.5), (1, 1, 1))) if textured else None
    bark = writer.material("bark", (0.11, 0.075, 0.05), picture)
    drawn = 2 * quads * quads
    for species, tree, attributes, size in zip(SPECIES, trees, write_instances(writer, count, columns), sizes):
        if not attributes:
            continue
        leaf = writer.material(species.name, species.color, picture, doubleSided=True)
        primitives = [primitive(writer, shape, m, textured) for shape, m in zip(tree, (bark, leaf))]
        mesh = writer.append("meshes", {"name": species.name, "primitives": primitives})
        extensions = {"EXT_mesh_gpu_instancing": {"attributes": attributes}}
        writer.append("nodes", {"name": species.name, "mesh": mesh, "extensions": extensions})
        drawn += size * writer.arrays["accessors"][attributes["TRANSLATION"]]["count"]
    floor = writer.material("ground", (0.14, 0.13, 0.06), picture)
    shape = ground_shape(columns * SPACING, columns * SPACING, quads)
    mesh = writer.append("meshes", {"name": "ground", "primitives": [primitive(writer, shape, floor, textured)]})
    writer.append("nodes", {"name": "ground", "mesh": mesh})
    top = float(ground(np.zeros(1), np.array([20.0]))[0])
    writer.camera((0, top + 22, 30), (0, top + 5, -30), 0.75, 16 / 9)
    return f"{drawn} triangles drawn, {count} trees of {min(sizes)} to {max(sizes)} triangles"
