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

A rough interface between dielectrics, reflection and refraction together: what is lost of it, 1 - E(mu), for an index
eta of the far side over the near side above 1 and below it: two tables, for there is a step between them. Their layers
are even in the logarithm of x = |eta - 1| / (eta + 1), of .005 to .5 (eta 3), the rows in sqrt(alpha), the columns in
t, or, above 1, in its square root.

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
INTERFACE_LAYERS, INTERFACE_ROWS, INTERFACE_COLUMNS = 9, 16, 32
INTERFACE_R_LOW, INTERFACE_X_LOW, INTERFACE_X_HIGH = 0.1, 0.005, 0.5
SHEEN_ROWS, SHEEN_COLUMNS = 40, 48
SHEEN_U_LOW, SHEEN_T_LOW, SHEEN_SCALE = 0.07**0.5, 0.1, 3.0


@functools.lru_cache(None)
def gauss(n):
    x, w = np.polynomial.legendre.leggauss(n)
    return 0.5 * (x + 1), 0.5 * w


def visible_facets(mu, alpha, n):
    """Facets seen from mu: cosine of wo to each, z of each, and the weights of a quadrature."""
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
    return np.clip(sine * hx + mu * hz, 0, 1), hz, w / n


def masked(mu, out, alpha):
    """1 - G2 / G1 of light that leaves at |cosine| out, which is lost where out <= 0."""
    smith = lambda c: 0.5 * (np.sqrt(1 + alpha * alpha * (1 - c * c) / (c * c)) - 1)
    up = np.clip(out, 1e-12, 1)
    return np.where(out > 0, smith(up) / (1 + smith(mu) + smith(up)), 1)


def ggx(mu, alpha, n=64):
    """L and B; see above."""
    cosine, hz, w = visible_facets(mu, alpha, n)
    loss = masked(mu, 2 * cosine * hz - mu, alpha)
    weight = (1 - cosine) ** 5
    return (loss.sum(0) * w).sum(), (((1 - loss) * weight).sum(0) * w).sum()


def interface(mu, alpha, eta, n=32):
    """What is lost of reflection and refraction; Fresnel's equations."""
    c, hz, w = visible_facets(mu, alpha, n)
    q2 = eta * eta - 1 + c * c
    q, p = np.sqrt(np.maximum(q2, 0)), eta * eta * c
    with np.errstate(invalid="ignore"):
        f = np.where(q2 > 0, 0.5 * (((c - q) / (c + q)) ** 2 + ((p - q) / (p + q)) ** 2), 1)
    reflected, refracted = masked(mu, 2 * c * hz - mu, alpha), masked(mu, (mu - (c - q) * hz) / eta, alpha)
    return ((f * reflected + (1 - f) * refracted).sum(0) * w).sum()


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


def corners(coordinates, sizes):
    """The nodes around a place in a table of any dimension, as indices into it, and their multilinear weights."""
    index, weights = [0], [1.0]
    for coordinate, size in zip(coordinates, sizes):
        i, fraction = cell(coordinate, size)
        index = [at * size + i + step for at in index for step in (0, 1)]
        weights = [w * share for w in weights for share in (1 - fraction, fraction)]
    return np.stack(index), np.stack(weights)


def fit(index, weights, nodes, truth, importance):
    """Values at the nodes that interpolate truth best: least squares, the largest errors weighed more and more. By
    conjugate gradients."""
    emphasis, values = np.array(importance), np.zeros(nodes)
    scatter = lambda x: np.bincount(index.ravel(), (weights * x).ravel(), nodes)
    for _ in range(6):
        multiply = lambda x: scatter(emphasis**2 * (x[index] * weights).sum(0)) + 1e-9 * x
        diagonal = np.bincount(index.ravel(), (weights**2 * emphasis**2).ravel(), nodes) + 1e-9
        rest = scatter(emphasis**2 * truth) - multiply(values)
        step, size = np.zeros(nodes), np.inf
        for _ in range(3000):
            before, size = size, rest @ (rest / diagonal)
            if size < 1e-18:
                break
            step = rest / diagonal + size / before * step
            image = multiply(step)
            length = size / (step @ image)
            values, rest = values + length * step, rest - length * image
        error = np.abs((values[index] * weights).sum(0) - truth) * importance
        emphasis = emphasis * (1 + error / error.max())
    return values


