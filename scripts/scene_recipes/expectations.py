"""What expected.json says about a scene's image."""

from typing import Any, Optional, Sequence

Expected = dict[str, Any]
Region = tuple[float, float, float, float]  # x0, y0, x1, y1 as fractions of the image, from its top left


def expected(
    shows: str,
    size: tuple[int, int],
    spp: int,
    source: str,
    mean: Optional[Sequence[float]] = None,
    tolerance: float = 0.01,
    pixels: Sequence[Expected] = (),
) -> Expected:
    """`mean` is the linear mean radiance of the whole image (None: not checked yet), `tolerance` relative."""
    out: Expected = {"shows": shows, "size": list(size), "spp": spp}
    out["mean"] = None if mean is None else [float(m) for m in mean]
    out |= {"tolerance": tolerance, "source": source}
    if pixels:
        out["pixels"] = list(pixels)
    return out


def measured(shows: str, size: tuple[int, int] = (480, 320)) -> Expected:
    """For a scene without a closed form: its mean is filled in by hand, from a converged render."""
    return expected(shows, size, 256, "converged render")


def region(area: Region, value: Sequence[float], tolerance: float, source: str) -> Expected:
    """The mean radiance of a part of the image."""
    return {"region": list(area), "value": [float(v) for v in value], "tolerance": tolerance, "source": source}
