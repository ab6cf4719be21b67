#!/usr/bin/env python3
"""Writes materials/albedo_tables.inc, the tables of directional albedo that materials/albedo.h reads.

usage: make_albedo_tables.py [OUT]          (needs numpy; a minute)

GGX with Smith's height-correlated masking, for a reflectance of 1: the share of light that is lost, L = 1 - E(mu), and
the share B(mu) that Schlick's weight (1 - wo.h)^5 takes of E. By quadrature over the facets seen from wo (spherical
caps, Dupuy and Benyoub 2023), each of which reflects G2 / G1. E is far from a function of mu alone where mu is about
alpha, for any alpha; hence the columns are even in

  t = mu (1 + k) / (mu + k),  k = alpha / (2 (1 + 2 alpha^2)),

the rows are even in r = sqrt(alpha), and B, which is steep, is written by what it is nearly: with S = B / E,

  S^(1/5) = 1 - mu - r^1.5 Q.

The nodes of L and Q are not samples but the bilinear function nearest to the truth, about in the maximum norm. The
averages 2 integral of L mu dmu (divided by alpha) and of B are those of the tables as they are read, so that what is
lost on average is what the furnace loses.

Charlie sheen (Estevez and Kulla 2017): E(mu), the rows even in alpha^(1/4), the columns in mu^(1/4), down to
mu = 1e-4: the fitted masking is finite at the horizon, so that E grows without bound there.
"""

import functools
import multiprocessing
import os
import sys

import numpy as np

# The same in materials/albedo.h.
GGX_ROWS, GGX_COLUMNS, GGX_AVERAGES = 32, 48, 125
R_LOW = 0.01
LOSS_SCALE, Q_LOW, Q_HIGH, LOSS_AVERAGE_SCALE, B_AVERAGE_SCALE = 1.0, -1.0, 1.4, 1.0, 0.05
SHEEN_ROWS, SHEEN_COLUMNS = 40, 48
SHEEN_U_LOW, SHEEN_T_LOW, SHEEN_SCALE = 0.07**0.5, 0.1, 3.0


@functools.lru_cache(None)
def gauss(n):
    x, w = np.polynomial.legendre.leggauss(n)
    return 0.5 * (x + 1), 0.5 * w


def ggx(mu, alpha, n=64):
    """L and B; see above."""
    phi = np.pi * (np.arange(n) + 0.5) / n  # half a turn: the other half mirrors it
    x, w = gauss(4 * n)  # a step where reflections leave for below the horizon
    v, w = 1 - (1 - x) ** 2, 2 * w * (1 - x)  # denser where facets are steep
    sine = np.sqrt(max(0.0, 1 - mu * mu))
    length = np.hypot(sine * alpha, mu)
    wx, wz = sine * alpha / length, mu / length
    z = (1 - v) * (1 + wz) - wz
    r = np.sqrt(np.clip(1 - z * z, 0, 1))
    cx, cy = (r * np.cos(phi)[:, None] + wx) * alpha, r * np.sin(phi)[:, None] * alpha
    cz = np.maximum(z + wz, 1e-300)
    scale = 1 / np.sqrt(cx * cx + cy * cy + cz * cz)
    hx, hz = cx * scale, cz * scale
    cosine = sine * hx + mu * hz
    out = 2 * cosine * hz - mu
    up = np.maximum(out, 1e-12)
    smith = lambda c: 0.5 * (np.sqrt(1 + alpha * alpha * (1 - c * c) / (c * c)) - 1)
    whole = 1 + smith(mu) + smith(up)
    loss = np.where(out > 0, smith(up) / whole, 1)
    weight = np.clip(1 - cosine, 0, 1) ** 5
    return (loss.mean(0) * w).sum(), (((1 - loss) * weight).mean(0) * w).sum()


