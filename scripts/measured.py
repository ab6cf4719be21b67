"""What the chart scripts share: tables of numbers, measured now or kept from before, pictures with their errors, and
curves of error over cost."""

import csv
import hashlib
import json
import math
import struct
import subprocess
import zlib
from decimal import Decimal
from pathlib import Path
from typing import Any, Callable, Iterable, Sequence

import numpy

ROOT = Path(__file__).resolve().parent.parent
CHARTS = ROOT / "build/charts"  # what is measured, kept

# --- tables -----------------------------------------------------------------------------------------------------------


def measure(program: Path, size: int | None) -> Path:
    """Runs the program, with its size where one is given; what it prints goes to PROGRAM.csv, which is returned."""
    out = program.with_name(program.name + ".csv")
    with out.open("w") as file:
        subprocess.run([str(program)] + ([str(size)] if size else []), check=True, stdout=file)
    return out


def write(path: Path, rows: Sequence[dict[str, Any]]) -> Path:
    """Writes rows of the same keys, and returns the path."""
    with path.open("w", newline="") as file:
        table = csv.DictWriter(file, list(rows[0]))
        table.writeheader()
        table.writerows(rows)
    return path


def read(path: Path, names: set[str]) -> list[dict]:
    """The rows of a table; its columns are numbers but for those of `names`."""
    with path.open() as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        for key in row.keys() - names:
            row[key] = float(row[key])
    return rows


def percent(share: float) -> str:
    """Two digits, and no power of ten."""
    return f"{Decimal(f'{100 * share:.1e}').normalize():f}%" if share else "0"


# --- pictures ---------------------------------------------------------------------------------------------------------


def render(program: Path, scene: Path, options: Sequence[str], out: Path) -> tuple[numpy.ndarray, dict[str, Any]]:
    """The picture, [y, x, RGB], and the statistics of `parian render SCENE OPTIONS`; leaves out.exr and out.json."""
    picture, stats = out.with_suffix(".exr"), out.with_suffix(".json")
    command = [str(program), "render", str(scene), *options, "--aov", "none", "--quiet"]
    subprocess.run([*command, "-o", str(picture), "--stats", str(stats)], check=True)
    return read_exr(picture), json.loads(stats.read_text())


def references(program: Path, scene: Path, options: Sequence[str]) -> list[numpy.ndarray]:
    """Two pictures of the scene that owe each other nothing, rendered once and kept under build/charts."""
    key = hashlib.sha256(repr(options).encode())
    for file in (scene, scene.with_suffix(".bin")):
        key.update(file.read_bytes())
    pictures = []
    for seed in ("1000001", "1000002"):
        out = CHARTS / f"{scene.stem}-{key.hexdigest()[:12]}-{seed}.exr"
        if not out.exists():
            render(program, scene, [*options, "--seed", seed], out)
        pictures.append(read_exr(out))
    return pictures


def relative_mse(picture: numpy.ndarray, truth: Sequence[numpy.ndarray]) -> float:
    """The mean square error, over the square of the mean. The error is taken against each of two references and the two
    are multiplied, so that the references' own noise does not add to it; what is left of it can make a small error
    negative."""
    squares = ((picture - truth[0]) * (picture - truth[1])).mean()
    return float(squares / ((truth[0].mean() + truth[1].mean()) / 2) ** 2)


def relative_rmse(picture: numpy.ndarray, truth: Sequence[numpy.ndarray]) -> float:
    """The root mean square error, over the mean."""
    return max(relative_mse(picture, truth), 0) ** 0.5


def pixel_relative_mse(picture: numpy.ndarray, truth: Sequence[numpy.ndarray]) -> float:
    """As relative_mse(), but each square is over the square of its own pixel, plus .01: relMSE (Rousselle, Knaus and
    Zwicker 2011, Adaptive Sampling and Reconstruction using Greedy Error Minimization)."""
    squares = (picture - truth[0]) * (picture - truth[1])
    return float((squares / (((truth[0] + truth[1]) / 2) ** 2 + 0.01)).mean())


def read_exr(path: Path) -> numpy.ndarray:
    """The picture, [y, x, RGB], of an OpenEXR file as Parian writes it with --aov none: scanlines of 32-bit floats in
    blocks of 16, zip-compressed."""
    data = path.read_bytes()
    attributes, at = {}, 8
    while data[at]:
        name, kind, rest = data[at:].split(b"\0", 2)
        at += len(name) + len(kind) + 2
        size = struct.unpack_from("<i", data, at)[0]
        attributes[name.decode()] = data[at + 4 : at + 4 + size]
        at += 4 + size
    x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    if attributes["compression"] != b"\3" or attributes["channels"].count(b"\2\0\0\0") != 3:
        raise ValueError(f"{path}: expected three channels of float, zip-compressed")
    rows = []
    for offset in struct.unpack_from(f"<{(height + 15) // 16}Q", data, at + 1):
        y, size = struct.unpack_from("<2i", data, offset)
        block, count = data[offset + 8 : offset + 8 + size], min(16, height - (y - y0))
        if size < count * width * 12:
            # Each byte is a difference from the one before, plus 128; even bytes come first, then the odd ones.
            steps = numpy.frombuffer(zlib.decompress(block), numpy.uint8).astype(numpy.int64)
            steps[1:] -= 128
            halves, plain = (steps.cumsum() % 256).astype(numpy.uint8), numpy.empty(len(steps), numpy.uint8)
            plain[0::2], plain[1::2] = numpy.split(halves, [(len(steps) + 1) // 2])
            block = plain.tobytes()
        rows.append(numpy.frombuffer(block, "<f4").reshape(count, 3, width))
    # The channels are in the order of their names.
    return numpy.concatenate(rows)[:, ::-1].swapaxes(1, 2).astype(float)


# --- curves -----------------------------------------------------------------------------------------------------------


def at(xs: Sequence[float], ys: Sequence[float], x: float) -> float:
    """The value at x of the curve through the points, straight between them where both axes are logarithmic; not a
    number outside."""
    inside = min(xs) <= x <= max(xs) and min(ys) > 0
    return math.exp(numpy.interp(math.log(x), numpy.log(xs), numpy.log(ys))) if inside else math.nan


def first_below(xs: Sequence[float], ys: Sequence[float], y: float) -> float:
    """Where the same curve first falls to y: at its first point, where that is below."""
    if ys[0] <= y:
        return xs[0]
    for i in range(len(xs) - 1):
        if ys[i + 1] <= y < ys[i]:
            share = math.log(ys[i] / y) / math.log(ys[i] / ys[i + 1])
            return xs[i] * (xs[i + 1] / xs[i]) ** share
    return math.nan


def slope(xs: Sequence[float], ys: Sequence[float]) -> float:
    """Of the line fitted to the points, both axes logarithmic."""
    return float(numpy.polyfit(numpy.log(xs), numpy.log(ys), 1)[0]) if min(ys) > 0 else math.nan


def jackknife(statistic: Callable[[set[Any]], float], repeats: Iterable[Any]) -> tuple[float, float]:
    """What the statistic is of all repeats, and its standard error, by leaving out one after the other."""
    every = set(repeats)
    without = numpy.array([statistic(every - {one}) for one in sorted(every)])
    deviations = without - without.mean()
    return statistic(every), math.sqrt((len(every) - 1) / len(every) * (deviations**2).sum())
