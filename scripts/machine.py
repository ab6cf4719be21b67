"""The machine that a script measures on, and how much of it others took meanwhile."""

import os
import platform
import re
import resource
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Optional, Sequence

from measured import ROOT

# A run is contended where others took more than this share of the cores that it used, and a tick of the system's clock,
# which is what Linux counts in.
SHARE, TICKS = 0.03, 1


@dataclass
class Usage:
    """CPU seconds while a program ran."""

    wall: float  # seconds
    own: float
    others: float  # of all cores, stolen time included
    stolen: float  # by the machine's host
    load: float  # one-minute load average before

    def is_contended(self, cores: int) -> bool:
        return self.others > SHARE * cores * self.wall + TICKS / os.sysconf("SC_CLK_TCK")


def run(command: Sequence[str], cores: Optional[set[int]] = None) -> Usage:
    """Runs a program, bound to these cores where they are given."""
    allowed = os.sched_getaffinity(0)
    load = os.getloadavg()[0]
    busy, stolen = _ticks()
    own, start = _children(), time.monotonic()
    os.sched_setaffinity(0, cores or allowed)  # which the program inherits
    try:
        subprocess.run(command, check=True)
    finally:
        os.sched_setaffinity(0, allowed)
    wall, own = time.monotonic() - start, _children() - own
    busy_after, stolen_after = _ticks()
    tick = 1 / os.sysconf("SC_CLK_TCK")
    return Usage(wall, own, (busy_after - busy) * tick - own, (stolen_after - stolen) * tick, load)


def cores() -> list[int]:
    """Those that this process may use; of cores that run two threads each, the second ones last."""

    def rank(core: int) -> tuple[int, int]:
        topology = Path(f"/sys/devices/system/cpu/cpu{core}/topology/core_cpus_list")
        first = re.match(r"\d+", topology.read_text()) if topology.exists() else None
        return first is not None and int(first[0]) != core, core

    return sorted(os.sched_getaffinity(0), key=rank)


def describe() -> str:
    """Processor, memory, system, commit and date."""
    commit = ["git", "-C", str(ROOT), "describe", "--always", "--dirty"]
    words = [
        f"{len(cores())} cores ({_field('/proc/cpuinfo', 'model name')})",
        f"{int(_field('/proc/meminfo', 'MemTotal').split()[0]) / 2**20:.0f} GiB",
        f"Linux {platform.release()}",
        f"commit {subprocess.run(commit, capture_output=True, text=True).stdout.strip() or 'unknown'}",
        f"{time.strftime('%Y-%m-%d %H:%M')}, load average {os.getloadavg()[0]:.2f}",
    ]
    return ", ".join(words)


def _field(file: str, name: str) -> str:
    lines = [line.split(":", 1) for line in Path(file).read_text().splitlines() if ":" in line]
    return next((value.strip() for key, value in lines if key.strip() == name), "0 (not known)")


def _children() -> float:
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def _ticks() -> tuple[int, int]:
    """All time that the cores were not idle, and of that what the host took."""
    columns = Path("/proc/stat").read_text().split("\n", 1)[0].split()[1:]
    user, nice, system, _idle, _wait, irq, softirq, steal = (int(column) for column in columns[:8])
    return user + nice + system + irq + softirq + steal, steal