def sheen(mu, alpha, n=128):
    """E, of colour 1; the constants are in materials/sheen.h too."""
    rough = np.array([21.5473, 3.82987, 0.19823, -1.97760, -4.32054])
    smooth = np.array([25.3245, 3.32435, 0.16801, -1.27393, -4.85967])
    a, b, c, d, e = rough + (smooth - rough) * (1 - alpha) ** 2
    curve = lambda x: a / (1 + b * x**c) + d * x + e
    masking = lambda x: np.exp(
        np.where(x < 0.5, curve(np.minimum(x, 0.5)), 2 * curve(0.5) - curve(np.minimum(1 - x, 0.5)))
    )
    phi = np.pi * (np.arange(n) + 0.5)[:, None] / n
    x, w = gauss(n)
    mi, w = x**3, 3 * w * x * x  # denser at the horizon
    so, si = np.sqrt(1 - mu * mu), np.sqrt(1 - mi * mi)
    across2 = (so + si * np.cos(phi)) ** 2 + (si * np.sin(phi)) ** 2
    sine2 = across2 / (across2 + (mu + mi) ** 2)
    d_charlie = (2 + 1 / alpha) * sine2 ** (0.5 / alpha) / (2 * np.pi)
    value = d_charlie / ((1 + masking(np.array(mu)) + masking(mi)) * 4 * mu)
    return (value.mean(0) * w).sum() * 2 * np.pi


def warp_constant(alpha):
    return 0.5 * alpha / (1 + 2 * alpha * alpha)


def column(mu, alpha):
    k = warp_constant(alpha)
    return mu * (1 + k) / (mu + k)


def cell(x, nodes):
    """Index of the node below x in [0, 1], and how far x is on the way to the next."""
    y = np.clip(x, 0, 1) * (nodes - 1)
    i = np.minimum(y.astype(int), nodes - 2)
    return i, y - i


def corners(u, v, rows, columns):
    """The four nodes around (u, v), as indices into a table, and their bilinear weights."""
    (i, fi), (j, fj) = cell(u, rows), cell(v, columns)
    index = np.stack([i * columns + j, i * columns + j + 1, (i + 1) * columns + j, (i + 1) * columns + j + 1])
    return index, np.stack([(1 - fi) * (1 - fj), (1 - fi) * fj, fi * (1 - fj), fi * fj])


def fit(index, weights, nodes, truth, importance):
    """Values at the nodes that interpolate truth best: least squares, the largest errors weighed more and more."""
    emphasis = np.array(importance)
    for _ in range(6):
        matrix = np.zeros(nodes * nodes)
        right = np.zeros(nodes)
        for p in range(4):
            right += np.bincount(index[p], emphasis**2 * weights[p] * truth, nodes)
            for q in range(4):
                matrix += np.bincount(
                    index[p] * nodes + index[q], emphasis**2 * weights[p] * weights[q], nodes * nodes
                )
        matrix = matrix.reshape(nodes, nodes) + 1e-9 * np.eye(nodes)
        values = np.linalg.solve(matrix, right)
        error = np.abs((values[index] * weights).sum(0) - truth) * importance
        emphasis = emphasis * (1 + error / error.max())
    return values


def quantised(values, low, high):
    return np.rint(np.clip((values - low) / (high - low), 0, 1) * 65535).astype(int)


def ggx_point(point):
    return ggx(*point)


def sheen_point(point):
    return sheen(*point)


