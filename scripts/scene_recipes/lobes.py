"""What surfaces reflect, from the formulas of glTF 2.0, its extensions and the papers they cite, in plain Python: for
what the picture of a scene must show. Written apart from the renderer's code, and by other routes where there are any.

Directions are unit and in the frame of the surface, whose normal is z; wo is towards the viewer and above the surface.
A lobe gives f cos for each channel, the cosine being that of wi to the normal; an albedo is the integral of that over
wi. alpha is roughness squared."""

import cmath
import functools
import math
from typing import Callable, Optional, Sequence

from gltf_shapes import Vec, Vec3, add, cross, dot, mul, normalize, sub

Lobe = Callable[[Vec, Vec], Vec3]
Fresnel = Callable[[float], Vec3]  # of the cosine to a facet
BLACK = (0.0, 0.0, 0.0)


def mix(a: Vec, b: Vec, t: float) -> Vec3:
    return add(mul(a, 1 - t), mul(b, t))


def times(a: Vec, b: Vec) -> Vec3:
    return a[0] * b[0], a[1] * b[1], a[2] * b[2]


# --- Fresnel --------------------------------------------------------------------------------------------------------


def schlick(f0: Vec, f90: float = 1) -> Fresnel:
    return lambda cosine: mix(f0, (f90,) * 3, (1 - cosine) ** 5)


def dielectric_f0(ior: float, color: Vec = (1, 1, 1), factor: float = 1) -> Vec3:
    """KHR_materials_ior and KHR_materials_specular; an index of 0 is infinite."""
    r = ((ior - 1) / (ior + 1)) ** 2 if ior else 1.0
    return tuple(min(r * c, 1) * factor for c in color)


def conductor(eta: Vec, k: Vec) -> Fresnel:
    """Fresnel's equations in complex numbers."""

    def reflectance(index: complex, cosine: float) -> float:
        inside = cmath.sqrt(index**2 - 1 + cosine**2)  # index times the refracted cosine
        s = (cosine - inside) / (cosine + inside)
        p = (index**2 * cosine - inside) / (index**2 * cosine + inside)
        return (abs(s) ** 2 + abs(p) ** 2) / 2

    return lambda cosine: tuple(reflectance(complex(n, i), cosine) for n, i in zip(eta, k))


def iridescence(factor: float, film_ior: float, thickness: float, f0: Vec) -> Fresnel:
    """KHR_materials_iridescence, the code of its implementation notes; thickness in nanometres, above 0.03."""

    def schlick1(r0: float, cosine: float) -> float:
        return r0 + (1 - r0) * (1 - cosine) ** 5

    def sensitivity(path: float, shifts: Sequence[float]) -> Vec3:
        phase = 2 * math.pi * path * 1e-9

        def gaussian(value: float, position: float, variance: float, shift: float) -> float:
            wave = math.cos(position * phase + shift) * math.exp(-variance * phase**2)
            return value * math.sqrt(2 * math.pi * variance) * wave / 1.0685e-7

        x = gaussian(5.4856e-13, 1.6810e06, 4.3278e09, shifts[0])
        x += gaussian(9.7470e-14, 2.2399e06, 4.5282e09, shifts[0])
        y = gaussian(4.4201e-13, 1.7953e06, 9.3046e09, shifts[1])
        z = gaussian(5.2481e-13, 2.2084e06, 6.6121e09, shifts[2])
        return (
            3.2404542 * x - 1.5371385 * y - 0.4985314 * z,
            -0.9692660 * x + 1.8760108 * y + 0.0415560 * z,
            0.0556434 * x - 0.2040259 * y + 1.0572252 * z,
        )

    def film(cosine: float) -> Vec3:
        inside = math.sqrt(1 - (1 - cosine**2) / film_ior**2)
        r12 = schlick1(((film_ior - 1) / (film_ior + 1)) ** 2, cosine)
        shifts, direct, single = [], [], []
        for r in f0:
            base = (1 + math.sqrt(r)) / (1 - math.sqrt(r))
            r23 = schlick1(((base - film_ior) / (base + film_ior)) ** 2, inside)
            shifts.append(math.pi + (math.pi if base < film_ior else 0))
            rs = (1 - r12) ** 2 * r23 / (1 - r12 * r23)
            direct.append((r12 + rs, math.sqrt(r12 * r23)))
            single.append(rs - (1 - r12))
        total = [d for d, _ in direct]
        for m in (1, 2):
            wave = sensitivity(m * 2 * film_ior * thickness * inside, [m * s for s in shifts])
            for i in range(3):
                total[i] += 2 * single[i] * direct[i][1] ** m * wave[i]
        return tuple(total)

    plain = schlick(f0)
    return lambda cosine: mix(plain(cosine), film(cosine), factor)


