"""What bodies that scatter light give back: the dipole in closed form, and the half-space by Chandrasekhar's functions.

A body is smooth and of index eta above 1; lengths are in reduced mean free paths, 1 / (sigma_a + sigma_s'). `albedo` is
the reduced one, sigma_s' / (sigma_a + sigma_s').
"""

import functools
import math
from dataclasses import dataclass
from typing import Any, Callable, Sequence

from scene_recipes.glass import fresnel

Integrand = Callable[[float], float]


@functools.lru_cache(maxsize=None)
def _legendre(count: int) -> list[tuple[float, float]]:
    """Nodes and weights of Gauss and Legendre on [0, 1]."""
    out = []
    for i in range(count):
        x = math.cos(math.pi * (i + 0.75) / (count + 0.5))
        slope = step = 1.0
        while abs(step) > 1e-15:
            before, here = 1.0, x
            for k in range(2, count + 1):
                before, here = here, ((2 * k - 1) * x * here - (k - 1) * before) / k
            slope = count * (x * here - before) / (x * x - 1)
            step = here / slope
            x -= step
        out.append(((1 - x) / 2, 1 / ((1 - x * x) * slope**2)))
    return out


def integral(f: Integrand, low: float = 0, high: float = 1, nodes: int = 48) -> float:
    return (high - low) * sum(weight * f(low + (high - low) * x) for x, weight in _legendre(nodes))


# --- the interface --------------------------------------------------------------------------------------------------


def mirrored(eta: float) -> float:
    """F at normal incidence."""
    return fresnel(1, eta, 0)


@functools.lru_cache(maxsize=None)
def mirrored_from_all_sides(eta: float) -> float:
    """2 integral of F mu dmu, from outside; mu = u^2."""
    return integral(lambda u: 4 * u**3 * fresnel(1, eta, math.sqrt(1 - u**4)))


def kept_inside(eta: float) -> float:
    """The same from inside: by reciprocity, 1 / eta^2 of what gets in from all sides gets out."""
    return 1 - (1 - mirrored_from_all_sides(eta)) / eta**2


def _from_inside(mu: float, eta: float) -> float:
    """F of a cosine inside."""
    sine = eta * math.sqrt(1 - mu * mu)  # outside
    return fresnel(1, eta, sine) if sine < 1 else 1


def seen(eta: float, share: float) -> float:
    """Along the normal under a white sky, where `share` of what enters is given back."""
    return mirrored(eta) + (1 - mirrored(eta)) * share


# --- the dipole -----------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Dipole:
    """Jensen, Marschner, Levoy, Hanrahan 2001, A Practical Model for Subsurface Light Transport: R_d(r) is the sum of
    albedo / (4 pi) z (s + 1 / d) exp(-s d) / d^2 over a source at depth z = 1 and its image at z = 1 + 4 A / 3, d being
    the distance to each and A = (1 + F_dr) / (1 - F_dr)."""

    albedo: float
    eta: float

    @property
    def s(self) -> float:
        return math.sqrt(3 * (1 - self.albedo))

    @property
    def depths(self) -> tuple[float, float]:
        kept = kept_inside(self.eta)
        return 1, 1 + 4 / 3 * (1 + kept) / (1 - kept)

    @property
    def total(self) -> float:
        """The integral of R_d over the plane."""
        return self.albedo / 2 * sum(math.exp(-self.s * z) for z in self.depths)

    def beyond(self, radius: float) -> float:
        """The share of it farther than `radius`."""
        paths = [(z, math.hypot(radius, z)) for z in self.depths]
        return sum(z * math.exp(-self.s * d) / d for z, d in paths) / sum(math.exp(-self.s * z) for z in self.depths)

    def across(self, distance: float) -> float:
        """The share beyond a line at this distance: the mean over directions of what is beyond where it is met."""
        if distance < 0:
            return 1 - self.across(-distance)
        return integral(lambda t: self.beyond(distance / math.cos(math.pi / 2 * t))) / 2

    def ball(self, radius: float) -> float:
        """Under an even sky: of a sphere, the area within a chord r is pi r^2, as of a plane."""
        return self.total * (1 - self.beyond(2 * radius))

    def slab(self, thickness: float) -> float:
        """Lit evenly from both sides."""
        return self.total * (1 + self.beyond(thickness))

    def edge(self, distance: float) -> float:
        """Under an even sky, at this distance from a right-angled edge: half of the plane beyond it gives light too."""
        return self.total * (1 - self.across(distance) + self.beyond(distance) / 2)

    def lit(self, distance: float) -> float:
        """f of a beam along the normal where it lights what is on one side of a line; > 0 on that side. As share / (pi
        c), c = 1 - 2 integral of F mu dmu (Pharr, Jakob, Humphreys, Physically Based Rendering, 11.4)."""
        within = (1 - mirrored(self.eta)) ** 2 / (math.pi * (1 - mirrored_from_all_sides(self.eta)))
        return within * self.total * self.across(-distance)


