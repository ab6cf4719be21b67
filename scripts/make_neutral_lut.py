#!/usr/bin/env python3
"""Writes Khronos PBR Neutral, the reference tone mapper of glTF, as a transform file for OpenColorIO.

usage: make_neutral_lut.py OUT.ctf

The specification (https://github.com/KhronosGroup/ToneMapping, PBR_Neutral) maps linear Rec.709 c to

  x = min(c);  f = x - x^2 / (4 F) for x <= 2 F, else F;  p = max(c - f)
  c' = c - f                                        for p <= K
  c' = (c - f) (T / p) g + T (1 - g)                for p > K
  T = 1 - (1 - K)^2 / (p + 1 - 2 K);  g = 1 / (D (p - T) + 1);  F = 0.04, K = 0.76, D = 0.15

A 3D LUT of it is off by more than 2/255 even with 65^3 nodes, for the knee at K is sharp. But the mapping keeps hue,
and in hue, saturation S = (max - min) / max, value V = max it falls apart into curves of one variable. With m = V - S V
the least channel, C = S V, and m1(m) = m - f(m):

  V1 = C + m1(m);   S' = C g(V1) / V1;   V' = T(V1)        (T(v) = v and g(v) = 1 for v <= K)

Products become sums of logarithms, and -log S' = log(V1 / g(V1)) - log C grows strictly with V1, so that one channel
can carry V1 on to T. Hence three 1D LUTs, over log2 from 2^LOW to 2^HIGH, with matrices between them.
"""

import math
import sys

F, K, D = 0.04, 0.8 - 0.04, 0.15
LOW, HIGH, NODES = -20, 16, 2048


def lowered(m):
    return m * m / (4 * F) if m <= 2 * F else m - F


def tone(v):
    return v if v <= K else 1 - (1 - K) ** 2 / (v + 1 - 2 * K)


def desaturation(v):
    return 1 / (D * (v - tone(v)) + 1)


def least(v):
    return v / desaturation(v)


def inverse(function, y):
    """x with function(x) = y, for a growing function with function(x) >= x / 2; by bisection."""
    low, high = 0.0, 2 * y + 1
    for _ in range(200):
        middle = (low + high) / 2
        if function(middle) < y:
            low = middle
        else:
            high = middle
    return high


def number(value):
    return format(value, ".9g")


def matrix(rows, offsets=(0, 0, 0)):
    lines = "\n".join(" ".join(number(v) for v in (*row, offset)) for row, offset in zip(rows, offsets))
    return f'<Matrix inBitDepth="32f" outBitDepth="32f"><Array dim="3 4 3">\n{lines}\n</Array></Matrix>'


def scaled(scale, offset):
    """The same affine map of all three channels."""
    return matrix([[scale if i == j else 0 for j in range(3)] for i in range(3)], (offset,) * 3)


def log(style):
    return f'<Log inBitDepth="32f" outBitDepth="32f" style="{style}"/>'


def fixed(style):
    return f'<FixedFunction inBitDepth="32f" outBitDepth="32f" style="{style}"/>'


def lut(curve, low, high):
    """The third channel goes through curve (of log2 to log2), over [low, high] to [LOW, HIGH]; the others stay."""
    lines = []
    for i in range(NODES):
        t = i / (NODES - 1)
        y = (curve(low + t * (high - low)) - LOW) / (HIGH - LOW)
        lines.append(f"{number(t)} {number(t)} {number(y)}")
    body = "\n".join(lines)
    return f'<LUT1D inBitDepth="32f" outBitDepth="32f" interpolation="linear"><Array dim="{NODES} 3">\n{body}\n</Array></LUT1D>'


def in_logs(function):
    """function as a map of log2 to log2, bounded below by LOW."""
    return lambda x: math.log2(max(function(2.0**x), 2.0**LOW))


def main(path):
    into_unit = scaled(1 / (HIGH - LOW), -LOW / (HIGH - LOW))
    out_of_unit = scaled(HIGH - LOW, LOW)
    # V1 / g(V1) grows like V1^2: half its logarithm fits the range of V1's own.
    half_least = lambda x: 0.5 * in_logs(least)(x)
    steps = [
        '<Range inBitDepth="32f" outBitDepth="32f"><minInValue>0</minInValue><maxInValue>65504</maxInValue>'
        "<minOutValue>0</minOutValue><maxOutValue>65504</maxOutValue></Range>",
        fixed("RGB_TO_HSV"),
        # H, S, V -> H, C = S V, m = V - C
        log("log2"),
        matrix([[1, 0, 0], [0, 1, 1], [0, 0, 1]]),
        log("antiLog2"),
        matrix([[1, 0, 0], [0, 1, 0], [0, -1, 1]]),
        # m -> m1
        log("log2"),
        into_unit,
        lut(in_logs(lowered), LOW, HIGH),
        out_of_unit,
        log("antiLog2"),
        # H, C, V1 = C + m1
        matrix([[1, 0, 0], [0, 1, 0], [0, 1, 1]]),
        # V1 -> V1 / g(V1), as half its logarithm
        log("log2"),
        into_unit,
        lut(half_least, LOW, HIGH),
        out_of_unit,
        # log S' = log C - log(V1 / g(V1))
        matrix([[1, 0, 0], [0, 1, -2], [0, 0, 1]]),
        # V1 / g(V1) -> T(V1)
        into_unit,
        lut(lambda x: math.log2(max(tone(inverse(least, 2.0 ** (2 * x))), 2.0**LOW)), LOW, HIGH),
        out_of_unit,
        log("antiLog2"),
        fixed("HSV_TO_RGB"),
    ]
    with open(path, "w", encoding="ascii") as file:
        file.write('<?xml version="1.0" encoding="UTF-8"?>\n<ProcessList id="khronos-pbr-neutral" version="2.0">\n')
        file.write("<Description>Khronos PBR Neutral, linear Rec.709 to linear Rec.709</Description>\n")
        file.write("\n".join(steps))
        file.write("\n</ProcessList>\n")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: make_neutral_lut.py OUT.ctf")
    main(sys.argv[1])
