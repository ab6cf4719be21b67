"""Instructions of a render by function, counted by valgrind's callgrind, and the source file that each belongs to."""

import json
import re
import subprocess
import tempfile
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import Sequence

SIZE, SAMPLES = 32, 64  # pixels a side, samples for each
RENDER = "_ZN6parian7Session6renderEv"  # Session::render(), all of rendering and nothing else


@dataclass
class Cost:
    """Of a camera path."""

    instructions: dict[str, float]  # by function, as `library:function`
    rays: float

    def total(self) -> float:
        return sum(self.instructions.values())


def count_per_path(program: Path, scene: Path, options: Sequence[str] = ()) -> Cost:
    """What a render costs, without loading, building and writing."""
    with tempfile.TemporaryDirectory() as folder:
        counts, stats = Path(folder) / "callgrind.out", Path(folder) / "stats.json"
        tool = ["valgrind", "--quiet", "--tool=callgrind", "--demangle=no", f"--callgrind-out-file={counts}"]
        render = [str(program), "render", str(scene), "-o", f"{folder}/out.exr", "--size", f"{SIZE}x{SIZE}"]
        render += ["--spp", str(SAMPLES), "--threads", "1", "--quiet", "--stats", str(stats), *options]
        done = subprocess.run([*tool, f"--toggle-collect={RENDER}", *render], capture_output=True, text=True)
        if done.returncode:
            raise SystemExit(f"{scene}: {done.stderr.strip()}")
        rays = json.loads(stats.read_text())["rays"]
        paths = rays["camera"]
        return Cost({name: count / paths for name, count in read(counts).items()}, sum(rays.values()) / paths)


def read(path: Path) -> Counter:
    """What each function took itself, without what it called, from a file that callgrind wrote for one event."""
    names: dict[str, dict[str, str]] = {"ob": {}, "fn": {}}
    counts: Counter = Counter()
    library = function = ""
    called = False  # the next line is what a callee took
    for line in path.read_text(errors="replace").splitlines():
        if declared := re.match(r"(ob|fn)=\((\d+)\)(?: (.*))?$", line):
            kind, number, name = declared.groups()
            if name:
                names[kind][number] = Path(name).name if kind == "ob" else name
            if kind == "ob":
                library = names[kind][number]
            else:
                function = names[kind][number]
        elif declared := re.match(r"c(ob|fn)=\((\d+)\) (.*)$", line):
            kind, number, name = declared.groups()
            names[kind][number] = Path(name).name if kind == "ob" else name
        elif line.startswith("calls="):
            called = True
        elif re.match(r"[\d+*-]", line):
            if not called:
                # A function that calls itself has a name for each depth.
                counts[f"{library}:{re.sub(chr(39) + r'[0-9]+$', '', function)}"] += int(line.split()[1])
            called = False
    return counts


def sources(folder: Path) -> dict[str, str]:
    """The source file of each function of Parian, by its linker name, from the static libraries in a build folder. Code
    of headers that was not put in place belongs to the first file that has it."""
    found: dict[str, str] = {}
    for library in sorted(folder.glob("libparian_*.a")):
        layer = library.stem.removeprefix("libparian_")
        listing = subprocess.run(
            ["nm", "-A", "--defined-only", str(library)], check=True, capture_output=True, text=True
        ).stdout
        for line in listing.splitlines():
            symbol = re.match(r"[^:]*:([^:]*)\.o:[0-9a-f]+ ([TtW]) (\S+)$", line)
            if symbol:
                file, kind, name = symbol.groups()
                if kind == "T" or name not in found:
                    found[name] = f"{layer}/{file}"
    return found


def by_source(counts: dict[str, float], program: Path) -> dict[str, float]:
    """The same by source file of Parian, or by library, those that took nothing included; most first."""
    files = sources(program.parent)
    sums = dict.fromkeys(files.values(), 0.0)
    for name, count in counts.items():
        library, function = name.split(":", 1)
        # Sobol points and the like are compiled for several processors: clones of one function.
        owner = files.get(function) or files.get(function.split(".")[0]) if library == program.name else None
        owner = owner or ("apps, start" if library == program.name else re.sub(r"\.so.*", "", library))
        sums[owner] = sums.get(owner, 0.0) + count
    return dict(sorted(sums.items(), key=lambda item: -item[1]))
