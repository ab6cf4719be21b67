"""Trees for the forest: a trunk and branches as tubes, leaves as loose quads; needs numpy."""

import math
from dataclasses import dataclass
from typing import Callable

import numpy as np

Ends = Callable[[np.random.Generator, int], tuple[np.ndarray, np.ndarray]]


@dataclass
class Shape:
    """Triangles that share vertices within each tube or quad."""

    positions: np.ndarray
    normals: np.ndarray
    uvs: np.ndarray
    triangles: np.ndarray

    @staticmethod
    def joined(parts: list["Shape"]) -> "Shape":
        starts = np.cumsum([0] + [len(part.positions) for part in parts])
        triangles = [part.triangles + start for part, start in zip(parts, starts)]
        fields = [[getattr(part, name) for part in parts] for name in ("positions", "normals", "uvs")]
        return Shape(*(np.concatenate(field) for field in fields), np.concatenate(triangles))


def unit(v: np.ndarray) -> np.ndarray:
    return v / np.maximum(np.sqrt((v * v).sum(-1, keepdims=True)), 1e-12)


def tube(begin: np.ndarray, end: np.ndarray, radii: tuple[float, float], sides: int, rings: int) -> Shape:
    """From begin to end, open, a little bent upwards in its middle; 2 sides (rings - 1) triangles."""
    t = np.linspace(0, 1, rings)[:, None]
    centres = begin + (end - begin) * t
    centres[:, 1] += 0.12 * math.dist(begin[::2], end[::2]) * np.sin(math.pi * t[:, 0])
    axis = unit(end - begin)
    across = unit(np.cross(axis, (1, 0, 0) if abs(axis[0]) < 0.8 else (0, 0, 1)))
    phi = np.arange(sides + 1)[:, None] * (2 * math.pi / sides)
    normals = across * np.cos(phi) + np.cross(axis, across) * np.sin(phi)
    radius = radii[0] + (radii[1] - radii[0]) * t
    positions = centres[:, None] + radius[:, None] * normals
    uvs = np.stack(np.broadcast_arrays(np.arange(sides + 1) / sides, 3 * t), -1)
    a = (np.arange(rings - 1)[:, None] * (sides + 1) + np.arange(sides)).reshape(-1, 1)
    b = a + sides + 1
    triangles = np.concatenate([a, a + 1, b + 1, a, b + 1, b], 1).reshape(-1, 3)
    flat = [x.reshape(-1, x.shape[-1]) for x in (positions, np.broadcast_to(normals, positions.shape), uvs)]
    return Shape(*flat, triangles)


def leaves(centres: np.ndarray, size: float, numbers: np.random.Generator) -> Shape:
    """A quad at each centre, turned any way, its front rather up than down."""
    count = len(centres)
    normal = unit(numbers.normal(size=(count, 3)) + (0, 0.6, 0))
    normal[normal[:, 1] < 0] *= -1
    across = unit(np.cross(normal, numbers.normal(size=(count, 3))))
    along = np.cross(normal, across)
    length = size * numbers.uniform(0.7, 1.3, (count, 1))
    turns = ((-0.5, -0.8), (0.5, -0.8), (0.5, 0.8), (-0.5, 0.8))
    corners = [centres + (sx * across + sy * along) * length for sx, sy in turns]
    place = numbers.random((count, 1, 2))  # each shows a piece of the picture of its own
    uvs = place + np.array([(0, 0), (1, 0), (1, 1), (0, 1)]) * 0.05
    triangles = np.arange(count)[:, None, None] * 4 + np.array([(0, 1, 2), (0, 2, 3)])
    positions = np.stack(corners, 1).reshape(-1, 3)
    return Shape(positions, np.repeat(normal, 4, 0), uvs.reshape(-1, 2), triangles.reshape(-1, 3))


def conifer(numbers: np.random.Generator, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Where branches begin and end, metres: whorls that shrink towards the top."""
    y = 1 + 8 * np.sqrt((np.arange(count) + 0.5) / count)
    reach = 2.3 * (1 - y / 9.6) + 0.15
    phi = np.arange(count) * 2.39996
    begins = np.stack([0 * y, y, 0 * y], -1)
    return begins, np.stack([reach * np.cos(phi), y - 0.3 * reach, reach * np.sin(phi)], -1)


def in_crown(numbers: np.random.Generator, count: int, middle: float, radii: tuple[float, float]) -> np.ndarray:
    """Places in an ellipsoid about (0, middle, 0), rather at its hull."""
    places = unit(numbers.normal(size=(count, 3))) * numbers.uniform(0.4, 1, (count, 1)) ** (1 / 3)
    return places * (radii[0], radii[1], radii[0]) + (0, middle, 0)


def broad(numbers: np.random.Generator, count: int) -> tuple[np.ndarray, np.ndarray]:
    ends = in_crown(numbers, count, 5.2, (2.7, 2.2))
    return np.stack([0 * ends[:, 0], 1.8 + 0.45 * (ends[:, 1] - 3), 0 * ends[:, 0]], -1), ends


def poplar(numbers: np.random.Generator, count: int) -> tuple[np.ndarray, np.ndarray]:
    ends = in_crown(numbers, count, 6, (1.0, 4.6))
    return np.stack([0 * ends[:, 0], np.maximum(0.8, ends[:, 1] - 0.9), 0 * ends[:, 0]], -1), ends


@dataclass
class Species:
    name: str
    height: float  # of the trunk, m
    ends: Ends
    foliage: float  # area of all leaves, m^2
    color: tuple[float, float, float]
    share: float  # of the trees


SPECIES = [
    Species("conifer", 9.3, conifer, 65, (0.05, 0.12, 0.05), 0.5),
    Species("broad", 5.5, broad, 85, (0.16, 0.25, 0.04), 0.35),
    Species("poplar", 9, poplar, 50, (0.32, 0.25, 0.03), 0.15),
]


def make_tree(species: Species, triangles: int, seed: int) -> tuple[Shape, Shape]:
    """Wood and leaves, about that many triangles together (50 at least)."""
    numbers = np.random.default_rng(seed)
    sides, rings = (8, 6) if triangles >= 2000 else (5, 3)
    top = np.array([0.0, species.height, 0.0])
    wood = [tube(np.zeros(3), top, (0.22, 0.03), sides, rings)]
    branches = max(12, triangles // 5 // 16)
    begins, ends = species.ends(numbers, branches)
    if triangles >= 500:
        wood += [tube(begin, end, (0.05, 0.01), 4, 3) for begin, end in zip(begins, ends)]
    count = max(10, (triangles - sum(len(part.triangles) for part in wood)) // 2)
    which = numbers.integers(branches, size=count)
    along = numbers.uniform(0.2, 1.05, (count, 1))
    centres = begins[which] + (ends[which] - begins[which]) * along
    centres += numbers.normal(size=(count, 3)) * (0.12 if species.ends is conifer else 0.3)
    return Shape.joined(wood), leaves(centres, math.sqrt(species.foliage / count / 0.8), numbers)
