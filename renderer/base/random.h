/// The random sequence: for each pixel a hash-based Owen-scrambled Sobol sequence, or independent numbers to
/// compare with. A number depends on (seed, pixel, sample, dimension) only, so neither threads nor tiles nor
/// a resume change it.
#pragma once

#include <cstdint>
#include <span>

#include "renderer/base/math.h"

namespace parian {

/// Uniform in [0, 1): the top 24 bits, since u32 * 2^-32 rounds up to 1.
inline float to_unit_float(std::uint32_t x) { return float(std::int32_t(x >> 8)) * 0x1p-24f; }

/// A permutation of 32-bit integers whose output bits each depend on all input bits (Chris Wellons,
/// "lowbias32").
inline std::uint32_t hash32(std::uint32_t x) {
  x = (x ^ (x >> 16)) * 0x7feb352du;
  x = (x ^ (x >> 15)) * 0x846ca68bu;
  return x ^ (x >> 16);
}
inline std::uint32_t hash32(std::uint32_t a, std::uint32_t b) { return hash32(a ^ hash32(b + 0x9e3779b9u)); }

inline std::uint32_t reverse_bits(std::uint32_t x) {
  // The bytes by shifts, which vectorize; alone they become one instruction.
  x = (x >> 24) | ((x >> 8) & 0xff00u) | ((x << 8) & 0xff0000u) | (x << 24);
  x = ((x & 0x0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0fu);
  x = ((x & 0x33333333u) << 2) | ((x >> 2) & 0x33333333u);
  return ((x & 0x55555555u) << 1) | ((x >> 1) & 0x55555555u);
}

/// Owen's nested uniform scramble of a bit-reversed integer: bit i flips by a hash of the bits below it
/// (Laine and Karras 2011, with the constants of Nathan Vegdahl, "Building a Better LK Hash", 2021).
inline std::uint32_t scramble_reversed(std::uint32_t x, std::uint32_t seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

/// The bit-reversed second Sobol coordinate of `index`: the polynomial over GF(2) with the bits of index as
/// coefficients, x replaced by x + 1, which is Pascal's triangle modulo 2 (Ahmed 2024, An Implementation
/// Algorithm of 2D Sobol Sequence Fast, Elegant, and Compact).
inline std::uint32_t sobol1_reversed(std::uint32_t index) {
  index ^= index >> 16;
  index ^= (index & 0xff00ff00u) >> 8;
  index ^= (index & 0xf0f0f0f0u) >> 4;
  index ^= (index & 0xccccccccu) >> 2;
  return index ^ ((index & 0xaaaaaaaau) >> 1);
}

/// A point of the (0,2)-sequence of the first two Sobol dimensions, its order shuffled and its coordinates
/// scrambled by hashes of `seed` (Burley 2020, Practical Hash-based Owen Scrambling); by the bit-reversed
/// index.
inline Vec2f scrambled_sobol(std::uint32_t reversed_index, std::uint32_t seed) {
  const std::uint32_t index = reverse_bits(scramble_reversed(reversed_index, seed));
  const std::uint32_t x = scramble_reversed(index, seed * 0x2c1b3c6du + 0x297a2d39u);
  const std::uint32_t y = scramble_reversed(sobol1_reversed(index), seed * 0x6c8e9cf5u + 0x3c6ef372u);
  return {to_unit_float(reverse_bits(x)), to_unit_float(reverse_bits(y))};
}

enum class SamplerKind : std::uint8_t { sobol, independent };

/// The numbers of one camera path, drawn in a fixed order. Each call is a new dimension or pair of
/// dimensions: scrambled_sobol() with its own order and scramble, so 2^k samples of a pixel stratify every
/// pair in all elementary intervals.
class Sampler {
 public:
  Sampler() = default;  // to be assigned
  Sampler(SamplerKind kind, std::uint32_t seed, int x, int y, std::uint32_t sample)
      : Sampler(kind, pixel_key(seed, x, y), sample) {}
  Sampler(SamplerKind kind, std::uint32_t key, std::uint32_t sample)
      : reversed_sample_(reverse_bits(sample)), state_(key), kind_(kind) {}

  /// What the numbers of a pixel depend on, for who asks for many samples of it.
  static std::uint32_t pixel_key(std::uint32_t seed, int x, int y) {
    return hash32(hash32(seed, std::uint32_t(x)), std::uint32_t(y));
  }

  float next1() { return next2().x; }

  Vec2f next2() {
    const std::uint32_t seed = hash32(state_ += kStep);
    if (kind_ == SamplerKind::independent) {
      const std::uint32_t a = hash32(seed ^ hash32(reversed_sample_));
      return {to_unit_float(a), to_unit_float(hash32(a + 0x85ebca6bu))};
    }
    return scrambled_sobol(reversed_sample_, seed);
  }

  /// A number that is not stratified over the samples of a pixel, for decisions that gain nothing from it.
  float next_independent() { return to_unit_float(hash32((state_ += kStep) ^ reversed_sample_)); }

  /// What names this place of the sequence, for choices inside a ray query, which have no dimension of their
  /// own: to be hashed with what is chosen.
  std::uint32_t key() const { return state_ ^ reversed_sample_; }

 private:
  friend void next2_twice(std::span<Sampler* const> samplers, Vec2f* first, Vec2f* second);
  static constexpr std::uint32_t kStep = 0x9e3779b9u;

  std::uint32_t reversed_sample_, state_;
  SamplerKind kind_;
};

/// next2(), and next2() again, of each of the samplers, which are of one kind: side by side. With AVX2, 8 or
/// 16 Sobol samplers cost a third (9 ns each instead of 27); without it the same as one by one.
void next2_twice(std::span<Sampler* const> samplers, Vec2f* first, Vec2f* second);

}  // namespace parian
