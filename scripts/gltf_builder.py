"""Builds a glTF 2.0 document and writes it as .gltf + .bin, the same bytes every time; standard library only.

Indices returned by the `add_` functions are what other calls take. Units are metres, radians, linear Rec.709.
"""

import json
import math
import struct
from pathlib import Path
from typing import Any, Optional, Sequence

from gltf_shapes import Geometry, Quat, Vec, look_at

_COMPONENT_FORMAT = {5121: "B", 5123: "H", 5125: "I", 5126: "f"}
_TYPE_OF_WIDTH = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}
_FLOAT, _UINT8, _UINT16, _UINT32 = 5126, 5121, 5123, 5125
WRAP = {"clamp": 33071, "mirror": 33648, "repeat": 10497}


class Gltf:
    """One document with one scene; every node without a parent is a root."""

    def __init__(self) -> None:
        self.arrays: dict[str, list[dict[str, Any]]] = {}
        self.used_extensions: set[str] = set()
        self.light_arrays: dict[str, list[dict[str, Any]]] = {}
        self.shapes: list[dict[str, Any]] = []
        self.scene: dict[str, Any] = {}
        self.environment: Optional[dict[str, Any]] = None
        self.binary = bytearray()
        self.files: dict[str, bytes] = {}
        self.known_accessors: dict[Any, int] = {}

    # --- materials and textures -------------------------------------------------------------------------------------

    def add_material(
        self,
        name: str,
        color: Vec = (1, 1, 1),
        *,
        metallic: float = 0,
        roughness: float = 1,
        emission: Vec = (0, 0, 0),
        double_sided: bool = False,
        **more: Any,
    ) -> int:
        """A metallic-roughness material. `more` is put into the material as it is; its key `pbr` is put into
        pbrMetallicRoughness, and `extensions` are registered as used."""
        rgba = [*color, 1] if len(color) == 3 else list(color)
        pbr = {"baseColorFactor": rgba, "metallicFactor": metallic, "roughnessFactor": roughness, **more.pop("pbr", {})}
        material: dict[str, Any] = {"name": name, "pbrMetallicRoughness": pbr, **more}
        strength = max(emission)
        if strength > 0:
            material["emissiveFactor"] = [e / max(strength, 1) for e in emission]
            if strength > 1:
                extensions = material.setdefault("extensions", {})
                extensions["KHR_materials_emissive_strength"] = {"emissiveStrength": strength}
        if double_sided:
            material["doubleSided"] = True
        self.used_extensions.update(material.get("extensions", {}))
        return self._append("materials", material)

    def add_lambert(self, name: str, color: Vec, **more: Any) -> int:
        """A pure Lambert surface: without KHR_materials_specular, glTF would coat it with a 4% dielectric."""
        return self.add_material(name, color, extensions={"KHR_materials_specular": {"specularFactor": 0}}, **more)

    def add_image(self, file_name: str, data: bytes) -> int:
        """A picture in a file of its own, beside the document."""
        self.files[file_name] = data
        return self._append("images", {"uri": file_name})

    def add_texture(self, image: int, wrap_s: str = "repeat", wrap_t: str = "repeat", nearest: bool = False) -> int:
        mag, mipmapped = (9728, 9984) if nearest else (9729, 9987)
        sampler = {"magFilter": mag, "minFilter": mipmapped, "wrapS": WRAP[wrap_s], "wrapT": WRAP[wrap_t]}
        samplers = self.arrays.setdefault("samplers", [])
        if sampler not in samplers:
            samplers.append(sampler)
        return self._append("textures", {"source": image, "sampler": samplers.index(sampler)})

    def texture_info(self, texture: int, uv_set: int = 0, transform: Optional[dict[str, Any]] = None) -> dict[str, Any]:
        """A material's use of a texture; `transform` is KHR_texture_transform's offset, rotation, scale."""
        info: dict[str, Any] = {"index": texture}
        if uv_set:
            info["texCoord"] = uv_set
        if transform:
            info["extensions"] = {"KHR_texture_transform": transform}
            self.used_extensions.add("KHR_texture_transform")
        return info

    # --- meshes -----------------------------------------------------------------------------------------------------

    def add_mesh(self, name: str, *primitives: tuple[Geometry, int]) -> int:
        """A mesh of (geometry, material) pairs."""
        return self._append("meshes", {"name": name, "primitives": [self._primitive(g, m) for g, m in primitives]})

    def _primitive(self, geometry: Geometry, material: int) -> dict[str, Any]:
        attributes = {"POSITION": self._accessor(geometry.positions, _FLOAT, target=34962, bounds=True)}
        for name, values in (
            ("NORMAL", geometry.normals),
            ("TEXCOORD_0", geometry.uvs),
            ("TEXCOORD_1", geometry.uvs1),
        ):
            if values:
                attributes[name] = self._accessor(values, _FLOAT, target=34962)
        if geometry.colors:
            bytes_of = [[round(min(max(c, 0), 1) * 255) for c in color] for color in geometry.colors]
            attributes["COLOR_0"] = self._accessor(bytes_of, _UINT8, target=34962, normalized=True)
        flat = [(i,) for triangle in geometry.triangles for i in triangle]
        small = len(geometry.positions) < 65535
        indices = self._accessor(flat, _UINT16 if small else _UINT32, target=34963)
        return {"attributes": attributes, "indices": indices, "material": material}

    def _accessor(
        self,
        rows: Sequence[Sequence[float]],
        component: int,
        target: Optional[int] = None,
        normalized: bool = False,
        bounds: bool = False,
    ) -> int:
        """Puts rows of numbers into the buffer, once: equal rows of an equal kind share an accessor."""
        width = len(rows[0])
        packed = b"".join(struct.pack(f"<{width}{_COMPONENT_FORMAT[component]}", *row) for row in rows)
        key = (packed, width, component, target, normalized, bounds)
        if key in self.known_accessors:
            return self.known_accessors[key]
        self.binary.extend(b"\0" * (-len(self.binary) % 4))
        view = {"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(packed)}
        self.binary += packed
        if target:
            view["target"] = target
        accessor: dict[str, Any] = {
            "bufferView": self._append("bufferViews", view),
            "componentType": component,
            "count": len(rows),
            "type": _TYPE_OF_WIDTH[width],
        }
        if normalized:
            accessor["normalized"] = True
        if bounds:
            columns = [[_as_float32(row[i]) for row in rows] for i in range(width)]
            accessor["min"] = [_Exact(min(column)) for column in columns]
            accessor["max"] = [_Exact(max(column)) for column in columns]
        self.known_accessors[key] = self._append("accessors", accessor)
        return self.known_accessors[key]

    # --- nodes, cameras, lights -------------------------------------------------------------------------------------

    def add_node(
        self,
        name: str,
        *,
        translation: Optional[Vec] = None,
        rotation: Optional[Quat] = None,
        scale: Optional[Vec] = None,
        mesh: Optional[int] = None,
        children: Sequence[int] = (),
        **more: Any,
    ) -> int:
        node: dict[str, Any] = {"name": name}
        for key, value in (("translation", translation), ("rotation", rotation), ("scale", scale)):
            if value is not None:
                node[key] = list(value)
        if mesh is not None:
            node["mesh"] = mesh
        if children:
            node["children"] = list(children)
        node.update(more)
        return self._append("nodes", node)

    def add_object(self, name: str, geometry: Geometry, material: int, **placement: Any) -> int:
        """A node with a mesh of its own."""
        return self.add_node(name, mesh=self.add_mesh(name, (geometry, material)), **placement)

    def add_shape(self, kind: str, **parameters: Any) -> int:
        """A sphere, cylinder, box or plane (KHR_implicit_shapes); equal ones are stored once."""
        self.used_extensions.add("KHR_implicit_shapes")
        shape = {"type": kind, kind: parameters}
        if shape not in self.shapes:
            self.shapes.append(shape)
        return self.shapes.index(shape)

    def add_shape_node(self, name: str, shape: int, material: int, **placement: Any) -> int:
        """A node that draws a shape (PARIAN_shape)."""
        self.used_extensions.add("PARIAN_shape")
        extensions = {"PARIAN_shape": {"shape": shape, "material": material}}
        return self.add_node(name, extensions=extensions, **placement)

    def add_instances(
        self,
        name: str,
        mesh: int,
        translations: Sequence[Vec],
        rotations: Sequence[Quat],
        scales: Sequence[Vec],
    ) -> int:
        """A node that draws its mesh once per entry (EXT_mesh_gpu_instancing)."""
        self.used_extensions.add("EXT_mesh_gpu_instancing")
        arrays = {"TRANSLATION": translations, "ROTATION": rotations, "SCALE": scales}
        attributes = {key: self._accessor(rows, _FLOAT) for key, rows in arrays.items()}
        extensions = {"EXT_mesh_gpu_instancing": {"attributes": attributes}}
        return self.add_node(name, mesh=mesh, extensions=extensions)

    def add_camera(
        self,
        eye: Vec,
        target: Optional[Vec] = None,
        *,
        yfov_degrees: float,
        aspect: float,
        name: str = "camera",
        lens: Optional[dict[str, Any]] = None,
    ) -> int:
        """A perspective camera on a node; without a target it looks along -z. `lens` is EXT_camera_physical's
        object."""
        perspective = {"aspectRatio": aspect, "yfov": math.radians(yfov_degrees), "znear": 0.01}
        camera: dict[str, Any] = {"name": name, "type": "perspective", "perspective": perspective}
        if lens:
            self.used_extensions.add("EXT_camera_physical")
            camera["extensions"] = {"EXT_camera_physical": lens}
        turn = look_at(eye, target) if target is not None else None
        return self.add_node(name, translation=eye, rotation=turn, camera=self._append("cameras", camera))

    def add_orthographic_camera(
        self,
        eye: Vec,
        rotation: Quat,
        xmag: float,
        ymag: float,
        name: str = "camera",
        zfar: float = 100,
    ) -> int:
        """xmag and ymag are half of the width and of the height that are seen."""
        orthographic = {"xmag": xmag, "ymag": ymag, "zfar": zfar, "znear": 0.01}
        camera = {"name": name, "type": "orthographic", "orthographic": orthographic}
        return self.add_node(name, translation=eye, rotation=rotation, camera=self._append("cameras", camera))

    def add_punctual_light(
        self,
        kind: str,
        name: str,
        color: Vec,
        intensity: float,
        at: Vec,
        towards: Optional[Vec] = None,
        **more: Any,
    ) -> int:
        """A point, spot or directional light: W/sr, or W/m^2 for the last. A spot's `spot` object goes into `more`."""
        light = {"name": name, "type": kind, "color": color, "intensity": intensity, **more}
        return self._add_light("KHR_lights_punctual", light, at, towards)

    def add_rect_light(
        self,
        name: str,
        color: Vec,
        radiance: float,
        sides: tuple[float, float],
        at: Vec,
        towards: Vec,
    ) -> int:
        """A rectangle of full sides (width, height) that shines to one side."""
        rect = {"aspect": sides[0] / sides[1]}
        light = {"name": name, "type": "rect", "color": color, "intensity": radiance, "size": sides[1], "rect": rect}
        return self._add_light("EXT_lights_area", light, at, towards)

    def add_disk_light(self, name: str, color: Vec, radiance: float, diameter: float, at: Vec, towards: Vec) -> int:
        light = {"name": name, "type": "disk", "color": color, "intensity": radiance, "size": diameter}
        return self._add_light("EXT_lights_area", light, at, towards)

    def _add_light(self, extension: str, light: dict[str, Any], at: Vec, towards: Optional[Vec]) -> int:
        self.used_extensions.add(extension)
        lights = self.light_arrays.setdefault(extension, [])
        lights.append(light)
        turn = look_at(at, towards) if towards is not None else None
        reference = {extension: {"light": len(lights) - 1}}
        return self.add_node(light["name"], translation=at, rotation=turn, extensions=reference)

    def set_environment(self, image: int, intensity: float = 1) -> None:
        self.used_extensions.add("EXT_lights_environment")
        self.environment = {"source": image, "intensity": intensity}

    # --- writing ----------------------------------------------------------------------------------------------------

    def _append(self, array: str, item: dict[str, Any]) -> int:
        items = self.arrays.setdefault(array, [])
        items.append(item)
        return len(items) - 1

    def document(self, buffer_name: str) -> dict[str, Any]:
        nodes = self.arrays["nodes"]
        inner = {child for node in nodes for child in node.get("children", [])}
        scene: dict[str, Any] = {"nodes": [i for i in range(len(nodes)) if i not in inner]}
        extensions: dict[str, Any] = {key: {"lights": lights} for key, lights in self.light_arrays.items()}
        if self.shapes:
            extensions["KHR_implicit_shapes"] = {"shapes": self.shapes}
        if self.environment:
            extensions["EXT_lights_environment"] = {"environments": [self.environment]}
            scene["extensions"] = {"EXT_lights_environment": {"environment": 0}}
        document: dict[str, Any] = {"asset": {"version": "2.0", "generator": "Parian scripts/make_scenes.py"}}
        if self.used_extensions:
            document["extensionsUsed"] = sorted(self.used_extensions)
        if extensions:
            document["extensions"] = extensions
        document.update(scene=0, scenes=[scene], **{key: self.arrays[key] for key in sorted(self.arrays)})
        if self.binary:
            document["buffers"] = [{"uri": buffer_name, "byteLength": len(self.binary)}]
        return document

    def write(self, folder: Path, name: str) -> None:
        """Writes NAME.gltf, NAME.bin and the pictures into the folder."""
        folder.mkdir(parents=True, exist_ok=True)
        document = self.document(f"{name}.bin")
        (folder / f"{name}.gltf").write_text(to_json(document), newline="\n")
        if self.binary:
            (folder / f"{name}.bin").write_bytes(self.binary)
        for file_name, data in self.files.items():
            (folder / file_name).write_bytes(data)


class _Exact(float):
    """A float32 that JSON must give back exactly (an accessor's bounds)."""


def _as_float32(value: float) -> float:
    return struct.unpack("<f", struct.pack("<f", value))[0]


def to_json(value: Any) -> str:
    """JSON with two spaces of indentation, short arrays of numbers on one line, numbers with 7 digits."""
    return _json(value, 0) + "\n"


def _json(value: Any, depth: int) -> str:
    if isinstance(value, bool) or value is None or isinstance(value, str):
        return json.dumps(value)
    if isinstance(value, (int, float)):
        return _number(value)
    inner, outer = "  " * (depth + 1), "  " * depth
    if isinstance(value, dict):
        lines = [f"{inner}{json.dumps(key)}: {_json(item, depth + 1)}" for key, item in value.items()]
        return "{\n" + ",\n".join(lines) + f"\n{outer}}}" if lines else "{}"
    if all(isinstance(item, (int, float)) for item in value):
        return "[" + ", ".join(_number(item) for item in value) + "]"
    return "[\n" + ",\n".join(f"{inner}{_json(item, depth + 1)}" for item in value) + f"\n{outer}]"


def _number(value: float) -> str:
    if isinstance(value, int):
        return str(value)
    text = f"{value:.9g}" if isinstance(value, _Exact) else f"{value:.7g}"
    return "0" if float(text) == 0 else text
