"""What chart_accuracy.py measures: groups of choices that are compared, the scenes of each, how they are rendered."""

import math
from dataclasses import dataclass
from typing import NamedTuple

import chart_subsurface

SEEDS = range(4)
BLUE, RED, ORANGE, GREEN, PURPLE, BLACK = "#1f6fb2", "#c0392b", "#d98c00", "#2e8b57", "#8e5bb5", "#111111"


@dataclass(frozen=True)
class Study:
    """A scene as it is rendered: the picture's size, the most samples, the least --noise (which takes about as many),
    the samples of the references, their options, and those of all its pictures."""

    size: str
    most: int
    noise: float
    reference: int
    truth: tuple[str, ...] = ()
    common: tuple[str, ...] = ()


@dataclass(frozen=True)
class Group:
    """The choices of one option; `colors` are theirs, the first is the default, which the others are compared with."""

    colors: dict[str, str]
    scenes: tuple[str, ...]
    fewer: str = "cpu_seconds"  # what is counted to equal error
    biased: bool = False


STUDIES = {
    "cornell-box": Study("64x64", 256, 0.1, 8192),
    "veach-mis": Study("96x64", 256, 0.1, 4096),
    "environment-sun": Study("96x64", 256, 0.14, 8192),
    "glass-still-life": Study("96x64", 256, 0.14, 4096),
    "many-lights": Study("64x64", 256, 0.07, 4096, ("--strategy", "light")),
    "lights": Study("96x64", 256, 0.2, 4096),
    "depth-of-field": Study("96x64", 256, 0.2, 4096),
    "materials": Study("96x64", 256, 0.14, 4096),
    "subsurface-bust": Study("96x54", 64, 0.28, 1024),
    # Lights alone find the light of these best.
    "light-rectangle": Study("96x48", 1024, 0.035, 16384, ("--strategy", "light")),
    "light-disk": Study("64x64", 1024, 0.035, 16384, ("--strategy", "light")),
    "environment-gradient": Study("64x64", 1024, 0.02, 16384, ("--strategy", "light")),
}
# Of the group sss, against the walk.
WALKED = {
    name: Study(size, 256, math.nan, most, ("--sss", "random-walk"), ("--max-depth", "1000"))
    for name, (size, most, _) in chart_subsurface.SCENES.items()
}
SMOOTH = ("light-rectangle", "light-disk", "environment-gradient")
MIXED = ("glass-still-life", "depth-of-field", "materials")
GROUPS = {
    "strategy": Group({"mis": BLUE, "light": ORANGE, "bsdf": RED}, tuple(STUDIES)),
    "sampler": Group(
        {"sobol": BLUE, "independent": RED},
        (*SMOOTH, "cornell-box", "veach-mis", "environment-sun", "glass-still-life", "depth-of-field"),
        fewer="samples",
    ),
    "light-choice": Group({"tree": BLUE, "power": ORANGE, "uniform": RED}, ("many-lights", "lights", "veach-mis")),
    "sss": Group(
        {"auto": BLUE, "random-walk": BLACK, "photon-beam": GREEN, "dipole": RED, "burley": PURPLE},
        tuple(WALKED),
        biased=True,
    ),
    "clamp": Group(
        {"none": BLUE, "100": GREEN, "10": ORANGE, "1": RED},
        ("environment-sun", "glass-still-life", "subsurface-bust", "cornell-box"),
        biased=True,
    ),
    "noise": Group({"even": BLUE, "adaptive": RED}, (*MIXED, *(name for name in STUDIES if name not in MIXED))),
}


def study(group: str, scene: str) -> Study:
    return WALKED[scene] if group == "sss" else STUDIES[scene]


def steps(group: str, choice: str, how: Study) -> list[tuple[str, list[str]]]:
    """What is rendered for a choice, from quick to slow: a label, and its options."""
    if choice == "adaptive":
        targets = [f"{how.noise * 2 ** (i / 2):.3g}" for i in (3, 2, 1, 0)]
        return [(target, ["--noise", target, "--spp", str(2 * how.most)]) for target in targets]
    samples = [2**i for i in range(0, how.most.bit_length(), 2)]
    chosen = [] if choice in ("none", "even") else [f"--{group}", choice]
    return [(str(spp), ["--spp", str(spp), *chosen]) for spp in samples]


class Point(NamedTuple):
    """What is measured once. `step` is the number of samples or the target of --noise."""

    scene: str
    choice: str
    step: float
    seed: int


def plan(group: str, scene: str) -> list[tuple[Point, list[str]]]:
    """Each point with its options. Choices take turns, so that a slow minute of the machine meets all of them."""
    turns = [
        (i, seed, Point(scene, choice, float(label), seed), chosen)
        for choice in GROUPS[group].colors
        for i, (label, chosen) in enumerate(steps(group, choice, study(group, scene)))
        for seed in SEEDS
    ]
    return [(point, chosen) for _, _, point, chosen in sorted(turns, key=lambda turn: turn[:2])]
