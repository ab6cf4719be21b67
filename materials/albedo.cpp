#include "materials/albedo.h"

namespace parian {
namespace albedo_tables {
namespace {

constexpr int kGgxAverageRows = 125;
/// 2 integral of L mu dmu over alpha, and of B.
struct GgxAverage {
  std::uint16_t loss, b;
};

}  // namespace

#include "materials/albedo_tables.inc"

}  // namespace albedo_tables

namespace {

// The same in scripts/make_albedo_tables.py.
constexpr float kGgxLeastRoot = 0.01f, kLossAverageScale = 1, kBAverageScale = 0.05f;
constexpr float kInterfaceLeastRoot = 0.1f, kInterfaceLeastX = 0.005f, kInterfaceMostX = 0.5f;
constexpr float kSheenLeastRow = 0.264575131f, kSheenLeastColumn = 0.1f, kSheenScale = 3;
constexpr float kUnit = 1 / 65535.0f;

float mix(float a, float b, float t) { return a + (b - a) * t; }

/// The columns are even in mu (1 + k) / (mu + k): they are dense where mu is about alpha.
float warp_constant(float alpha) { return 0.5f * alpha / (1 + 2 * alpha * alpha); }

}  // namespace

GgxAlbedoRow GgxAlbedoRow::make(float alpha) {
  using namespace albedo_tables;
  const float root = std::sqrt(std::clamp(alpha, kGgxLeastRoot * kGgxLeastRoot, 1.0f)), a = root * root;
  const float u = (root - kGgxLeastRoot) / (1 - kGgxLeastRoot);
  const Cell c = cell(u, kGgxRows), m = cell(u, kGgxAverageRows);
  const GgxAverage low = kGgxAverages[m.i], high = kGgxAverages[m.i + 1];
  GgxAlbedoRow row;
  row.average_loss = mix(low.loss, high.loss, m.fraction) * (kUnit * kLossAverageScale) * a;
  row.average_b = mix(low.b, high.b, m.fraction) * (kUnit * kBAverageScale);
  row.average_a = 1 - row.average_loss - row.average_b;
  row.row_ = kGgx + c.i * kGgxColumns;
  row.fraction_ = c.fraction;
  row.k_ = warp_constant(a);
  const float scale = root * std::sqrt(root);  // r^1.5
  row.q_offset_ = scale * kQLow;
  row.q_scale_ = scale * (kQHigh - kQLow) * kUnit;
  return row;
}

InterfaceAlbedoRow InterfaceAlbedoRow::make(float alpha, float eta) {
  using namespace albedo_tables;
  const float root = std::sqrt(alpha);
  const Cell r = cell((root - kInterfaceLeastRoot) / (1 - kInterfaceLeastRoot), kInterfaceRows);
  const float x = std::clamp(std::abs(eta - 1) / (eta + 1), kInterfaceLeastX, kInterfaceMostX);
  static const float kLayersPerLog = 1 / std::log(kInterfaceMostX / kInterfaceLeastX);
  const Cell l = cell(std::log(x / kInterfaceLeastX) * kLayersPerLog, kInterfaceLayers);
  InterfaceAlbedoRow row;
  row.above_ = eta > 1;
  row.first_ =
      kInterface + ((int(row.above_) * kInterfaceLayers + l.i) * kInterfaceRows + r.i) * kInterfaceColumns;
  row.layer_fraction_ = l.fraction;
  row.row_fraction_ = r.fraction;
  row.k_ = warp_constant(alpha);  // below the least row losses go by mu / alpha
  return row;
}

float sheen_albedo(float mu, float alpha) {
  using namespace albedo_tables;
  const Cell r = cell((std::sqrt(std::sqrt(alpha)) - kSheenLeastRow) / (1 - kSheenLeastRow), kSheenRows);
  const Cell c =
      cell((std::sqrt(std::sqrt(mu)) - kSheenLeastColumn) / (1 - kSheenLeastColumn), kSheenColumns);
  const std::uint16_t* const n = kSheen + r.i * kSheenColumns + c.i;
  return (kUnit * kSheenScale) * mix(mix(n[0], n[1], c.fraction),
                                     mix(n[kSheenColumns], n[kSheenColumns + 1], c.fraction), r.fraction);
}

}  // namespace parian
