#!/usr/bin/env python3
"""Checks that includes go one way only, and that each third-party library stays in its home.

usage: check_layers.py [ROOT]

Prints each offender as file:line: reason, and exits with 1 where there is one.
"""

import os
import re
import sys

# What each layer may include besides itself. docs/architecture.md says why.
SEES = {
    "base": [],
    "compare": ["base"],
    "shapes": ["base"],
    "scene": ["base", "shapes"],
    "light": ["base", "shapes", "scene"],
    "color": ["base", "scene"],
    "film": ["base", "scene"],
    "accel": ["base", "scene", "shapes"],
    "session": ["base", "scene", "shapes", "light", "film", "accel"],
    "materials": ["base", "scene"],
    "integrators": ["base", "scene", "shapes", "light", "film", "accel", "session", "materials"],
    "images": ["base", "scene"],
    "scene_io": ["base", "scene", "images"],
    "editing": ["base", "shapes", "scene", "session", "images", "scene_io"],
    "apps": ["base", "scene", "shapes", "light", "color", "film", "accel", "session", "materials",
             "integrators", "images", "scene_io", "editing", "compare"],
}  # fmt: skip

# Headers of third-party libraries by pattern, and the paths they may be included from. "" is everywhere.
HOMES = [
    (r"Imath/", [""]),
    (r"fmt/", [""]),
    (r"embree[34]/", ["renderer/accel/", "bench/"]),
    (r"(tbb|oneapi)/", ["renderer/base/parallel"]),
    (r"OpenColorIO/", ["renderer/color/"]),
    (r"OpenImageIO/", ["images/oiio/", "tests/images/"]),
    (r"(tiny_gltf|stb_image.*)\.h$", ["scene_io/gltf/"]),
    (r"draco/", ["scene_io/gltf/geometry/draco", "scene_io/support/draco_"]),
    (r"meshoptimizer\.h$", ["scene_io/gltf/geometry/meshopt"]),
    (r"nlohmann/", ["scene_io/", "apps/"]),
    (r"CLI/", ["apps/"]),
    (r"(Qt\w*/|Q[A-Z]\w*$)", ["apps/editor"]),
    (r"(gtest|gmock|benchmark)/", ["tests/"]),
]
# Headers of the system, with a dot or a slash in their names as third-party ones have.
SYSTEM = re.compile(r"(sys/\w+|unistd|fcntl|signal|pthread|sched|dlfcn|termios|\wmmintrin|x86intrin)\.h$")

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
FOLDERS = ["renderer", "images", "scene_io", "editing", "materials", "integrators", "apps", "tests"]


def layer_of(path):
    """The layer that the file at a path, relative to the root, belongs to; None for tests."""
    parts = path.split("/")
    if parts[0] == "renderer" and len(parts) > 2:
        return parts[1]
    return parts[0] if parts[0] in SEES else None


def problem_of_project_include(root, path, included):
    if not os.path.exists(os.path.join(root, included)):
        return f'"{included}" is not a path from the root of the repository'
    if path.startswith("tests/"):
        return None
    layer, target = layer_of(path), layer_of(included)
    if layer not in SEES:
        return f"{layer or path} is not a layer"
    if target != layer and target not in SEES[layer]:
        return f'{layer} must not see {target or "tests"} ("{included}")'
    return None


def problem_of_library_include(path, included):
    # A test of x may include what x may.
    mirrored = path.removeprefix("tests/")
    for pattern, homes in HOMES:
        if re.match(pattern, included):
            if any(path.startswith(home) or mirrored.startswith(home) for home in homes):
                return None
            return f"<{included}> belongs to {' and '.join(homes)}"
    if ("/" in included or "." in included) and not SYSTEM.match(included):
        return f"<{included}> is of a library that has no home here"
    return None


def check(root):
    """All offenders, as lines of text, and the number of files looked at."""
    offenders, files = [], 0
    for folder in FOLDERS:
        for where, _, names in sorted(os.walk(os.path.join(root, folder))):
            for name in sorted(names):
                if not name.endswith((".cpp", ".h")):
                    continue
                files += 1
                path = os.path.relpath(os.path.join(where, name), root).replace(os.sep, "/")
                with open(os.path.join(where, name), encoding="utf-8") as file:
                    for number, line in enumerate(file, 1):
                        match = INCLUDE.match(line)
                        if not match:
                            continue
                        if match[1] == '"':
                            problem = problem_of_project_include(root, path, match[2])
                        else:
                            problem = problem_of_library_include(path, match[2])
                        if problem:
                            offenders.append(f"{path}:{number}: {problem}")
    return offenders, files


def main():
    root = sys.argv[1] if len(sys.argv) > 1 else os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")
    offenders, files = check(root)
    for offender in offenders:
        print(offender)
    print(f"layers: {len(offenders)} offenders in {files} files")
    return 1 if offenders or not files else 0


if __name__ == "__main__":
    sys.exit(main())
