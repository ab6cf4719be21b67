"""Writes one .glb part by part: what a large scene holds is on the disk as soon as it is made, and not in memory.

Standard library only. Parts are views of known size that are filled in order, several at a time where that is handy.
"""

import json
import math
import os
import struct
from pathlib import Path
from typing import Any, Iterable, Optional, Sequence

from gltf_shapes import Vec, Vec3, look_at, mul
from image_files import environment_hdr

LIMIT = 2**32 - 1  # bytes of a .glb, whose header has 32 bits for them
FLOAT, UINT16, UINT32 = 5126, 5123, 5125
VERTICES, INDICES = 34962, 34963
LAMBERT = {"KHR_materials_specular": {"specularFactor": 0}}
_HEADERS = 12 + 8 + 8


class TooLarge(Exception):
    """The scene does not fit into one .glb."""


class View:
    """A bufferView whose bytes come in order."""

    def __init__(self, file: Any, begin: int, size: int, index: int) -> None:
        self.file, self.at, self.end, self.index = file, begin, begin + size, index

    def write(self, data: Any) -> None:
        """Any C-contiguous buffer."""
        size = memoryview(data).nbytes
        assert self.at + size <= self.end
        self.file.seek(self.at)
        self.file.write(data)
        self.at += size


class GlbWriter:
    """`room`: the bytes that the JSON may take; the file appears when `finish` is through, or not at all."""

    def __init__(self, path: Path, room: int = 1 << 16) -> None:
        self.path, self.room = path, room + -room % 4
        self.part = path.with_name(path.name + ".part")
        self.file = open(self.part, "wb")
        self.size = 0  # of the binary chunk
        self.arrays: dict[str, list[dict[str, Any]]] = {}
        self.used = {"KHR_materials_specular"}

    def append(self, array: str, item: dict[str, Any]) -> int:
        items = self.arrays.setdefault(array, [])
        items.append(item)
        return len(items) - 1

    def view(self, size: int, target: Optional[int] = None, stride: Optional[int] = None) -> View:
        """Throws TooLarge."""
        begin = self.size
        self.size += size + -size % 4
        if _HEADERS + self.room + self.size > LIMIT:
            raise TooLarge(f"{self.path}: the scene is larger than 4 GiB, the most that a .glb holds")
        item = {"buffer": 0, "byteOffset": begin, "byteLength": size}
        extra = {"target": target, "byteStride": stride}
        item.update({key: value for key, value in extra.items() if value})
        return View(self.file, _HEADERS + self.room + begin, size, self.append("bufferViews", item))

    def accessor(self, view: View, component: int, kind: str, count: int, offset: int = 0, **more: Any) -> int:
        item = {"bufferView": view.index, "componentType": component, "count": count, "type": kind, **more}
        if offset:
            item["byteOffset"] = offset
        return self.append("accessors", item)

    def picture(self, encoded: bytes, mime_type: str) -> int:
        """The index of an image."""
        view = self.view(len(encoded))
        view.write(encoded)
        return self.append("images", {"bufferView": view.index, "mimeType": mime_type})

    def texture(self, encoded_png: bytes) -> int:
        """The index of a texture that repeats."""
        return self.append("textures", {"source": self.picture(encoded_png, "image/png")})

    def material(self, name: str, color: Vec, texture: Optional[int] = None, **more: Any) -> int:
        """A Lambert surface unless `more` has other extensions or pbr numbers."""
        pbr = {"baseColorFactor": [*color, 1], "metallicFactor": 0, "roughnessFactor": 1, **more.pop("pbr", {})}
        if texture is not None:
            pbr["baseColorTexture"] = {"index": texture}
        item = {"name": name, "pbrMetallicRoughness": pbr, "extensions": LAMBERT, **more}
        return self.append("materials", item)

    def camera(self, eye: Vec3, target: Vec3, yfov: float = 0.68, aspect: float = 1) -> int:
        """The index of the camera's node."""
        perspective = {"yfov": yfov, "aspectRatio": aspect, "znear": 0.01}
        camera = self.append("cameras", {"type": "perspective", "perspective": perspective})
        node = {"name": "camera", "camera": camera, "translation": list(eye)}
        turn = look_at(eye, target)
        if turn != (0, 0, 0, 1):
            node["rotation"] = list(turn)
        return self.append("nodes", node)

    def finish(self, with_sky: bool = True) -> None:
        """Adds the sky, and puts the JSON into its room. All nodes are roots. Throws TooLarge."""
        scene: dict[str, Any] = {"nodes": list(range(len(self.arrays["nodes"])))}
        top: dict[str, Any] = {}
        if with_sky:
            sky_image = self.picture(environment_hdr(128, 64, sky), "image/vnd.radiance")
            top = {"EXT_lights_environment": {"environments": [{"source": sky_image, "intensity": 1}]}}
            scene["extensions"] = {"EXT_lights_environment": {"environment": 0}}
            self.used.add("EXT_lights_environment")
        gltf = {
            "asset": {"version": "2.0", "generator": "Parian scripts/make_mesh.py"},
            "extensionsUsed": sorted(self.used),
            **({"extensions": top} if top else {}),
            "scene": 0,
            "scenes": [scene],
            **self.arrays,
            "buffers": [{"byteLength": self.size}],
        }
        text = json.dumps(gltf, separators=(",", ":")).encode()
        assert len(text) <= self.room, f"{len(text)} bytes of JSON, room for {self.room}"
        self.file.truncate(_HEADERS + self.room + self.size)
        self.file.seek(0)
        self.file.write(struct.pack("<4sII", b"glTF", 2, _HEADERS + self.room + self.size))
        self.file.write(struct.pack("<I4s", self.room, b"JSON") + text.ljust(self.room))
        self.file.write(struct.pack("<I4s", self.size, b"BIN\0"))
        self.file.close()
        os.replace(self.part, self.path)

    def discard(self) -> None:
        """Leaves nothing of a file that is not finished."""
        if not self.file.closed:
            self.file.close()
            self.part.unlink()


def bounds(low: Iterable[float], high: Iterable[float]) -> dict[str, Sequence[float]]:
    """What an accessor of positions has to have."""
    return {"min": [float(x) for x in low], "max": [float(x) for x in high]}


def sky(w: Vec3) -> Vec3:
    """Grey-blue, with a broad warm lamp to the upper left."""
    towards = max(0.0, (-0.5 * w[0] + 0.7 * w[1] + 0.5 * w[2]) / math.sqrt(0.99))
    warm = 6.0 * towards**40
    base = mul((0.45, 0.55, 0.7), 0.6 + 0.4 * w[1])
    return base[0] + warm, base[1] + 0.9 * warm, base[2] + 0.75 * warm