def quantised(values, low, high):
    return np.rint(np.clip((values - low) / (high - low), 0, 1) * 65535).astype(int)


def ggx_point(point):
    return ggx(*point)


def interface_point(point):
    return interface(*point)


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
    index, weights = corners(((r - R_LOW) / (1 - R_LOW), column(mu, alpha)), (GGX_ROWS, GGX_COLUMNS))
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
            ((np.sqrt(alpha) - R_LOW) / (1 - R_LOW), column(mu, alpha)), (GGX_ROWS, GGX_COLUMNS)
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


def make_interface(pool, above):
    """The table of eta > 1, or that of eta < 1."""
    points, places = [], []
    for layer in np.linspace(0, 1, 2 * (INTERFACE_LAYERS - 1) + 1):
        x = INTERFACE_X_LOW * (INTERFACE_X_HIGH / INTERFACE_X_LOW) ** layer
        eta = (1 + x) / (1 - x)
        for row in np.linspace(0, 1, 2 * (INTERFACE_ROWS - 1) + 1):
            alpha = (INTERFACE_R_LOW + (1 - INTERFACE_R_LOW) * row) ** 2
            k = warp_constant(alpha)
            t = np.linspace(0, 1, 2 * (INTERFACE_COLUMNS - 1) + 1)[1:]
            t = np.concatenate([t[0] * np.array([0.05, 0.4]), t])
            points += [(m, alpha, eta if above else 1 / eta) for m in t * k / (1 + k - t)]
            places += [(layer, row, c) for c in (np.sqrt(t) if above else t)]
    loss = np.array(pool.map(interface_point, points, chunksize=64))
    sizes = INTERFACE_LAYERS, INTERFACE_ROWS, INTERFACE_COLUMNS
    index, weights = corners(np.array(places).T, sizes)
    table = quantised(fit(index, weights, int(np.prod(sizes)), loss, 1 / np.sqrt(0.2 + loss)), 0, 1)
    error = np.abs((table[index] * weights).sum(0) / 65535 - loss)
    print(f"interface, eta {'above' if above else 'below'} 1: off by {error.max():.1e}, "
          f"{(error**2).mean()**.5:.1e} on average")  # fmt: skip
    return table


def make_sheen(pool):
    t = np.linspace(SHEEN_T_LOW, 1, 3 * (SHEEN_COLUMNS - 1) + 1)
    rows = np.linspace(SHEEN_U_LOW, 1, 3 * (SHEEN_ROWS - 1) + 1)
    points = [(x**4, u**4) for u in rows for x in t]
    e = np.array(pool.map(sheen_point, points, chunksize=32))
    mu, alpha = np.array(points).T
    place = (alpha**0.25 - SHEEN_U_LOW) / (1 - SHEEN_U_LOW), (mu**0.25 - SHEEN_T_LOW) / (1 - SHEEN_T_LOW)
    index, weights = corners(place, (SHEEN_ROWS, SHEEN_COLUMNS))
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
        interfaces = np.concatenate([make_interface(pool, above) for above in (False, True)])
        sheen_table = make_sheen(pool)
    with open(path, "w", encoding="ascii") as file:
        file.write("// Written by scripts/make_albedo_tables.py, which says what is in here.\n")
        file.write(array("const GgxNode kGgx[kGgxRows * kGgxColumns]", table))
        file.write(array("constexpr GgxAverage kGgxAverages[kGgxAverageRows]", averages))
        file.write(array("const std::uint16_t kInterface[2 * kInterfaceLayers * kInterfaceRows * kInterfaceColumns]", interfaces))
        file.write(array("const std::uint16_t kSheen[kSheenRows * kSheenColumns]", sheen_table))


if __name__ == "__main__":
    if len(sys.argv) > 2:
        sys.exit("usage: make_albedo_tables.py [OUT]")
    root = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")
    main(sys.argv[1] if len(sys.argv) == 2 else os.path.join(root, "materials", "albedo_tables.inc"))