# --- microfacets ----------------------------------------------------------------------------------------------------


def ggx(fresnel: Fresnel, alpha: float, across: Optional[float] = None, degrees: float = 0) -> Lobe:
    """F D G / (4 cos), GGX with Smith's height-correlated masking; `across` is the alpha at right angles to the
    direction that is turned by so many degrees from x."""
    ax, ay = alpha, alpha if across is None else across
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))

    def stretch(w: Vec) -> float:
        """tan^2 of w times the squared alpha in its azimuth."""
        x, y = c * w[0] + s * w[1], c * w[1] - s * w[0]
        return ((ax * x) ** 2 + (ay * y) ** 2) / w[2] ** 2

    def f_cos(wo: Vec, wi: Vec) -> Vec3:
        if wi[2] <= 0:
            return BLACK
        h = normalize(add(wo, wi))
        x, y = c * h[0] + s * h[1], c * h[1] - s * h[0]
        d = 1 / (math.pi * ax * ay * ((x / ax) ** 2 + (y / ay) ** 2 + h[2] ** 2) ** 2)
        g = 2 / (math.sqrt(1 + stretch(wo)) + math.sqrt(1 + stretch(wi)))
        return mul(fresnel(dot(wo, h)), d * g / (4 * wo[2]))

    return f_cos