# --- materials ------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Medium:
    """What PARIAN_materials_subsurface says of a body; per millimetre, by channel."""

    absorption: Sequence[float]
    scattering: Sequence[float]  # reduced
    eta: float = 1.3

    def extinction(self, channel: int) -> float:
        return self.absorption[channel] + self.scattering[channel]

    def albedo(self, channel: int) -> float:
        return self.scattering[channel] / self.extinction(channel)

    def dipole(self, channel: int) -> Dipole:
        return Dipole(self.albedo(channel), self.eta)

    def extension(self, scale: float = 1) -> dict[str, Any]:
        """The same body, said to be a model that is so many times as large as the thing."""
        rates = {"sigmaA": self.absorption, "sigmaSPrime": self.scattering}
        out: dict[str, Any] = {key: [rate * scale for rate in of] for key, of in rates.items()}
        return out | {"eta": self.eta} | ({} if scale == 1 else {"scale": scale})


def medium(albedos: Sequence[float], paths: Sequence[float], eta: float = 1.3) -> Medium:
    """By reduced albedos and reduced mean free paths in metres."""
    rates = [0.001 / path for path in paths]
    return Medium([r * (1 - a) for a, r in zip(albedos, rates)], [r * a for a, r in zip(albedos, rates)], eta)


# Those that Jensen, Marschner, Levoy, Hanrahan 2001 measured.
MEASURED = {
    "apple": Medium((0.0030, 0.0034, 0.046), (2.29, 2.39, 1.97)),
    "cream": Medium((0.0002, 0.0028, 0.0163), (7.38, 5.47, 3.15)),
    "ketchup": Medium((0.061, 0.97, 1.45), (0.18, 0.07, 0.03)),
    "marble": Medium((0.0021, 0.0041, 0.0071), (2.19, 2.62, 3.00), 1.5),
    "skin1": Medium((0.032, 0.17, 0.48), (0.74, 0.88, 1.01)),
    "skin2": Medium((0.013, 0.070, 0.145), (1.09, 1.59, 1.79)),
    "spectralon": Medium((0, 0, 0), (11.6, 20.4, 14.9)),
    "wholemilk": Medium((0.0011, 0.0024, 0.014), (2.55, 3.21, 3.77)),
}


# --- the half-space -------------------------------------------------------------------------------------------------


def _angles(eta: float, count: int = 32) -> list[tuple[float, float]]:
    """Nodes and weights for cosines in [0, 1]: apart below and above that of total reflection, where F has a root."""
    critical = math.sqrt(1 - 1 / eta**2)
    low = [(critical * x, critical * w) for x, w in _legendre(count)] if critical > 0 else []
    return low + [(critical + (1 - critical) * x * x, 2 * (1 - critical) * x * w) for x, w in _legendre(count)]


def _chandrasekhar(albedo: float, angles: Sequence[tuple[float, float]]) -> Integrand:
    """H of isotropic scattering (Chandrasekhar, Radiative Transfer, 1950, chapter V): 1 / H(mu) = sqrt(1 - albedo) +
    albedo / 2 integral of m H(m) / (mu + m) dm."""
    values = [1.0] * len(angles)

    def h(mu: float) -> float:
        total = sum(w * m * value / (mu + m) for (m, w), value in zip(angles, values))
        return 1 / (math.sqrt(1 - albedo) + albedo / 2 * total)

    change = 1.0
    while change > 1e-13:
        # Half of the way, since a whole one would overshoot and come back.
        after = [(h(m) + value) / 2 for (m, _), value in zip(angles, values)]
        change = max(abs(a - b) for a, b in zip(after, values))
        values[:] = after
    return h


@functools.lru_cache(maxsize=None)
def given_back(albedo: float, eta: float) -> float:
    """By a walk: the share that a half-space gives back of what entered along its normal. It reflects from m to mu as
    albedo H(mu) H(m) / (4 (mu + m)), and the interface sends what it reflects in again, at the same angle."""
    angles = _angles(eta)
    h = _chandrasekhar(albedo, angles)
    at = [h(mu) for mu, _ in angles]
    inwards = [_from_inside(mu, eta) for mu, _ in angles]
    first = [albedo / (4 * math.pi) * h(1) * value / (mu + 1) for (mu, _), value in zip(angles, at)]
    rising = first
    change = 1.0
    while change > 1e-12:
        sent = [w * m * f * up * value for (m, w), f, up, value in zip(angles, inwards, rising, at)]
        after = [
            before + albedo / 2 * value * sum(s / (mu + m) for s, (m, _) in zip(sent, angles))
            for before, value, (mu, _) in zip(first, at, angles)
        ]
        change = max(abs(a - b) for a, b in zip(after, rising))
        rising = after
    return 2 * math.pi * sum(w * mu * (1 - f) * up for (mu, w), f, up in zip(angles, inwards, rising))


def given_back_of_diffuse(albedo: float) -> float:
    """The same without an interface, of light that enters evenly from all sides: 1 - 2 sqrt(1 - albedo) times the
    integral of H mu dmu."""
    angles = _angles(1)
    h = _chandrasekhar(albedo, angles)
    return 1 - 2 * math.sqrt(1 - albedo) * sum(w * mu * h(mu) for mu, w in angles)
