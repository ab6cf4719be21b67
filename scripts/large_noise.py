"""Gradient noise on grids, and pictures made of it; needs numpy."""

from typing import Optional

import numpy as np

from image_files import png_of_bytes

SIDE = 2048  # texels, of the pictures


def hashed(x: np.ndarray, y: np.ndarray, seed: int) -> np.ndarray:
    """32 bits that look random for each pair of integers."""
    salt = np.uint32(seed * 0xC2B2AE3D & 0xFFFFFFFF)
    h = x.astype(np.uint32) * np.uint32(0x9E3779B1) ^ y.astype(np.uint32) * np.uint32(0x85EBCA77) ^ salt
    for shift, factor in ((15, 0x2C1B3C6D), (12, 0x297A2D39), (15, 1)):
        h = (h ^ h >> np.uint32(shift)) * np.uint32(factor)
    return h


def fade(t: np.ndarray) -> np.ndarray:
    return t * t * t * (t * (t * 6 - 15) + 10)


def noise(xs: np.ndarray, ys: np.ndarray, seed: int, period: Optional[int] = None) -> np.ndarray:
    """Perlin's, in [-0.71, 0.71], for the rows ys and columns xs of a grid; with a period it repeats. Along y it is
    interpolated for the lattice's columns alone, of which there are few, so that most of the work is along x."""
    ix, iy = np.floor(xs).astype(np.int64), np.floor(ys).astype(np.int64)
    fx, fy = (xs - ix).astype(np.float32), (ys - iy).astype(np.float32)[:, None]
    columns, rows = np.arange(ix.min(), ix.max() + 2), np.arange(iy.min(), iy.max() + 2)
    wrapped = (columns % period, rows % period) if period else (columns, rows)
    angle = hashed(wrapped[0][None, :], wrapped[1][:, None], seed) * np.float32(2 * np.pi / 2**32)
    gx, gy = np.cos(angle), np.sin(angle)
    r, c, v, u = iy - rows[0], ix - columns[0], fade(fy), fade(fx)
    slope = gx[r] + v * (gx[r + 1] - gx[r])
    near, far = gy[r] * fy, gy[r + 1] * (fy - 1)
    value = near + v * (far - near)
    left = np.take(slope, c, 1) * fx + np.take(value, c, 1)
    right = np.take(slope, c + 1, 1) * (fx - 1) + np.take(value, c + 1, 1)
    return left + u * (right - left)


def fractal(xs: np.ndarray, ys: np.ndarray, seed: int, octaves: int, period: Optional[int] = None) -> np.ndarray:
    """A sum of noises, each of twice the frequency and half the height of the one before."""
    total = np.zeros((len(ys), len(xs)), np.float32)
    for i in range(octaves):
        total += noise(xs * 2**i, ys * 2**i, seed + i, period * 2**i if period else None) * np.float32(0.5**i)
    return total


def to_srgb(linear: np.ndarray) -> np.ndarray:
    """The bytes that a colour texture stores."""
    linear = np.clip(linear, 0, 1)
    curve = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    return (curve * 255 + 0.5).astype(np.uint8)


def png_of(pixels: np.ndarray) -> bytes:
    height, width, channels = pixels.shape
    return png_of_bytes(width, height, channels, pixels.tobytes(), 3)


def texel_centres() -> np.ndarray:
    return (np.arange(SIDE) + 0.5) / SIDE


def mottled(low: tuple[float, float, float], high: tuple[float, float, float], seed: int = 5) -> bytes:
    """A PNG that repeats: spots of colours from low to high."""
    at = texel_centres() * 8
    mix = np.clip(0.5 + fractal(at, at, seed, 7, 8), 0, 1)[..., None]
    return png_of(to_srgb(np.array(low) + mix * (np.array(high) - np.array(low))))


def bumps(steepness: float, seed: int = 9) -> bytes:
    """A normal map that repeats."""
    at = texel_centres() * 16
    height = fractal(at, at, seed, 6, 16) * (SIDE / 16)
    dx, dy = ((np.roll(height, -1, axis) - np.roll(height, 1, axis)) * (steepness / 2) for axis in (1, 0))
    normal = np.stack([-dx, dy, np.ones_like(dx)], -1)  # v grows downwards, the map's y upwards
    normal /= np.sqrt((normal * normal).sum(-1, keepdims=True))
    return png_of(((normal * 0.5 + 0.5) * 255 + 0.5).astype(np.uint8))
