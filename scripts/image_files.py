"""Writes small pictures with nothing but the standard library: PNG (8 bit) and Radiance .hdr (RGBE).

A picture is a function of the texel centre, (u, v) in (0, 1) x (0, 1) with v = 0 at the top row.
"""

import math
import struct
import zlib
from typing import Callable, Sequence

Texel = Sequence[float]
Shader = Callable[[float, float], Texel]


def png(width: int, height: int, channels: int, shader: Shader) -> bytes:
    """An 8-bit PNG of 1 (grey), 3 (RGB) or 4 (RGBA) channels; the shader returns stored values in [0, 1]."""
    pixels = bytearray()
    for y in range(height):
        for x in range(width):
            texel = shader((x + 0.5) / width, (y + 0.5) / height)
            pixels.extend(int(min(max(c, 0.0), 1.0) * 255 + 0.5) for c in texel[:channels])
    return png_of_bytes(width, height, channels, pixels)


def png_of_bytes(width: int, height: int, channels: int, pixels: bytes, effort: int = 9) -> bytes:
    """The same of the stored bytes, row by row; effort: zlib's, 1 to 9."""
    stride = width * channels
    rows = bytearray()
    for begin in range(0, height * stride, stride):
        rows.append(0)  # this row's filter: none
        rows += pixels[begin : begin + stride]
    color_type = {1: 0, 3: 2, 4: 6}[channels]
    header = struct.pack(">IIBBBBB", width, height, 8, color_type, 0, 0, 0)
    chunks = [(b"IHDR", header), (b"IDAT", zlib.compress(bytes(rows), effort)), (b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(_png_chunk(*chunk) for chunk in chunks)


def _png_chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def to_srgb(linear: float) -> float:
    """The sRGB curve: linear light to the value that a colour texture stores."""
    return 12.92 * linear if linear <= 0.0031308 else 1.055 * linear ** (1 / 2.4) - 0.055


def rgbe(color: Texel) -> tuple[int, int, int, int]:
    """Three linear values as mantissas with a shared exponent, rounded to nearest; decoded as m / 256 * 2^(e - 128)."""
    top = max(color)
    if top < 1e-30:
        return 0, 0, 0, 0
    exponent = math.frexp(top)[1]
    scale = math.ldexp(256.0, -exponent)
    if top * scale >= 255.5:
        exponent, scale = exponent + 1, scale / 2
    r, g, b = (int(c * scale + 0.5) for c in color)
    return r, g, b, exponent + 128


def hdr(width: int, height: int, shader: Shader) -> bytes:
    """A Radiance picture of linear values, run-length encoded; 8 <= width < 32768."""
    out = bytearray(f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n".encode())
    for y in range(height):
        texels = [rgbe(shader((x + 0.5) / width, (y + 0.5) / height)) for x in range(width)]
        out += bytes((2, 2, width >> 8, width & 255))
        for channel in range(4):
            out += _run_length([texel[channel] for texel in texels])
    return bytes(out)


def _run_length(values: Sequence[int]) -> bytes:
    """Radiance's encoding of one channel of a row: 128 + n and a value (a run), or n and n values."""
    out, literal = bytearray(), bytearray()

    def flush() -> None:
        for begin in range(0, len(literal), 128):
            part = literal[begin : begin + 128]
            out.append(len(part))
            out.extend(part)
        literal.clear()

    at = 0
    while at < len(values):
        run = 1
        while at + run < len(values) and run < 127 and values[at + run] == values[at]:
            run += 1
        if run >= 4:
            flush()
            out.extend((128 + run, values[at]))
        else:
            literal.extend(values[at : at + run])
        at += run
    flush()
    return bytes(out)


def environment_hdr(width: int, height: int, radiance: Callable[[tuple[float, float, float]], Texel]) -> bytes:
    """An equirectangular map of a function of the direction, as EXT_lights_environment lays it out: the centre is
    +x, u grows towards +z, the top row is +y."""

    def shader(u: float, v: float) -> Texel:
        phi, theta = 2 * math.pi * (u - 0.5), math.pi * v
        return radiance((math.sin(theta) * math.cos(phi), math.cos(theta), math.sin(theta) * math.sin(phi)))

    return hdr(width, height, shader)
