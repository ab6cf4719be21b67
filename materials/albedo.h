/// Directional albedos, by tables that scripts/make_albedo_tables.py makes: the share of the light from (or
/// to) a direction that a lobe reflects, integral of f cos over the hemisphere, as a function of mu, the
/// cosine of the direction to the normal, in (0, 1].
#pragma once

#include <cstdint>

#include "renderer/base/math.h"

namespace parian {

/// The albedo of GGX with height-correlated masking and Schlick's reflectance is f0 a + f90 b.
struct GgxAlbedo {
  float a, b;
  float loss;  // 1 - a - b, what single scattering loses of a reflectance of 1; without cancellation
};

namespace albedo_tables {

// The same in scripts/make_albedo_tables.py.
inline constexpr int kGgxRows = 32, kGgxColumns = 48;
inline constexpr float kQLow = -1, kQHigh = 1.4f;
inline constexpr int kInterfaceLayers = 9, kInterfaceRows = 16, kInterfaceColumns = 32;
inline constexpr int kSheenRows = 40, kSheenColumns = 48;

struct GgxNode {
  std::uint16_t loss, q;
};
extern const GgxNode kGgx[kGgxRows * kGgxColumns];
extern const std::uint16_t kInterface[2 * kInterfaceLayers * kInterfaceRows * kInterfaceColumns];
extern const std::uint16_t kSheen[kSheenRows * kSheenColumns];

/// A place between two of `nodes` that are even in [0, 1].
struct Cell {
  int i;
  float fraction;
};
inline Cell cell(float x, int nodes) {
  const float y = std::clamp(x, 0.0f, 1.0f) * float(nodes - 1);
  const int i = std::min(int(y), nodes - 2);
  return {i, y - float(i)};
}

}  // namespace albedo_tables

/// What a lookup in the table of GGX needs of the roughness, and the averages over the hemisphere, 2 integral
/// of x(mu) mu dmu. Made once for a surface.
struct GgxAlbedoRow {
  float average_a, average_b, average_loss;

  /// alpha in [1e-4, 1]; what is outside is clamped.
  static GgxAlbedoRow make(float alpha);

  /// At mu in [0, 1]. The largest error is 6e-4 of loss and 5e-4 of b.
  GgxAlbedo at(float mu) const {
    using namespace albedo_tables;
    // The columns are even in mu (1 + k) / (mu + k): they are dense where mu is about alpha.
    const Cell column = cell(mu * (1 + k_) / (mu + k_), kGgxColumns);
    const GgxNode* const n = row_ + column.i;
    const float v = column.fraction, w11 = fraction_ * v, w10 = fraction_ - w11, w01 = v - w11,
                w00 = 1 - fraction_ - w01;
    const float loss = (w00 * float(n[0].loss) + w01 * float(n[1].loss) + w10 * float(n[kGgxColumns].loss) +
                        w11 * float(n[kGgxColumns + 1].loss)) *
                       (1 / 65535.0f);
    const float q = w00 * float(n[0].q) + w01 * float(n[1].q) + w10 * float(n[kGgxColumns].q) +
                    w11 * float(n[kGgxColumns + 1].q);
    // (b / (1 - loss))^(1/5) is nearly 1 - mu; q is what is missing.
    const float root = std::clamp(1 - mu - (q_offset_ + q_scale_ * q), 0.0f, 1.0f), root2 = root * root;
    const float b = (1 - loss) * (root2 * root2 * root);
    return {1 - loss - b, b, loss};
  }

 private:
  GgxAlbedoRow() = default;
  const albedo_tables::GgxNode* row_;
  float fraction_, k_, q_offset_, q_scale_;
};

/// Directional albedo of GGX; for more than one direction, make a GgxAlbedoRow.
inline GgxAlbedo ggx_albedo(float mu, float alpha) { return GgxAlbedoRow::make(alpha).at(mu); }

/// What facets between dielectrics lose of all that they reflect and refract by exact Fresnel reflectance, in
/// single scattering with height-correlated masking: as a function of roughness and index. Made once for a
/// surface.
class InterfaceAlbedoRow {
 public:
  /// alpha in [1e-4, 1]. eta: index of the far side over that of the near side; beyond [1/3, 3], and where it
  /// is within 1% of 1, the nearest in the table is taken.
  static InterfaceAlbedoRow make(float alpha, float eta);

  /// The share that is lost at mu in [0, 1]; off by .01 at most, .002 on average.
  float loss(float mu) const {
    using namespace albedo_tables;
    const float t = mu * (1 + k_) / (mu + k_);
    const Cell column = cell(above_ ? std::sqrt(t) : t, kInterfaceColumns);
    const auto at = [&](const std::uint16_t* n) {
      return float(n[0]) + (float(n[1]) - float(n[0])) * column.fraction;
    };
    constexpr int kLayer = kInterfaceRows * kInterfaceColumns;
    const std::uint16_t* const n = first_ + column.i;
    const float low = at(n) + (at(n + kInterfaceColumns) - at(n)) * row_fraction_;
    const float high = at(n + kLayer) + (at(n + kLayer + kInterfaceColumns) - at(n + kLayer)) * row_fraction_;
    return (low + (high - low) * layer_fraction_) * (1 / 65535.0f);
  }

 private:
  InterfaceAlbedoRow() = default;
  const std::uint16_t* first_;
  float layer_fraction_, row_fraction_, k_;
  bool above_;
};

/// Directional albedo of the Charlie sheen of materials/sheen.h with colour 1; above 1 at grazing angles for
/// small alpha, as the model is. alpha is clamped to what Sheen takes. Off by less than 2e-3 for mu above
/// .02.
float sheen_albedo(float mu, float alpha);

}  // namespace parian
