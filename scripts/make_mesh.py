#!/usr/bin/env python3
"""Writes a .glb with about N triangles, for benchmarks of large scenes.

    scripts/make_mesh.py [--kind sphere|terrain|forest|soup] [--textured] N OUT.glb

    sphere   one displaced sphere
    terrain  one height field: mountains and valleys
    forest   instances of three trees on rolling ground; N counts what is drawn. With --instances M there are M trees,
             of N / M triangles each, within the bounds of what a tree has
    soup     boxes, blobs and clouds of loose triangles: a mesh and a node for each 500 triangles. --loose SHARE says
             how many of the triangles share no vertex with another

Smooth normals, Lambert surfaces, a sky from an embedded .hdr, a camera that frames it; with --textured also texture
coordinates and pictures of 2048 x 2048 texels. The same arguments give the same file. All kinds but the sphere need
numpy, and a sphere without it takes some ten times longer. What is made goes to the disk at once: 50 million triangles
take less than a gigabyte of memory. A file is 4 GiB at most.
"""

import argparse
import importlib.util
import sys
from pathlib import Path

from image_files import png_of_bytes, to_srgb
from large_glb import LIMIT, GlbWriter, TooLarge
from large_sphere import write_sphere

HAS_NUMPY = importlib.util.find_spec("numpy") is not None
# Bytes for a triangle, at least: what is larger than a .glb holds is refused before it is made.
LEAST_BYTES = {"sphere": 24, "terrain": 24, "soup": 16, "forest": 0}


def chequers() -> bytes:
    """The sphere's picture, which needs no numpy: two greys, by rows that repeat."""
    dark, light = (bytes(int(to_srgb(c) * 255 + 0.5) for c in color) for color in ((0.3, 0.2, 0.15), (0.6, 0.58, 0.55)))
    rows = [b"".join((light, dark)[(x // 64 + odd) % 2] for x in range(2048)) for odd in (0, 1)]
    return png_of_bytes(2048, 2048, 3, b"".join(rows[y // 64 % 2] for y in range(2048)), 3)


def write(writer: GlbWriter, args: argparse.Namespace) -> str:
    """What was written, in words."""
    if args.kind == "sphere":
        return write_sphere(writer, args.triangles, chequers() if args.textured else None, args.no_numpy)
    if args.kind == "terrain":
        from large_terrain import write_terrain

        return write_terrain(writer, args.triangles, args.textured)
    if args.kind == "forest":
        from large_forest import write_forest

        return write_forest(writer, args.triangles, args.instances, args.textured)
    from large_soup import write_soup

    return write_soup(writer, args.triangles, args.loose, args.textured)


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__.splitlines()[0], epilog=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("triangles", type=int, metavar="N", help="how many triangles, about")
    parser.add_argument("out", type=Path, metavar="OUT.glb")
    parser.add_argument("--kind", choices=("sphere", "terrain", "forest", "soup"), default="sphere")
    parser.add_argument("--textured", action="store_true", help="texture coordinates and pictures")
    parser.add_argument("--instances", type=int, metavar="M", help="forest: how many trees (1 to 10000000)")
    parser.add_argument("--loose", type=float, metavar="SHARE", default=0.2, help="soup: of loose triangles (.2)")
    parser.add_argument("--no-sky", action="store_true", help="no image in the file: Parian adds a white sky")
    parser.add_argument("--no-numpy", action="store_true", help="sphere: do without numpy")
    args = parser.parse_args()
    if args.triangles < 1 or args.triangles > 10**12:
        parser.error("N must be between 1 and 1000000000000")
    if args.instances is not None and not (args.kind == "forest" and 1 <= args.instances <= 10_000_000):
        parser.error("--instances is for --kind forest, and between 1 and 10000000")
    if not 0 <= args.loose <= 1:
        parser.error("--loose must be between 0 and 1")
    if args.kind != "sphere" and not HAS_NUMPY:
        parser.error(f"--kind {args.kind} needs numpy (Debian: python3-numpy)")
    return args


def main() -> None:
    args = arguments()
    if LEAST_BYTES[args.kind] * args.triangles > LIMIT:
        sys.exit(f"{args.out}: the scene is larger than 4 GiB, the most that a .glb holds")
    pieces = args.triangles // 500 if args.kind == "soup" else 0
    writer = GlbWriter(args.out, (1 << 16) + 1000 * pieces)
    try:
        text = write(writer, args)
        writer.finish(not args.no_sky)
    except TooLarge as error:
        sys.exit(str(error))
    finally:
        writer.discard()
    print(f"{args.out}: {text}")


if __name__ == "__main__":
    main()
