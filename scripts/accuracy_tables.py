"""The tables of chart_accuracy.py: what its choices are worth, from rows of a picture each."""

import math
import statistics
from dataclasses import dataclass
from typing import Callable, Sequence

from accuracy_groups import Group
from measured import at, first_below, jackknife, percent, slope

MEASURES = {"mse": "RMS", "pixel_mse": "pixels"}  # of the square errors, and their roots


@dataclass(frozen=True)
class Curve:
    """Over seeds, from few samples to many: medians of the CPU time, which others on the machine disturb, and roots of
    the mean square errors."""

    samples: list[float]
    cpu_seconds: list[float]
    errors: list[float]


def curve(rows: list[dict], choice: str, measure: str, seeds: set[float]) -> Curve:
    points: dict[float, list[dict]] = {}
    for row in rows:
        if row["choice"] == choice and row["seed"] in seeds:
            points.setdefault(row["step"], []).append(row)
    result = []
    for same in points.values():
        square = statistics.mean(row[measure] for row in same)
        samples = statistics.mean(row["samples"] for row in same)
        seconds = statistics.median(row["cpu_seconds"] for row in same)
        result.append((samples, seconds, math.sqrt(max(square, 1e-12))))
    return Curve(*map(list, zip(*sorted(result))))


def error_factor(one: Curve, other: Curve) -> float:
    """The error of the one over that of the other, after the longest CPU time that both were given."""
    seconds = min(one.cpu_seconds[-1], other.cpu_seconds[-1])
    return at(one.cpu_seconds, one.errors, seconds) / at(other.cpu_seconds, other.errors, seconds)


def cost_factor(one: Curve, other: Curve, cost: str) -> float:
    """What the one costs over what the other costs, to the least error that both reach."""
    error = common_error(one, other)
    return first_below(getattr(one, cost), one.errors, error) / first_below(getattr(other, cost), other.errors, error)


def common_error(one: Curve, other: Curve) -> float:
    return max(min(one.errors), min(other.errors))


def converged_slope(points: Curve) -> float:
    """Of the error over samples, from 4 on."""
    late = [i for i, samples in enumerate(points.samples) if samples >= 4]
    return slope([points.samples[i] for i in late], [points.errors[i] for i in late])


def number(value: float, error: float) -> str:
    """With the digits that the standard error leaves: one of its own, two where it begins with a 1."""
    if not (math.isfinite(value) and math.isfinite(error)):
        return "-"
    digits = max(0, -math.floor(math.log10(max(error, 1e-3) / 1.95)))
    return f"{value:.{digits}f} +- {error:.{digits}f}"


def print_table(title: str, columns: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
    print(f"\n{title}\n\n| scene | " + " | ".join(columns) + " |\n" + "|---" * (1 + len(columns)) + "|")
    for row in rows:
        print("| " + " | ".join(row) + " |")


def print_group(name: str, group: Group, by_scene: dict[str, list[dict]]) -> None:
    """The default against each other choice, then what all are by themselves."""
    print(f"\n## {name}")
    default, *others = group.colors
    heads = [f"{choice}: {label}" for choice in others for label in MEASURES.values()]
    cells = [[scene, *compared(rows, group, error_factor)] for scene, rows in by_scene.items()]
    print_table(f"Error at equal CPU time, over that of {default}:", heads, cells)
    costs = lambda one, other: cost_factor(one, other, group.fewer)  # noqa: E731
    cells = [[scene, *compared(rows, group, costs, True)] for scene, rows in by_scene.items()]
    print_table(f"{group.fewer} to equal error, over those of {default}:", heads, cells)
    cells = [[scene, *(last(rows, choice) for choice in group.colors)] for scene, rows in by_scene.items()]
    print_table("Most samples, CPU s: errors, RMS and of pixels:", list(group.colors), cells)
    heads = [f"{choice}: {label}" for choice in group.colors for label in MEASURES.values()]
    cells = [[scene, *slopes(rows, group)] for scene, rows in by_scene.items()]
    print_table("Slope of the error over samples:", heads, cells)
    if group.biased:
        cells = [[scene, *(bias(rows, choice) for choice in group.colors)] for scene, rows in by_scene.items()]
        print_table("The picture's mean over that of the references, less 1:", list(group.colors), cells)


def compared(rows: list[dict], group: Group, factor: Callable, bounded: bool = False) -> list[str]:
    """Factors of the choices over the default, by both measures. Where they are `bounded`, a curve that is below the
    error from its first point on might have cost less."""
    default, *others = group.colors
    return [pair(rows, choice, default, key, factor, bounded) for choice in others for key in MEASURES]


def pair(rows: list[dict], one: str, other: str, measure: str, factor: Callable, bounded: bool) -> str:
    curves = lambda seeds: [curve(rows, choice, measure, seeds) for choice in (one, other)]  # noqa: E731
    value, error = jackknife(lambda seeds: factor(*curves(seeds)), seeds_of(rows))
    both = curves(seeds_of(rows))
    below = [points.errors[0] <= common_error(*both) for points in both]
    if not (bounded and any(below)):
        return number(value, error)
    return "-" if all(below) else f"{'<' if below[0] else '>'} {value:.3g}"


def last(rows: list[dict], choice: str) -> str:
    curves = [curve(rows, choice, key, seeds_of(rows)) for key in MEASURES]
    errors = ", ".join(percent(points.errors[-1]) for points in curves)
    return f"{curves[0].samples[-1]:.0f}, {curves[0].cpu_seconds[-1]:.2g} s: {errors}"


def slopes(rows: list[dict], group: Group) -> list[str]:
    """Of all choices by both measures."""
    fit = lambda choice, key: lambda seeds: converged_slope(curve(rows, choice, key, seeds))  # noqa: E731
    return [number(*jackknife(fit(choice, key), seeds_of(rows))) for choice in group.colors for key in MEASURES]


def seeds_of(rows: list[dict]) -> set[float]:
    return {row["seed"] for row in rows}


def bias(rows: list[dict], choice: str) -> str:
    """Of the pictures with most samples."""
    mine = [row for row in rows if row["choice"] == choice]
    values = [row["bias"] for row in mine if row["step"] == max(row["step"] for row in mine)]
    mean = sum(values) / len(values)
    spread = math.sqrt(sum((value - mean) ** 2 for value in values) / (len(values) - 1) / len(values))
    return f"{number(100 * mean, 100 * spread)}%"
