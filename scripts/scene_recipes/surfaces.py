"""Materials that reflect, as charts of flat patches whose radiance is known; and coarse balls beside an exact one."""

import math
from dataclasses import dataclass
from typing import Any, Callable, Sequence

from gltf_builder import Gltf
from gltf_shapes import Vec, Vec3, add, cross, dot, mul, normalize, quad, sphere
from image_files import png
from scene_recipes import lobes
from scene_recipes.expectations import Expected, Region, expected, region
from scene_recipes.lobes import BLACK, Lobe, times
from scene_recipes.shapes import APART, FILTER, ball, draw, linear, white_sky

CELL = 24  # pixels of a chart's cell, 1 m
HALF = 0.44  # metres: of a patch as it is seen
Color = Sequence[float]


def towards(degrees: float, azimuth: float) -> Vec3:
    """The direction that is so far from z, over the azimuth from x."""
    t, a = math.radians(degrees), math.radians(azimuth)
    return math.sin(t) * math.cos(a), math.sin(t) * math.sin(a), math.cos(t)


# One sun alone, so that no choice among lights makes noise; so low that grazing reflectance counts.
PEAK = towards(57, 15)  # the normal of a patch that mirrors it to the camera
SUN, SUN_COLOR, SUN_IRRADIANCE = towards(2 * 57, 15), (1, 0.7, 0.5), 3.0
STRAIGHT = (0.0, 0.0, 1.0)


@dataclass
class Surface:
    """A material of the document and what is known of it: its lobe under the sun, its albedo under a white sky."""

    material: int
    lobe: Lobe = lambda wo, wi: BLACK
    albedo: Callable[[float], Color] = lambda mu: BLACK  # of the cosine to the viewer