def make_ggx(pool):
    points = []
    for r in np.linspace(R_LOW, 1, 3 * (GGX_ROWS - 1) + 1):
        alpha, k = r * r, warp_constant(r * r)
        t = np.linspace(0, 1, 3 * (GGX_COLUMNS - 1) + 1)[1:]
        mu = np.concatenate([t * k / (1 + k - t), np.linspace(0.02, 0.98, 33)])
        mu = np.concatenate([mu, mu.min() * np.array([0.01, 0.1, 0.4])])
        points += [(m, alpha) for m in mu]
    loss, b = np.array(pool.map(ggx_point, points, chunksize=32)).T
    mu, alpha = np.array(points).T
    r = np.sqrt(alpha)
    index, weights = corners((r - R_LOW) / (1 - R_LOW), column(mu, alpha), GGX_ROWS, GGX_COLUMNS)
    nodes = GGX_ROWS * GGX_COLUMNS
    s = np.clip(b / (1 - loss), 0, 1)
    # What is lost matters by its share, too: the importance of small losses is up to 4 times larger.
    loss_nodes = fit(index, weights, nodes, loss, 1 / np.sqrt(0.07 + loss))
    # An error of Q is one of B times this; the rest only keeps Q in range where B is nearly 0.
    steepness = (5 * s**0.8 + 1e-3) * r**1.5
    q_nodes = fit(index, weights, nodes, (1 - mu - s**0.2) / r**1.5, steepness)
    table = np.stack([quantised(loss_nodes, 0, LOSS_SCALE), quantised(q_nodes, Q_LOW, Q_HIGH)], axis=-1)

    def read(mu, alpha):
        index, weights = corners(
            (np.sqrt(alpha) - R_LOW) / (1 - R_LOW), column(mu, alpha), GGX_ROWS, GGX_COLUMNS
        )
        loss, q = [(table[:, k][index] * weights).sum(0) / 65535 for k in (0, 1)]
        loss = loss * LOSS_SCALE
        root = 1 - mu - alpha**0.75 * (Q_LOW + (Q_HIGH - Q_LOW) * q)
        return loss, (1 - loss) * np.clip(root, 0, 1) ** 5

    read_loss, read_b = read(mu, alpha)
    print(f"ggx: L off by {np.abs(read_loss - loss).max():.1e}, B by {np.abs(read_b - b).max():.1e}, "
          f"Q in [{q_nodes.min():.2f}, {q_nodes.max():.2f}]")  # fmt: skip

    x, w = gauss(4000)
    x, w = x**3, 3 * w * x * x
    averages = []
    for r in np.linspace(R_LOW, 1, GGX_AVERAGES):
        loss, b = read(x, np.full(len(x), r * r))
        averages.append([2 * (loss * x * w).sum() / (r * r), 2 * (b * x * w).sum()])
    averages = np.array(averages)
    print(f"average L / alpha in [{averages[:, 0].min():.3f}, {averages[:, 0].max():.3f}], "
          f"B in [{averages[:, 1].min():.4f}, {averages[:, 1].max():.4f}]")  # fmt: skip
    return table, np.stack([quantised(averages[:, 0], 0, LOSS_AVERAGE_SCALE),
                            quantised(averages[:, 1], 0, B_AVERAGE_SCALE)], axis=-1)  # fmt: skip


def make_sheen(pool):
    t = np.linspace(SHEEN_T_LOW, 1, 3 * (SHEEN_COLUMNS - 1) + 1)
    rows = np.linspace(SHEEN_U_LOW, 1, 3 * (SHEEN_ROWS - 1) + 1)
    points = [(x**4, u**4) for u in rows for x in t]
    e = np.array(pool.map(sheen_point, points, chunksize=32))
    mu, alpha = np.array(points).T
    index, weights = corners(
        (alpha**0.25 - SHEEN_U_LOW) / (1 - SHEEN_U_LOW),
        (mu**0.25 - SHEEN_T_LOW) / (1 - SHEEN_T_LOW),
        SHEEN_ROWS,
        SHEEN_COLUMNS,
    )
    table = quantised(
        fit(index, weights, SHEEN_ROWS * SHEEN_COLUMNS, e, 1 / (0.1 + e)), 0, SHEEN_SCALE
    )
    error = np.abs((table[index] * weights).sum(0) / 65535 * SHEEN_SCALE - e)
    print(f"sheen: off by {error.max():.1e}, for mu above .02 by {error[mu > 0.02].max():.1e}, E up to {e.max():.3f}")
    return table


def array(declaration, values):
    words, lines, line = [str(v) for v in values.ravel()], [], ""
    for word in words:
        if len(line) + len(word) + 1 > 110:
            lines.append(line)
            line = ""
        line += word + ","
    body = "\n".join(lines + [line])
    return f"{declaration} = {{\n{body}\n}};\n"


def main(path):
    with multiprocessing.Pool() as pool:
        table, averages = make_ggx(pool)
        sheen_table = make_sheen(pool)
    with open(path, "w", encoding="ascii") as file:
        file.write("// Written by scripts/make_albedo_tables.py, which says what is in here.\n")
        file.write(array("const GgxNode kGgx[kGgxRows * kGgxColumns]", table))
        file.write(array("constexpr GgxAverage kGgxAverages[kGgxAverageRows]", averages))
        file.write(array("const std::uint16_t kSheen[kSheenRows * kSheenColumns]", sheen_table))


if __name__ == "__main__":
    if len(sys.argv) > 2:
        sys.exit("usage: make_albedo_tables.py [OUT]")
    root = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")
    main(sys.argv[1] if len(sys.argv) == 2 else os.path.join(root, "materials", "albedo_tables.inc"))
