"""The runs of chart_scaling.py: how a picture's time depends on threads, size, and how it is cut and dealt."""

import json
import time
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Iterator, Optional, Sequence

from machine import cores, run
from measured import CHARTS

PARTITIONERS = ("auto", "static", "simple", "affinity")
FEW = 0.02  # of the runs that may stay contended without spoiling the others
RETRIES = 3  # of a contended run; of all runs a quarter


@dataclass(frozen=True)
class Run:
    study: str  # threads, splits
    side: int  # pixels
    threads: int
    pinned: bool  # to as many cores as threads
    tiles: str = ""  # --tiles and --partitioner; empty: the program's choice
    partitioner: str = ""

    def options(self) -> list[str]:
        named = {"--tiles": self.tiles, "--partitioner": self.partitioner}
        chosen = [word for name, value in named.items() if value for word in (name, value)]
        return ["--size", f"{self.side}x{self.side}", "--threads", str(self.threads), *chosen]


@dataclass
class Plan:
    """What to run and how often; `seconds` of CPU time each, at least, or one sample."""

    sides: Sequence[int] = (10, 57, 105, 153, 200, 512, 1024, 2048, 4096)
    repeats: int = 9
    large: int = 2048  # from this side on
    large_repeats: int = 3
    split_sides: Sequence[int] = (57, 105, 200, 512, 1024)
    tiles: Sequence[str] = ("", "rows", "columns", "4", "8", "16", "32", "64", "128")
    split_repeats: int = 3
    seconds: float = 0.7

    def repetitions(self) -> Iterator[tuple[int, list[Run]]]:
        """What is to be compared is run by turns, so that a slow minute of the machine meets all of it."""
        for repetition in range(max(self.repeats, self.split_repeats)):
            runs: list[Run] = []
            for side in self.sides:
                if repetition < (self.repeats if side < self.large else self.large_repeats):
                    runs += [Run("threads", side, n, pinned) for n in thread_counts() for pinned in (True, False)]
            for side in self.split_sides if repetition < self.split_repeats else ():
                every = len(cores())
                splits = [Run("splits", side, every, False, t, p) for t in self.tiles for p in PARTITIONERS]
                # Backwards the next time: what heats up or slows down meets none more than another.
                runs += splits if repetition % 2 == 0 else splits[::-1]
            yield repetition, runs


QUICK = Plan(
    sides=(10, 57, 105, 200, 512),
    repeats=6,
    split_sides=(105, 512),
    tiles=("", "rows", "columns", "4", "16", "64"),
    split_repeats=2,
    seconds=0.4,
)


def thread_counts() -> list[int]:
    """1, 2, 4, ... and as many as there are cores."""
    every = len(cores())
    return sorted({2**i for i in range(every.bit_length()) if 2**i <= every} | {every})


def measure(program: Path, scene: Path, plan: Plan) -> list[dict]:
    """A row for each run. Ends after a repetition where too many stayed contended to conclude anything."""
    seconds_per_path = _render(program, scene, Run("", 256, 1, False), 8)["microseconds_per_camera_path"] / 1e6
    seconds = max(plan.seconds, 0.2 * len(cores()))  # so that a run on all cores is not too short
    rows: list[dict] = []
    retries, planned = 0, sum(len(runs) for _, runs in plan.repetitions())
    start = time.monotonic()
    for repetition, runs in plan.repetitions():
        for what in runs:
            spp = max(1, round(seconds / (seconds_per_path * what.side**2)))
            for tries in range(1, RETRIES + 2):
                row = asdict(what) | {"repetition": repetition, "tries": tries} | _measure(program, scene, what, spp)
                if not row["contended"] or tries > RETRIES or retries >= planned / 4:
                    break
                retries += 1
                time.sleep(1)  # others may be done then
            rows.append({key: int(value) if isinstance(value, bool) else value for key, value in row.items()})
            seconds_gone = time.monotonic() - start
            print(f"\r{len(rows)} of {planned} runs, {seconds_gone:.0f} s, {retries} again", end="", flush=True)
        if sum(row["contended"] for row in rows) > FEW * planned:
            break
    print()
    return rows


def _measure(program: Path, scene: Path, what: Run, spp: int) -> dict:
    stats = _render(program, scene, what, spp)
    usage = stats["usage"]
    return {
        "spp": spp,
        "seconds": stats["seconds"]["render"],
        "cpu_seconds": stats["render_cpu_seconds"],
        "others": usage.others / (what.threads * usage.wall),
        "stolen": usage.stolen / (what.threads * usage.wall),
        "load": usage.load,
        "contended": usage.is_contended(what.threads),
    }


def _render(program: Path, scene: Path, what: Run, spp: int) -> dict:
    out = CHARTS / "scaling"
    command = [str(program), "render", str(scene), *what.options(), "--spp", str(spp), "--aov", "none", "--quiet"]
    files = ["-o", str(out.with_suffix(".exr")), "--stats", str(out.with_suffix(".json"))]
    bound: Optional[set[int]] = set(cores()[: what.threads]) if what.pinned else None
    usage = run([*command, *files], bound)
    return json.loads(out.with_suffix(".json").read_text()) | {"usage": usage}