class Chart:
    """Patches in a grid before a parallel camera that looks along -z. Each leans on its own, as a parallelogram that is
    seen as a square, and stands 50 m behind the one before, so that they do not light one another (less than 1e-4)."""

    def __init__(self, columns: int, rows: int, sun: bool = True, sky: bool = False) -> None:
        self.columns, self.rows, self.sun, self.sky = columns, rows, float(sun), float(sky)
        self.scene = Gltf()
        self.pixels: list[Expected] = []
        self.missing = [0.0, 0.0, 0.0]  # to the sky, in cells
        self.count = 0
        if sun:
            self.scene.add_punctual_light("directional", "sun", SUN_COLOR, SUN_IRRADIANCE, SUN, (0, 0, 0))
        if sky:
            white_sky(self.scene)
        zfar = columns * rows * APART + 100
        self.scene.add_orthographic_camera((0, 0, 0), (0, 0, 0, 1), columns / 2, rows / 2, zfar=zfar)

    def add(self, name: str, normal: Vec, *parts: Surface, tolerance: float = 0.001, source: str = "f cos E") -> None:
        """The next cell: a patch of one surface, or of what one texture makes two (left, right) or four (and below).
        Its tangent is seen towards the right, seen from the back towards the left."""
        column, row = self.count % self.columns, self.count // self.columns
        assert row < self.rows
        self.count += 1
        at = (column + 0.5 - self.columns / 2, self.rows / 2 - row - 0.5, -APART * self.count)
        facing = math.copysign(1, normal[2])
        u = mul((1, 0, -normal[0] / normal[2]), facing)
        v = (0, 1, -normal[1] / normal[2])
        patch = quad((0, 0, 0), mul(u, HALF), mul(v, HALF))
        self.scene.add_object(name, patch, parts[0].material, translation=at)
        tangent = normalize(u)
        frame = (tangent, cross(normal, tangent), normal)
        across, down = (1, 1) if len(parts) == 1 else (2, len(parts) // 2)
        share = 4 * HALF**2 / len(parts)
        for i, part in enumerate(parts):
            value = self.radiance(part, frame)
            where = f", part {i + 1}" if len(parts) > 1 else ""
            x = column + 0.5 + facing * HALF * ((2 * (i % across) + 1) / across - 1)
            y = row + 0.5 + HALF * ((2 * (i // across) + 1) / down - 1)
            area = self._inside(x, y, HALF / across, HALF / down)
            self.pixels.append(region(area, value, tolerance, f"{name}{where}: {source}"))
            self.missing = [m + share * (self.sky - r) for m, r in zip(self.missing, value)]

    def radiance(self, surface: Surface, frame: Sequence[Vec]) -> Vec3:
        wo, wi = [[dot(w, axis) for axis in frame] for w in ((0, 0, 1), SUN)]
        if wo[2] < 0:  # lobes want the viewer above the surface
            wo, wi = mul(wo, -1), mul(wi, -1)
        under_sun = times(surface.lobe(wo, wi), mul(SUN_COLOR, SUN_IRRADIANCE * self.sun))
        return add(mul(surface.albedo(wo[2]), self.sky), under_sun)

    def _inside(self, x: float, y: float, half_width: float, half_height: float) -> Region:
        """The whole pixels within a part of the picture, in cells, that show nothing of what is beside it."""
        sides = ((x, half_width, self.columns), (y, half_height, self.rows))
        first = [math.ceil(CELL * (at - half) + FILTER) / (CELL * cells) for at, half, cells in sides]
        last = [math.floor(CELL * (at + half) - FILTER) / (CELL * cells) for at, half, cells in sides]
        return first[0], first[1], last[0], last[1]

    def expect(self, shows: str, spp: int, source: str, tolerance: float) -> tuple[Gltf, Expected]:
        mean = [self.sky - m / (self.columns * self.rows) for m in self.missing]
        size = (self.columns * CELL, self.rows * CELL)
        return self.scene, expected(shows, size, spp, source, mean, tolerance, self.pixels)


def stored_texture(scene: Gltf, file: str, texels: Sequence[Sequence[int]], columns: int = 2) -> dict[str, Any]:
    """The use of a texture of these 8-bit texels, row by row, each with hard edges."""
    rows = len(texels) // columns

    def shader(u: float, v: float) -> Vec:
        return decoded(texels[int(v * rows) * columns + int(u * columns)])

    image = scene.add_image(file, png(columns, rows, len(texels[0]), shader))
    return scene.texture_info(scene.add_texture(image, nearest=True))


def decoded(texel: Sequence[int]) -> list[float]:
    return [c / 255 for c in texel]


def decoded_normal(texel: Sequence[int]) -> Vec3:
    return normalize([2 * c - 1 for c in decoded(texel)])


def extended(scene: Gltf, name: str, base: Vec, extension: str, values: dict[str, Any], **more: Any) -> int:
    """A pure Lambert base with one extension more."""
    extensions = {"KHR_materials_specular": {"specularFactor": 0}, extension: values}
    return scene.add_material(name, base, extensions=extensions, **more)


SUNLIT = "closed form: f cos E over the patches' projected areas"


# --- charts ---------------------------------------------------------------------------------------------------------


def specular() -> tuple[Gltf, Expected]:
    """KHR_materials_specular and KHR_materials_ior on black and on coloured bases."""
    chart = Chart(8, 4)
    scene = chart.scene

    def surface(base: Vec, roughness: float, ior: float, factor: float, color: Vec) -> Surface:
        values = {"specularFactor": factor, "specularColorFactor": color}
        extensions = {"KHR_materials_ior": {"ior": ior}, "KHR_materials_specular": values}
        material = scene.add_material("dielectric", base, roughness=roughness, extensions=extensions)
        return Surface(material, dielectric_lobe(base, roughness, ior, factor, color))

    def dielectric_lobe(base: Vec, roughness: float, ior: float, factor: float, color: Vec) -> Lobe:
        return lobes.MetallicRoughness(base, 0, roughness, lobes.dielectric_f0(ior, color, factor), factor)

    white = (1, 1, 1)
    kinds = (
        ("index 1.5", 1.5, 1, white), ("factor .3", 1.5, 0.3, white), ("colour", 1.5, 1, (1, 0.6, 0.2)),
        ("index 1.33", 1.33, 1, white), ("index 2.4", 2.4, 1, white), ("index infinite", 0, 1, (1, 0.7, 0.4)),
        ("index 1", 1, 1, white), ("colour beyond 1", 2.4, 0.8, (7, 3, 1)),
    )  # fmt: skip
    for row, normal in (("mirrors", PEAK), ("beside", towards(48, 25))):
        for name, ior, factor, color in kinds:
            chart.add(f"{row}, {name}", normal, surface(BLACK, 0.3, ior, factor, color))
    weights = [(9, 9, 9, a) for a in (40, 110, 180, 250)]
    tints = [(250, 120, 60), (60, 250, 120), (120, 60, 250), (200, 200, 200)]
    weight_map = stored_texture(scene, "specular-weight.png", weights)
    tint_map = stored_texture(scene, "specular-color.png", tints)
    by_weight, by_tint = {"specularTexture": weight_map}, {"specularColorTexture": tint_map}
    textured: list[tuple[str, dict[str, Any]]] = [
        ("weights", by_weight), ("half the weights", {"specularFactor": 0.5, **by_weight}), ("tints", by_tint),
        ("tints and factors", {"specularColorFactor": [0.4, 0.8, 1.6], **by_tint, **by_weight}),
    ]  # fmt: skip
    for normal in (PEAK, towards(65, 8)):
        for name, values in textured:
            material = scene.add_material(name, BLACK, roughness=0.3, extensions={"KHR_materials_specular": values})
            parts = []
            for weight, tint in zip(weights, tints):
                factor, color = values.get("specularFactor", 1), values.get("specularColorFactor", white)
                if "specularTexture" in values:
                    factor *= decoded(weight)[3]
                if "specularColorTexture" in values:
                    color = times(color, linear(tint))
                parts.append(Surface(material, dielectric_lobe(BLACK, 0.3, 1.5, factor, color)))
            chart.add(name, normal, *parts)
    for roughness in (0.2, 0.35, 0.5, 1):
        for normal in (towards(35, 60), PEAK):
            base = (0.7, 0.4, 0.1)
            name = f"coloured base, roughness {roughness}"
            chart.add(name, normal, surface(base, roughness, 1.5, 1, white), tolerance=0.003)
    shows = "Dielectrics by index, specular factor and colour, as numbers and by textures, under a sun."
    return chart.expect(shows, 16, SUNLIT, 0.003)


def clearcoat() -> tuple[Gltf, Expected]:
    """KHR_materials_clearcoat over Lambert and metal."""
    chart = Chart(6, 4)
    scene = chart.scene
    base = (0.5, 0.25, 0.1)
    weights, roughnesses = [(77, 9, 9), (204, 9, 9)], [(9, 102, 9), (9, 204, 9)]
    normals = [(148, 128, 253), (128, 148, 253), (108, 128, 253), (128, 108, 253)]
    weight_map = stored_texture(scene, "coat-weight.png", weights)
    roughness_map = stored_texture(scene, "coat-roughness.png", roughnesses)
    normal_map = stored_texture(scene, "coat-normal.png", normals)
    under = lobes.lambert(base)

    def coated(name: str, values: dict[str, Any], **more: Any) -> int:
        return extended(scene, name, base, "KHR_materials_clearcoat", {"clearcoatFactor": 1, **values}, **more)

    def plain(weight: float, roughness: float) -> Surface:
        values = {"clearcoatFactor": weight, "clearcoatRoughnessFactor": roughness}
        return Surface(coated(f"coat {weight} roughness {roughness}", values), lobes.coated(under, weight, roughness))

    by_weight = coated("coat by texture", {"clearcoatTexture": weight_map, "clearcoatRoughnessFactor": 0.25})
    values = {"clearcoatRoughnessTexture": roughness_map, "clearcoatRoughnessFactor": 0.5}
    by_roughness = coated("coat's roughness by texture", values)
    values = {"clearcoatNormalTexture": normal_map, "clearcoatRoughnessFactor": 0.3}
    by_normal = coated("coat's normal by texture", values)
    bumpy = coated("smooth coat over bumps", {"clearcoatRoughnessFactor": 0.3}, normalTexture=normal_map)

    def under_bump(normal: Vec) -> Lobe:
        """A smooth coat over a bump, for light that other bumps leave."""
        lobe = lobes.coated(lambda wo, wi: mul(base, max(dot(wi, normal), 0) / math.pi), 1, 0.3)
        return lambda wo, wi: mul(lobe(wo, wi), lobes.bump_shadowing(normal, wi))

    gold = (0.9, 0.6, 0.3)
    metal = scene.add_material(
        "coated metal", gold, metallic=1, roughness=0.3,
        extensions={"KHR_materials_clearcoat": {"clearcoatFactor": 0.8, "clearcoatRoughnessFactor": 0.15}},
    )  # fmt: skip
    metal_lobe = lobes.coated(lobes.MetallicRoughness(gold, 1, 0.3), 0.8, 0.15)
    cells: list[tuple[str, list[Surface]]] = [
        ("coat", [plain(1, 0.2)]), ("half a coat", [plain(0.5, 0.2)]), ("rough coat", [plain(1, 0.45)]),
        ("smooth coat", [plain(1, 0.1)]), ("coated metal", [Surface(metal, metal_lobe)]),
        ("weights", [Surface(by_weight, lobes.coated(under, decoded(w)[0], 0.25)) for w in weights]),
        ("roughnesses", [Surface(by_roughness, lobes.coated(under, 1, 0.5 * decoded(r)[1])) for r in roughnesses]),
        ("normals", [Surface(by_normal, lobes.coated(under, 1, 0.3, decoded_normal(n))) for n in normals]),
        ("bumps", [Surface(bumpy, under_bump(decoded_normal(n))) for n in normals]),
    ]  # fmt: skip
    for normal in (PEAK, towards(52, 20)):
        for name, parts in cells:
            chart.add(name, normal, *parts, tolerance=0.006 if name == "coated metal" else 0.001)
    for name, parts in cells[:5]:
        chart.add(f"{name}, aside", towards(40, 60), *parts, tolerance=0.006 if name == "coated metal" else 0.001)
    shows = "Clear coats: weight, roughness and normal, as numbers and by textures, under a sun."
    return chart.expect(shows, 16, SUNLIT, 0.003)


def sheen() -> tuple[Gltf, Expected]:
    """KHR_materials_sheen over Lambert."""
    chart = Chart(6, 3)
    scene = chart.scene
    base, color = (0.3, 0.15, 0.08), (0.9, 0.5, 0.25)
    colors, roughnesses = [(230, 120, 60), (60, 120, 230)], [(9, 9, 9, 128), (9, 9, 9, 230)]

    def surface(name: str, values: dict[str, Any], tint: Vec, roughness: float) -> Surface:
        material = extended(scene, name, base, "KHR_materials_sheen", values)
        return Surface(material, lobes.Sheen(lobes.lambert(base), tint, roughness))

    cells: list[tuple[str, list[Surface]]] = []
    for roughness in (0.3, 0.5, 0.75, 1):
        values = {"sheenColorFactor": color, "sheenRoughnessFactor": roughness}
        cells.append((f"roughness {roughness}", [surface("sheen", values, color, roughness)]))
    by_color = {"sheenColorFactor": [1, 1, 1], "sheenColorTexture": stored_texture(scene, "sheen-color.png", colors)}
    values = {**by_color, "sheenRoughnessFactor": 0.6}
    cells.append(("colours", [surface("colours", values, linear(c), 0.6) for c in colors]))
    values = {"sheenColorFactor": color, "sheenRoughnessFactor": 0.8}
    values["sheenRoughnessTexture"] = stored_texture(scene, "sheen-roughness.png", roughnesses)
    cells.append(("roughnesses", [surface("roughnesses", values, color, 0.8 * decoded(r)[3]) for r in roughnesses]))
    for normal in (towards(30, 20), towards(50, 70), towards(70, 340)):
        for name, parts in cells:
            chart.add(name, normal, *parts, tolerance=0.003)
    return chart.expect("Sheen by roughness and colour, as numbers and by textures, under a sun.", 16, SUNLIT, 0.004)


def anisotropy() -> tuple[Gltf, Expected]:
    """KHR_materials_anisotropy on metal."""
    chart = Chart(6, 3)
    scene = chart.scene
    color, roughness = (0.9, 0.6, 0.3), 0.25
    texels = [(255, 128, 255), (128, 255, 255), (218, 218, 128), (218, 37, 200)]

    def lobe(strength: float, degrees: float) -> Lobe:
        alpha = roughness**2
        return lobes.Facets(lobes.schlick(color), alpha + (1 - alpha) * strength**2, alpha, degrees)

    def material(name: str, values: dict[str, Any]) -> int:
        extensions = {"KHR_materials_anisotropy": values}
        return scene.add_material(name, color, metallic=1, roughness=roughness, extensions=extensions)

    def plain(strength: float, degrees: float) -> list[Surface]:
        values = {"anisotropyStrength": strength, "anisotropyRotation": math.radians(degrees)}
        return [Surface(material("brushed metal", values), lobe(strength, degrees))]

    cells = [(f"strength {s}, {d} degrees", plain(s, d)) for s, d in ((0.2, 0), (0.5, 0), (0.5, 90), (0.5, 30))]
    texture = stored_texture(scene, "anisotropy.png", texels)
    for turned in (0, 25):
        values = {"anisotropyStrength": 0.5, "anisotropyRotation": math.radians(turned), "anisotropyTexture": texture}
        brushed = material("brushed by texture", values)
        parts = []
        for texel in texels:
            x, y, strength = decoded(texel)
            degrees = math.degrees(math.atan2(2 * y - 1, 2 * x - 1)) + turned
            parts.append(Surface(brushed, lobe(0.5 * strength, degrees)))
        cells.append((f"directions by texture, turned by {turned}", parts))
    for normal in (PEAK, towards(65, 25), towards(52, 10)):
        for name, parts in cells:
            chart.add(name, normal, *parts, tolerance=0.003)
    shows = "Brushed metal: strength and direction, as numbers and by texture, under a sun."
    return chart.expect(shows, 16, SUNLIT, 0.006)


def iridescence() -> tuple[Gltf, Expected]:
    """KHR_materials_iridescence on metal and on black dielectric."""
    chart = Chart(6, 3)
    scene = chart.scene
    metal, roughness = (0.9, 0.6, 0.4), 0.2
    weights, thicknesses = [(51, 9, 9), (204, 9, 9)], [(9, t, 9) for t in (20, 90, 160, 240)]

    def material(is_metal: bool, values: dict[str, Any]) -> int:
        color, metallic = (metal, 1) if is_metal else (BLACK, 0)
        extensions = {"KHR_materials_iridescence": values}
        return scene.add_material("film", color, metallic=metallic, roughness=roughness, extensions=extensions)

    def lobe(is_metal: bool, factor: float, ior: float, thickness: float) -> Lobe:
        film = lobes.iridescence(factor, ior, thickness, metal if is_metal else (0.04,) * 3)
        return lobes.Facets(film, roughness**2)

    def plain(is_metal: bool, factor: float, ior: float, thickness: float) -> list[Surface]:
        values = {"iridescenceFactor": factor, "iridescenceIor": ior, "iridescenceThicknessMaximum": thickness}
        return [Surface(material(is_metal, values), lobe(is_metal, factor, ior, thickness))]

    cells = [
        ("film on metal", plain(True, 1, 1.3, 450)), ("half a film on metal", plain(True, 0.5, 1.8, 300)),
        ("film on plastic", plain(False, 1, 1.3, 550)), ("dense film on plastic", plain(False, 1, 1.9, 250)),
    ]  # fmt: skip
    values = {"iridescenceFactor": 0.9, "iridescenceTexture": stored_texture(scene, "film-weight.png", weights)}
    values |= {"iridescenceIor": 1.4, "iridescenceThicknessMaximum": 380}
    by_weight = material(True, values)
    cells.append(("weights", [Surface(by_weight, lobe(True, 0.9 * decoded(w)[0], 1.4, 380)) for w in weights]))
    low, high = 150, 650
    values = {"iridescenceFactor": 1, "iridescenceIor": 1.4}
    values |= {"iridescenceThicknessMinimum": low, "iridescenceThicknessMaximum": high}
    values["iridescenceThicknessTexture"] = stored_texture(scene, "film-thickness.png", thicknesses)
    by_thickness = material(True, values)
    parts = [Surface(by_thickness, lobe(True, 1, 1.4, low + (high - low) * decoded(t)[1])) for t in thicknesses]
    cells.append(("thicknesses", parts))
    for normal in (PEAK, towards(62, 20), towards(50, 8)):
        for name, parts in cells:
            chart.add(name, normal, *parts, tolerance=0.003)
    return chart.expect("Thin films on metal and plastic, as numbers and by textures, under a sun.", 16, SUNLIT, 0.004)


def diffuse_transmission() -> tuple[Gltf, Expected]:
    """KHR_materials_diffuse_transmission: leaves with the sun before or behind them, from both sides."""
    chart = Chart(5, 3)
    scene = chart.scene
    base, color = (0.6, 0.35, 0.1), (0.2, 0.8, 0.4)
    weights, colors = [(9, 9, 9, 64), (9, 9, 9, 200)], [(250, 120, 60), (60, 120, 250)]

    def surface(name: str, values: dict[str, Any], factor: float, through: Vec) -> Surface:
        material = extended(scene, name, base, "KHR_materials_diffuse_transmission", values)
        return Surface(material, lobes.lambert(mul(base, 1 - factor), mul(through, factor)))

    def plain(factor: float) -> list[Surface]:
        values = {"diffuseTransmissionFactor": factor, "diffuseTransmissionColorFactor": color}
        return [surface(f"leaf {factor}", values, factor, color)]

    cells = [(f"factor {factor}", plain(factor)) for factor in (0.25, 0.6, 1)]
    values = {"diffuseTransmissionColorFactor": color, "diffuseTransmissionFactor": 0.8}
    values["diffuseTransmissionTexture"] = stored_texture(scene, "leaf-weight.png", weights)
    cells.append(("weights", [surface("weights", values, 0.8 * decoded(w)[3], color) for w in weights]))
    values = {"diffuseTransmissionFactor": 0.7, "diffuseTransmissionColorFactor": color}
    values["diffuseTransmissionColorTexture"] = stored_texture(scene, "leaf-color.png", colors)
    cells.append(("colours", [surface("colours", values, 0.7, times(color, linear(c))) for c in colors]))
    leans = (("lit from behind", STRAIGHT), ("lit from before", towards(45, 40)), ("turned round", towards(150, 10)))
    for where, normal in leans:
        for name, parts in cells:
            chart.add(f"{name}, {where}", normal, *parts)
    shows = "Leaves that let diffuse light through, lit from both sides and seen from both."
    return chart.expect(shows, 16, SUNLIT, 0.002)


METALS = {  # complex indices at 650, 550, 450 nm: Johnson and Christy 1972, Rakic 1995 (refractiveindex.info)
    "gold": ((0.156, 0.424, 1.383), (3.602, 2.472, 1.915)),
    "silver": ((0.052, 0.060, 0.040), (4.409, 3.597, 2.648)),
    "copper": ((0.238, 1.007, 1.240), (3.626, 2.582, 2.393)),
    "aluminium": ((1.558, 1.015, 0.633), (7.712, 6.627, 5.454)),
}


def conductor() -> tuple[Gltf, Expected]:
    """PARIAN_materials_conductor: mirrors under a white sky show Fresnel's reflectance itself."""
    chart = Chart(6, 4, sky=True)
    scene = chart.scene

    def material(roughness: float, values: dict[str, Any]) -> int:
        extensions = {"PARIAN_materials_conductor": values}
        return scene.add_material("metal", (1, 1, 1), roughness=roughness, extensions=extensions)

    metals = [(name, {"name": name}, index) for name, index in METALS.items()]
    unnamed = {"mixed": ((0.143, 0.422, 0.965), (3.983, 2.347, 6.4)), "dark": ((1, 1.5, 2.5), (1, 0.3, 3))}
    for name, index in unnamed.items():
        metals.append((name, {"eta": index[0], "k": index[1]}, index))
    for degrees in (0, 60, 75):
        for i, (name, values, index) in enumerate(metals):
            mirror = Surface(material(0, values), albedo=lobes.conductor(*index))
            normal = towards(degrees, 30 * i)
            chart.add(f"{name}, {degrees} degrees", normal, mirror, tolerance=0.01, source="F")
    for name, values, index in metals:
        facets = lobes.Facets(lobes.conductor(*index), 0.5**2)
        rough = Surface(material(0.5, values), facets, facets.albedo)
        chart.add(f"rough {name}", PEAK, rough, tolerance=0.006, source="f cos E + albedo")
    return chart.expect(
        "Metals by name and by index: mirrors under a white sky at 0, 60 and 75 degrees; rough ones in the sun as well.",
        64, "closed form: F of n + ik, or f cos E + albedo, over the patches' projected areas", 0.002,
    )  # fmt: skip


def phong() -> tuple[Gltf, Expected]:
    """PARIAN_materials_phong under a white sky and a sun."""
    chart = Chart(5, 3, sky=True)
    diffuse, specular_color = (0.1, 0.3, 0.2), (0.8, 0.5, 0.3)
    for degrees, azimuth in ((0, 0), (60, 180), (57, 15)):
        for exponent, base in ((1, BLACK), (10, BLACK), (50, BLACK), (10, diffuse), (400, diffuse)):
            values = {"diffuse": base, "specular": specular_color, "exponent": exponent}
            material = chart.scene.add_material("phong", extensions={"PARIAN_materials_phong": values})

            def albedo(mu: float, n: float = exponent, d: Vec = base) -> Color:
                return add(d, mul(specular_color, lobes.phong_albedo(n, mu)))

            surface = Surface(material, lobes.phong(base, specular_color, exponent), albedo)
            name = f"exponent {exponent}{'' if base == BLACK else ' over a base'}, {degrees:g} degrees"
            chart.add(name, towards(degrees, azimuth), surface, tolerance=0.015, source="f cos E + albedo")
    return chart.expect(
        "Phong lobes under a white sky and a sun: exponents 1, 10, 50; with a diffuse base 10, 400.",
        128, "closed form: f cos E + albedo over the patches' projected areas; at the normal the albedo is 1", 0.005,
    )  # fmt: skip


def surfaces_furnace() -> tuple[Gltf, Expected]:
    """A surface of each kind under a white sky: its directional albedo."""
    chart = Chart(10, 3, sun=False, sky=True)
    scene = chart.scene
    white, base, gold = (1, 1, 1), (0.7, 0.4, 0.15), (0.9, 0.6, 0.3)

    def metallic_roughness(color: Vec, metallic: float, roughness: float) -> Surface:
        material = scene.add_material("plain", color, metallic=metallic, roughness=roughness)
        return Surface(material, albedo=lobes.MetallicRoughness(color, metallic, roughness).albedo)

    tint = (4, 2.5, 1.5)
    values: dict[str, Any] = {"KHR_materials_ior": {"ior": 2.4}, "KHR_materials_specular": {"specularColorFactor": tint}}
    dense = scene.add_material("dense", BLACK, roughness=0.4, extensions=values)
    dense_lobe = lobes.MetallicRoughness(BLACK, 0, 0.4, lobes.dielectric_f0(2.4, tint))

    values = {"clearcoatFactor": 0.9, "clearcoatRoughnessFactor": 0.15}
    coat = extended(scene, "coat", base, "KHR_materials_clearcoat", values)

    def coat_albedo(mu: float) -> Color:
        share = lobes.coat_reflectance(0.9, mu)
        return add(mul(base, 1 - share), mul(lobes.ggx_albedo(lambda cosine: white, 0.15**2, mu), share))

    values = {"sheenColorFactor": [0.3, 0.6, 0.9], "sheenRoughnessFactor": 0.6}
    cloth = extended(scene, "cloth", base, "KHR_materials_sheen", values)
    sheen_lobe = lobes.Sheen(lobes.lambert(base), (0.3, 0.6, 0.9), 0.6)

    def metal(name: str, roughness: float, extension: str, values: dict[str, Any]) -> int:
        return scene.add_material(name, gold, metallic=1, roughness=roughness, extensions={extension: values})

    brushed = metal("brushed", 0.3, "KHR_materials_anisotropy", {"anisotropyStrength": 0.6})
    brushed_lobe = lobes.Facets(lobes.schlick(gold), 0.09 + 0.91 * 0.6**2, 0.09)
    values = {"iridescenceFactor": 1, "iridescenceIor": 1.4, "iridescenceThicknessMaximum": 420}
    film = metal("film", 0.2, "KHR_materials_iridescence", values)
    film_lobe = lobes.Facets(lobes.iridescence(1, 1.4, 420, gold), 0.04)
    values = {"diffuseTransmissionFactor": 0.4, "diffuseTransmissionColorFactor": [0.2, 0.8, 0.4]}
    leaf = extended(scene, "leaf", base, "KHR_materials_diffuse_transmission", values)
    leaf_albedo = add(mul(base, 0.6), mul((0.2, 0.8, 0.4), 0.4))
    cells = (
        ("plastic", metallic_roughness(base, 0, 0.5)), ("rough gold", metallic_roughness(gold, 1, 0.6)),
        ("half metal", metallic_roughness(gold, 0.5, 0.4)), ("rough white metal", metallic_roughness(white, 1, 0.9)),
        ("dense dielectric", Surface(dense, albedo=dense_lobe.albedo)), ("coat", Surface(coat, albedo=coat_albedo)),
        ("sheen", Surface(cloth, albedo=lambda mu: sheen_lobe.albedo(base, mu))),
        ("brushed metal", Surface(brushed, albedo=brushed_lobe.albedo)),
        ("film", Surface(film, albedo=film_lobe.albedo)),
        ("leaf", Surface(leaf, albedo=lambda mu: leaf_albedo)),
    )  # fmt: skip
    for degrees in (0, 50, 72):
        for name, surface in cells:
            normal = towards(degrees, 0)
            chart.add(f"{name}, {degrees} degrees", normal, surface, tolerance=0.015, source="directional albedo")
    return chart.expect(
        "Surfaces of every kind under a white sky, seen at 0, 50 and 72 degrees.",
        64, "closed form: directional albedos by quadrature, over the patches' areas", 0.004,
    )  # fmt: skip


# --- terminator -----------------------------------------------------------------------------------------------------


def terminator() -> tuple[Gltf, Expected]:
    """Coarse balls with interpolated normals beside the exact one, lit from the side: the terminator must be the curved
    surface's, not the triangles'."""
    rho, cell, radius = (0.8, 0.5, 0.3), 48, 0.44
    side, irradiance = towards(85, 15), 3.0
    # Rings, and how far the mean of the middle and of the strip beside the terminator may be off. By the triangles' own
    # horizon the last two strips would be 23 and 51% too dark.
    balls = ((0, 0.001, 0.003), (24, 0.003, 0.01), (12, 0.01, 0.02), (6, 0.035, 0.03))
    middle, strip, dark = (-0.6, -0.6, 0.6, 0.6), (-0.09, -0.47, 0.05, 0.09), (-0.7, -0.4, -0.3, 0.4)
    scene = Gltf()
    scene.add_orthographic_camera((0, 0, 5), (0, 0, 0, 1), len(balls) / 2, 0.5, zfar=1000)
    scene.add_punctual_light("directional", "sun", SUN_COLOR, irradiance, side, (0, 0, 0))
    white = scene.add_lambert("rho .8 .5 .3", rho)
    pixels = []
    for i, (rings, bias, strip_bias) in enumerate(balls):
        x = i + 0.5 - len(balls) / 2
        name = f"{rings} rings" if rings else "exact ball"
        if rings:
            scene.add_object(name, sphere(radius, 2 * rings, rings).without("uvs"), white, translation=(x, 0, -200 * i))
        else:
            draw(scene, ball(radius), white, name, translation=(x, 0, -200 * i))
        parts = ((middle, bias, "middle"), (strip, strip_bias, "beside the terminator"), (dark, 0.01, "dark side"))
        for area, tolerance, what in parts:
            # Whole pixels, as parts of the radius from the middle of the ball.
            box = [round(cell * (0.5 + radius * a)) for a in area]
            lit = mean_cosine(side, [(b / cell - 0.5) / radius for b in box])
            value = [irradiance / math.pi * lit * r * c for r, c in zip(rho, SUN_COLOR)]
            x0, x1 = [(i * cell + b) / (cell * len(balls)) for b in (box[0], box[2])]
            seen = (x0, box[1] / cell, x1, box[3] / cell)
            pixels.append(region(seen, value, tolerance, f"{name}, {what}: rho/pi E cos"))
    return scene, expected(
        "An exact ball and balls of 24, 12 and 6 rings with interpolated normals, lit from the side.",
        (cell * len(balls), cell), 64, "closed form of the exact ball, region by region", None, 0.01, pixels,
    )  # fmt: skip


def mean_cosine(sun: Vec, area: Sequence[float], steps: int = 64) -> float:
    """Of the sun to a unit ball's normals, 0 where it is below, over a box of the ball's picture, y downwards."""
    total = 0.0
    for i in range(steps):
        for j in range(steps):
            x = area[0] + (area[2] - area[0]) * (i + 0.5) / steps
            y = -(area[1] + (area[3] - area[1]) * (j + 0.5) / steps)
            total += max(dot(sun, (x, y, math.sqrt(1 - x * x - y * y))), 0)
    return total / steps**2
