"""What the runs of chart_scaling.py say: efficiencies, Amdahl's serial fraction, exponents, costs of cuts."""

import math
from dataclasses import dataclass
from typing import Callable, Iterable, Optional, Sequence

import numpy

CLAIM = 0.95  # efficiency
SMALL = 105  # the least side of a picture that what is said of all pictures is meant for


@dataclass
class Estimate:
    mean: float
    error: float  # standard error; not a number of one value


@dataclass
class Efficiency:
    """One thread's wall time over N times that of N is `wall`. It is `work` times `busy` over one thread's `busy`."""

    wall: Estimate
    busy: Estimate  # CPU over N times wall seconds: the rest is waiting
    work: Estimate  # CPU seconds of one thread over those of N: the rest is what sharing memory costs, and spinning
    cpu_per_path: Estimate  # seconds


def median(values: Iterable[float]) -> Estimate:
    """The median, which single slow runs do not move, with its standard error if the values are normal."""
    array = numpy.array(list(values))
    if len(array) == 0:
        return Estimate(math.nan, math.nan)
    spread = array.std(ddof=1) if len(array) > 1 else math.nan
    return Estimate(float(numpy.median(array)), float(1.253 * spread / len(array) ** 0.5))


def sides(rows: list[dict], study: str) -> list[float]:
    return sorted({row["side"] for row in rows if row["study"] == study})


def threads_of(rows: list[dict]) -> list[float]:
    return sorted({row["threads"] for row in rows if row["study"] == "threads"})


def runs(rows: list[dict], side: float, threads: float, pinned: int) -> dict[float, dict]:
    """By repetition."""
    wanted = ("threads", side, threads, pinned)
    return {
        row["repetition"]: row
        for row in rows
        if (row["study"], row["side"], row["threads"], row["pinned"]) == wanted
    }


def pairs(rows: list[dict], side: float, threads: float, pinned: int) -> list[tuple[dict, dict]]:
    """Runs of one thread and of so many in the same repetition."""
    one, many = runs(rows, side, 1, pinned), runs(rows, side, threads, pinned)
    return [(one[i], many[i]) for i in one.keys() & many.keys()]


def efficiencies(rows: list[dict], side: float, threads: float, pinned: int) -> Efficiency:
    both = pairs(rows, side, threads, pinned)

    def over(value: Callable[[dict, dict], float]) -> Estimate:
        return median(value(one, many) for one, many in both)

    return Efficiency(
        over(lambda one, many: one["seconds"] / (threads * many["seconds"])),
        over(lambda one, many: many["cpu_seconds"] / (threads * many["seconds"])),
        over(lambda one, many: one["cpu_seconds"] / many["cpu_seconds"]),
        over(lambda one, many: many["cpu_seconds"] / (side**2 * many["spp"])),
    )


def speeds(rows: list[dict]) -> float:
    """The relative standard deviation of the CPU time of runs that are alike: of the machine's own pace."""
    alike: dict[tuple, list[float]] = {}
    for row in rows:
        key = tuple(row[name] for name in ("study", "side", "threads", "pinned", "tiles", "partitioner"))
        alike.setdefault(key, []).append(row["cpu_seconds"])
    spreads = [numpy.std(values, ddof=1) / numpy.mean(values) for values in alike.values() if len(values) > 1]
    return float(numpy.mean(numpy.square(spreads)) ** 0.5) if spreads else math.nan


def amdahl(rows: list[dict], pinned: int, least_side: float = SMALL) -> Optional[Estimate]:
    """The serial fraction s of t(N) / t(1) = s + (1 - s) / N: least squares over N in each repetition at each side."""
    found = []
    many = [threads for threads in threads_of(rows) if threads > 1]
    for side in sides(rows, "threads"):
        by_repetition: dict[float, list[tuple[float, float]]] = {}
        for threads in many if side >= least_side else ():
            for one, all_ in pairs(rows, side, threads, pinned):
                point = (1 - 1 / threads, all_["seconds"] / one["seconds"] - 1 / threads)
                by_repetition.setdefault(one["repetition"], []).append(point)
        found += [sum(x * y for x, y in p) / sum(x * x for x, _ in p) for p in by_repetition.values()]
    return median(found) if found else None


def per_sample(rows: list[dict], side: float, threads: float) -> Estimate:
    """Seconds for one sample of each pixel, bound to as many cores."""
    return median(row["seconds"] / row["spp"] for row in runs(rows, side, threads, 1).values())


def exponent(rows: list[dict], threads: float, least_side: float = 0) -> Estimate:
    """Of the side, in the time for one sample of each pixel: by least squares of the logarithms."""
    kept = [side for side in sides(rows, "threads") if side >= least_side]
    x = numpy.log(kept)
    y = numpy.log([per_sample(rows, side, threads).mean for side in kept])
    centred = x - x.mean()
    slope = (centred @ y) / (centred @ centred)
    rest = y - y.mean() - slope * centred
    return Estimate(float(slope), float((rest @ rest / (len(x) - 2) / (centred @ centred)) ** 0.5))


Split = tuple[str, ...]  # tiles, partitioner, or one of them


def split_costs(
    rows: list[dict], side: Optional[float] = None, by: Sequence[str] = ("tiles", "partitioner")
) -> dict[Split, Estimate]:
    """How much more time each takes than the fastest of them, of all sides or of one. Each time is over the geometric
    mean of those of its side and repetition, so that a slow minute counts for all of them."""
    groups: dict[tuple, list[dict]] = {}
    for row in rows:
        if row["study"] == "splits" and side in (None, row["side"]):
            groups.setdefault((row["side"], row["repetition"]), []).append(row)
    relative: dict[Split, list[float]] = {}
    for group in groups.values():
        middle = numpy.mean([math.log(row["seconds"]) for row in group])
        for row in group:
            relative.setdefault(tuple(row[name] for name in by), []).append(math.log(row["seconds"]) - middle)
    medians = {split: median(values) for split, values in relative.items()}
    least = min(estimate.mean for estimate in medians.values())
    return {split: Estimate(math.expm1(e.mean - least), e.error) for split, e in medians.items()}


def count_equal(costs: dict[Split, Estimate]) -> int:
    """How many are within two standard errors of the fastest."""
    best = min(costs.values(), key=lambda cost: cost.mean)
    return sum(cost.mean <= 2 * math.hypot(cost.error, best.error) for cost in costs.values())
