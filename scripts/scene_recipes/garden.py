"""Many copies of few meshes."""

import math

from gltf_builder import Gltf
from gltf_shapes import compose, floor, icosphere, lathe, mul, rotation
from image_files import environment_hdr
from scene_recipes.expectations import Expected, measured


def instances() -> tuple[Gltf, Expected]:
    """Petals and seeds of a giant flower as instances; trees by nodes with negative and non-uniform scales."""
    scene = Gltf()
    scene.add_object("ground", floor(40).without("uvs"), scene.add_lambert("ground", (0.3, 0.36, 0.2)))
    add_flower(scene)
    add_trees(scene)
    sky = environment_hdr(32, 16, lambda w: mul((0.5, 0.68, 1.0), 0.55 + 0.3 * w[1]))
    scene.set_environment(scene.add_image("sky.hdr", sky))
    scene.add_punctual_light("directional", "sun", (1, 0.86, 0.66), 3.4, (-9.5, 8.5, 3.5), (0, 0, 0))
    scene.add_camera((0, 3.9, 8.2), (0, 0.75, -0.6), yfov_degrees=32, aspect=1.5)
    return scene, measured(
        "700 instances in a sunflower's spiral (EXT_mesh_gpu_instancing), and trees of nodes, the right one the left "
        "one mirrored by a negative scale."
    )


def add_flower(scene: Gltf) -> None:
    """One mesh per kind of petal, placed by the golden angle on a dome."""
    golden = math.pi * (3 - math.sqrt(5))
    grain = icosphere(1, 2)
    kinds = [("seed", (0.09, 0.045, 0.025), 0.35), ("floret", (0.7, 0.28, 0.02), 0.4)]
    kinds += [("petal", (0.9, 0.6, 0.04), 0.45)]
    limits = [0, 280, 520, 700]
    for kind, (name, color, roughness) in enumerate(kinds):
        mesh = scene.add_mesh(name, (grain, scene.add_material(name, color, roughness=roughness)))
        translations, rotations, scales = [], [], []
        for k in range(limits[kind], limits[kind + 1]):
            radius, angle = 0.082 * math.sqrt(k + 0.5), k * golden
            height = 0.06 + 0.75 * math.exp(-((radius / 1.3) ** 2))
            translations.append((radius * math.cos(angle), height, radius * math.sin(angle)))
            tilt = rotation((0, 0, 1), 24 if kind == 2 else 90 - 22 * radius)
            rotations.append(compose(rotation((0, 1, 0), -math.degrees(angle)), tilt))
            petal = (0.34, 0.035, 0.13)
            size = 0.075 + 0.012 * kind
            scales.append(petal if kind == 2 else (size * 1.7, size, size))
        scene.add_instances(name, mesh, translations, rotations, scales)


def add_trees(scene: Gltf) -> None:
    """A branch has two children: a turned one, and a mirrored and squeezed one; so do those."""
    bark = scene.add_lambert("bark", (0.3, 0.18, 0.11))
    leaf = scene.add_material("leaf", (0.1, 0.34, 0.1), roughness=0.5)
    trunk = lathe([(0, 1), (0.075, 1), (0.11, 0), (0, 0)], 12, smooth=False).without("uvs")
    trunk_mesh = scene.add_mesh("trunk", (trunk, bark))
    leaf_mesh = scene.add_mesh("leaf", (icosphere(1, 2), leaf))

    def branch(depth: int) -> int:
        if depth == 0:
            return scene.add_node("leaf", mesh=leaf_mesh, translation=(0, 0.55, 0), scale=(0.8, 0.85, 0.45))
        children = []
        for scale, turn in (((0.74, 0.74, 0.74), 34), ((-0.66, 0.7, 0.78), -40)):
            lean = compose(rotation((0, 1, 0), 64), rotation((0, 0, 1), turn))
            below = branch(depth - 1)
            twig = scene.add_node("twig", translation=(0, 0.96, 0), rotation=lean, scale=scale, children=[below])
            children.append(twig)
        return scene.add_node("branch", mesh=trunk_mesh, children=children)

    for side, x in ((1, -2.65), (-1, 2.65)):
        scene.add_node("tree", translation=(x, 0, -1.6), scale=(side * 1.05, 0.95, 1.05), children=[branch(5)])
