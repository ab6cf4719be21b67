"""Tests of scripts/check_layers.py on a small tree of its own."""

import os
import subprocess
import sys
import tempfile
import unittest

SCRIPT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "scripts", "check_layers.py")

GOOD = {
    "renderer/base/math.h": "#include <Imath/ImathVec.h>\n#include <vector>\n",
    "renderer/base/parallel.cpp": '#include "renderer/base/math.h"\n\n#include <tbb/parallel_for.h>\n',
    "renderer/scene/scene.h": '#include "renderer/base/math.h"\n',
    "renderer/light/light.h": '#include "renderer/scene/scene.h"\n',
    "renderer/film/film.h": '#include "renderer/scene/scene.h"\n',
    "renderer/accel/accel.cpp": "#include <embree4/rtcore.h>\n",
    "renderer/session/session.h": '#include "renderer/film/film.h"\n',
    "materials/bsdf.h": '#include "renderer/scene/scene.h"\n',
    "integrators/path.cpp": '#include "materials/bsdf.h"\n#include "renderer/session/session.h"\n',
    "images/oiio/read.cpp": "#include <OpenImageIO/imageio.h>\n#include <unistd.h>\n",
    "tests/images/image_io_test.cpp": "#include <OpenImageIO/imageio.h>\n#include <gtest/gtest.h>\n",
    "tests/bench/replay.cpp": '#include <embree3/rtcore.h>\n#include "integrators/../materials/bsdf.h"\n',
}
BAD = [
    ("renderer/base/math.h", '#include "renderer/scene/scene.h"', "base must not see scene"),
    ("renderer/light/light.h", '#include "renderer/film/film.h"', "light must not see film"),
    ("materials/bsdf.h", '#include "renderer/light/light.h"', "materials must not see light"),
    ("renderer/session/session.h", '#include "materials/bsdf.h"', "session must not see materials"),
    ("images/oiio/read.cpp", '  #  include "integrators/path.cpp"', "images must not see integrators"),
    ("images/oiio/read.cpp", '#include "tests/bench/replay.cpp"', "images must not see tests"),
    ("renderer/odd/thing.h", '#include "renderer/base/math.h"', "odd is not a layer"),
    ("integrators/path.cpp", '#include "bsdf.h"', "is not a path from the root"),
    ("renderer/session/session.h", "#include <embree4/rtcore.h>", "<embree4/rtcore.h> belongs to renderer/accel/"),
    ("renderer/base/math.h", "#include <tbb/tbb.h>", "<tbb/tbb.h> belongs to"),
    ("images/image_io.cpp", "#include <OpenImageIO/imageio.h>", "belongs to images/oiio/"),
    ("apps/command_line/main.cpp", "#include <QWidget>", "belongs to apps/editor"),
    ("materials/bsdf.h", "#include <gtest/gtest.h>", "belongs to tests/"),
    ("tests/materials/bsdf_test.cpp", "#include <OpenColorIO/OpenColorIO.h>", "belongs to renderer/color/"),
    ("integrators/path.cpp", "#include <boost/any.hpp>", "no home here"),
]


class CheckLayers(unittest.TestCase):
    def run_on(self, files):
        with tempfile.TemporaryDirectory() as root:
            for path, text in files.items():
                os.makedirs(os.path.dirname(os.path.join(root, path)), exist_ok=True)
                with open(os.path.join(root, path), "w", encoding="utf-8") as file:
                    file.write(text)
            return subprocess.run([sys.executable, SCRIPT, root], capture_output=True, text=True, check=False)

    def test_accepts_what_the_layers_allow(self):
        result = self.run_on(GOOD)
        self.assertEqual(result.returncode, 0, result.stdout)
        self.assertIn(f"0 offenders in {len(GOOD)} files", result.stdout)

    def test_names_each_offender(self):
        for path, line, reason in BAD:
            with self.subTest(path=path, line=line):
                result = self.run_on(GOOD | {path: "#include <vector>\n" + line + "\n"})
                self.assertEqual(result.returncode, 1)
                self.assertIn(f"{path}:2: ", result.stdout)
                self.assertIn(reason, result.stdout)
                self.assertIn("1 offenders", result.stdout)

    def test_an_empty_tree_is_an_error(self):
        self.assertEqual(self.run_on({"README.md": ""}).returncode, 1)


if __name__ == "__main__":
    unittest.main()