def ggx_albedo(fresnel: Fresnel, alpha: float, mu: float, across: Optional[float] = None, steps: int = 64) -> Vec3:
    """Directional albedo of ggx(), seen from over the direction of alpha: the midpoint rule over facets, spread as
    D(h) cos h and denser where they are steep."""
    ax, ay = alpha, alpha if across is None else across
    wo = (math.sqrt(1 - mu * mu), 0.0, mu)
    root_o = math.sqrt(1 + (ax * wo[0] / mu) ** 2)
    total = BLACK
    for i in range(steps):
        v = 1 - (i + 0.5) / steps
        slope = math.sqrt(1 / v**3 - 1)
        for j in range(steps // 2):  # the other half is its mirror image
            phi = math.pi * (j + 0.5) / (steps // 2)
            h = normalize((ax * slope * math.cos(phi), ay * slope * math.sin(phi), 1))
            cosine = dot(wo, h)
            x, y, z = sub(mul(h, 2 * cosine), wo)
            if cosine > 0 and z > 0:
                g = 2 / (root_o + math.sqrt(1 + ((ax * x) ** 2 + (ay * y) ** 2) / z**2))
                total = add(total, mul(fresnel(cosine), 3 * v**2 * g * cosine / (mu * h[2])))
    return mul(total, 2 / steps**2)


@functools.lru_cache(maxsize=None)
def _facets(alpha: float, mu: float) -> tuple[float, float]:
    """Albedos of facets that reflect 1 and (1 - cos)^5."""
    return ggx_albedo(lambda cosine: (1.0, (1 - cosine) ** 5, 0.0), alpha, mu)[:2]


@functools.lru_cache(maxsize=None)
def _mean_facets(alpha: float, steps: int = 48) -> tuple[float, float]:
    """Their means over the hemisphere, 2 integral of E mu dmu (midpoint rule in mu^2)."""
    rows = [_facets(alpha, math.sqrt((i + 0.5) / steps)) for i in range(steps)]
    return sum(r[0] for r in rows) / steps, sum(r[1] for r in rows) / steps


class Bounces:
    """Light that meets more than one facet before it leaves, after Kulla and Conty 2017. `average` is what a facet
    reflects of light from all sides."""

    def __init__(self, alpha: float, average: Vec) -> None:
        self.alpha, self.lost = alpha, 1 - _mean_facets(alpha)[0]
        self.share = [a**2 * (1 - self.lost) / (1 - a * self.lost) for a in average]

    def __call__(self, wo: Vec, wi: Vec) -> Vec3:
        if wi[2] <= 0:
            return BLACK
        losses = (1 - _facets(self.alpha, wo[2])[0]) * (1 - _facets(self.alpha, wi[2])[0])
        return mul(self.share, losses / self.lost * wi[2] / math.pi)

    def albedo(self, mu: float) -> Vec3:
        return mul(self.share, 1 - _facets(self.alpha, mu)[0])


def schlick_average(f0: Vec, f90: float = 1) -> Vec3:
    return mix(f0, (f90,) * 3, 1 / 21)


class Facets:
    """GGX facets with their bounces; anisotropic ones bounce as if alpha were the root mean square."""

    def __init__(
        self, fresnel: Fresnel, alpha: float, across: Optional[float] = None, degrees: float = 0, steps: int = 64
    ) -> None:
        self.fresnel, self.alpha, self.across = fresnel, alpha, across
        self.single = ggx(fresnel, alpha, across, degrees)
        average = BLACK
        for i in range(steps):
            average = add(average, mul(fresnel(math.sqrt((i + 0.5) / steps)), 1 / steps))
        self.bounces = Bounces(math.sqrt((alpha**2 + (across or alpha) ** 2) / 2), average)

    def __call__(self, wo: Vec, wi: Vec) -> Vec3:
        return add(self.single(wo, wi), self.bounces(wo, wi))

    def albedo(self, mu: float) -> Vec3:
        """Seen from over the direction of alpha."""
        return add(ggx_albedo(self.fresnel, self.alpha, mu, self.across), self.bounces.albedo(mu))


class MetallicRoughness:
    """glTF's surface with its bounces. The base under a dielectric is that of Kelemen and Szirmay-Kalos 2001, by the
    channel of the largest f0."""

    def __init__(self, base: Vec, metallic: float, roughness: float, f0: Vec = (0.04,) * 3, f90: float = 1) -> None:
        self.base, self.metallic, self.alpha, self.f0, self.f90 = base, metallic, roughness**2, f0, f90
        coat, metal = Bounces(self.alpha, schlick_average(f0, f90)), Bounces(self.alpha, schlick_average(base))
        self.single = ggx(lambda c: mix(schlick(f0, f90)(c), schlick(base)(c), metallic), self.alpha)
        self.bounces = lambda wo, wi: mix(coat(wo, wi), metal(wo, wi), metallic)
        self.bounces_albedo = lambda mu: mix(coat.albedo(mu), metal.albedo(mu), metallic)
        self.coat_share = max(coat.share)

    def _coat(self, one: float, grazing: float) -> float:
        """Albedo of the coat, by those of facets that reflect 1 and (1 - cos)^5."""
        return max(self.f0) * (one - grazing) + self.f90 * grazing + self.coat_share * (1 - one)

    def __call__(self, wo: Vec, wi: Vec) -> Vec3:
        if wi[2] <= 0:
            return BLACK
        o, i = _facets(self.alpha, wo[2]), _facets(self.alpha, wi[2])
        through = (1 - self._coat(*o)) * (1 - self._coat(*i))
        if through > 0:  # a coat that reflects everything has no base
            through /= 1 - self._coat(*_mean_facets(self.alpha))
        base = mul(self.base, (1 - self.metallic) * through * wi[2] / math.pi)
        return add(base, add(self.single(wo, wi), self.bounces(wo, wi)))

    def albedo(self, mu: float) -> Vec3:
        one, grazing = _facets(self.alpha, mu)
        coat = add(mul(self.f0, one - grazing), (self.f90 * grazing,) * 3)
        metal = add(mul(self.base, one - grazing), (grazing,) * 3)
        base = mul(self.base, (1 - self.metallic) * (1 - self._coat(one, grazing)))
        return add(base, add(mix(coat, metal, self.metallic), self.bounces_albedo(mu)))


def bump_shadowing(normal: Vec, wi: Vec) -> float:
    """What other bumps leave of the light from wi to one with this normal (Estevez, Lecocq and Stein 2019), the slopes'
    standard deviation being half its own."""
    alpha2 = min(1, (1 / normal[2] ** 2 - 1) / 8)
    return 2 / (1 + math.sqrt(1 + alpha2 * (1 / wi[2] ** 2 - 1))) if wi[2] > 0 else 0.0


# --- other lobes ----------------------------------------------------------------------------------------------------


def lambert(color: Vec, through: Vec = BLACK) -> Lobe:
    """A diffuse sheet; `through` is what leaves on the other side (KHR_materials_diffuse_transmission)."""
    return lambda wo, wi: mul(color if wi[2] > 0 else through, abs(wi[2]) / math.pi)


def phong(diffuse: Vec, specular: Vec, exponent: float) -> Lobe:
    """Lafortune and Willems 1994."""

    def f_cos(wo: Vec, wi: Vec) -> Vec3:
        power = max(dot((-wo[0], -wo[1], wo[2]), wi), 0.0) ** exponent
        f = add(mul(diffuse, 1 / math.pi), mul(specular, (exponent + 2) / (2 * math.pi) * power))
        return mul(f, max(wi[2], 0.0))

    return f_cos


def phong_albedo(exponent: float, mu: float, steps: int = 128) -> float:
    """The lobe of phong() with specular 1: midpoint rule over directions spread as cos^n about the mirror direction."""
    sine = math.sqrt(1 - mu * mu)
    total = 0.0
    for i in range(steps):
        along = ((i + 0.5) / steps) ** (1 / (exponent + 1))
        for j in range(steps):
            aside = math.sqrt(1 - along**2) * math.cos(math.pi * (j + 0.5) / steps)
            total += max(along * mu + aside * sine, 0.0)
    return total / steps**2 * (exponent + 2) / (exponent + 1)


def coat_reflectance(weight: float, cosine: float) -> float:
    """KHR_materials_clearcoat: index 1.5, at the angle of the viewer."""
    return weight * (0.04 + 0.96 * (1 - abs(cosine)) ** 5)


def coated(base: Lobe, weight: float, roughness: float, normal: Vec = (0, 0, 1)) -> Lobe:
    """KHR_materials_clearcoat: facets that reflect everything, mixed over the base by coat_reflectance()."""
    x = normalize(cross((0.0, 1.0, 0.0), normal))
    y = cross(normal, x)
    facets = ggx(lambda cosine: (1.0, 1.0, 1.0), roughness**2)

    def f_cos(wo: Vec, wi: Vec) -> Vec3:
        share = coat_reflectance(weight, dot(wo, normal))
        turned = [(dot(w, x), dot(w, y), dot(w, normal)) for w in (wo, wi)]
        return add(mul(base(wo, wi), 1 - share), mul(facets(*turned), share))

    return f_cos


class Sheen:
    """KHR_materials_sheen: Charlie's distribution, and the base scaled by what the sheen's albedo leaves."""

    def __init__(self, base: Lobe, color: Vec, roughness: float) -> None:
        self.base, self.color, self.alpha = base, color, roughness**2

    def __call__(self, wo: Vec, wi: Vec) -> Vec3:
        return add(mul(self.base(wo, wi), self.scale(wo[2], abs(wi[2]))), mul(self.color, self.fibres(wo, wi)))

    def scale(self, mu_o: float, mu_i: float) -> float:
        return 1 - max(self.color) * max(charlie_albedo(self.alpha, mu_o), charlie_albedo(self.alpha, mu_i))

    def fibres(self, wo: Vec, wi: Vec) -> float:
        if wi[2] <= 0:
            return 0.0
        sine = math.sqrt(max(0.0, 1 - normalize(add(wo, wi))[2] ** 2))
        d = (2 + 1 / self.alpha) * sine ** (1 / self.alpha) / (2 * math.pi)
        return d / (4 * wo[2] * (1 + _charlie_lambda(self.alpha, wo[2]) + _charlie_lambda(self.alpha, wi[2])))

    def albedo(self, base: Vec, mu: float, steps: int = 32) -> Vec3:
        """Over a Lambert base of that colour."""
        squares = [(i + 0.5) / steps for i in range(steps)]
        passed = sum(self.scale(mu, math.sqrt(mu2)) for mu2 in squares) / steps
        return add(mul(base, passed), mul(self.color, charlie_albedo(self.alpha, mu)))


def _charlie_lambda(alpha: float, cosine: float) -> float:
    t = (1 - alpha) ** 2
    rough, smooth = (21.5473, 3.82987, 0.19823, -1.97760, -4.32054), (25.3245, 3.32435, 0.16801, -1.27393, -4.85967)
    a, b, c, d, e = (r * (1 - t) + s * t for r, s in zip(rough, smooth))

    def curve(x: float) -> float:
        return a / (1 + b * x**c) + d * x + e

    return math.exp(curve(cosine) if cosine < 0.5 else 2 * curve(0.5) - curve(1 - cosine))


@functools.lru_cache(maxsize=None)
def charlie_albedo(alpha: float, mu: float, steps: int = 64) -> float:
    """The sheen of colour 1 under a white sky: midpoint rule over the hemisphere."""
    fibres = Sheen(lambert(BLACK), (1, 1, 1), math.sqrt(alpha)).fibres
    wo = (math.sqrt(1 - mu * mu), 0.0, mu)
    total = 0.0
    for i in range(steps):
        z = ((i + 0.5) / steps) ** 2  # dense at the horizon, where the lobe is
        r = math.sqrt(1 - z * z)
        for j in range(steps):
            phi = math.pi * (j + 0.5) / steps
            total += fibres(wo, (r * math.cos(phi), r * math.sin(phi), z)) * 2 * math.sqrt(z)
    return total * 2 * math.pi / steps**2
