#include "apps/command_line/compare_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace parian {
namespace {

using Json = nlohmann::ordered_json;

const char* name_of(VarianceFrom variance) {
  switch (variance) {
    case VarianceFrom::test:
      return "test";
    case VarianceFrom::reference:
      return "reference";
    case VarianceFrom::both:
      break;
  }
  return "both";
}

std::string text_of(const LayerReport& layer) {
  std::string text =
      fmt::format("{:<11}RMSE {:.6g}, relMSE {:.6g}", layer.name, layer.rmse, layer.relative_mse);
  if (layer.psnr) text += fmt::format(", PSNR {:.2f} dB", *layer.psnr);
  if (const NotFinite& n = layer.not_finite; n.pixels > 0)
    text += fmt::format(
        "\n           {} pixels are not finite, {} of the test and {} of the reference: there is no mean",
        n.pixels, n.test, n.reference);
  const LargestDifference& largest = layer.largest;
  text += fmt::format("\n           largest difference {:.6g}, of {} at ({}, {})\n", largest.difference,
                      largest.channel, largest.x, largest.y);
  for (const ChannelDifference& c : layer.channels)
    text += fmt::format("  {:<9}mean {:+.6g}, mean of absolutes {:.6g}, from {:+.6g} to {:+.6g}\n", c.channel,
                        c.mean, c.mean_absolute, c.lowest, c.highest);
  return text;
}

std::string text_of(const FlipReport& flip) {
  std::string text = fmt::format("FLIP       {:.6f}", flip.ldr);
  if (flip.hdr)
    text += fmt::format("; {:.6f} over {} exposures from {:+.2f} to {:+.2f} stops", *flip.hdr,
                        flip.exposures.count, flip.exposures.start, flip.exposures.stop);
  return text + fmt::format(" ({:.1f} pixels per degree)\n", flip.pixels_per_degree);
}

std::string text_of(const BlockTest& blocks) {
  const BlockScore& worst = blocks.worst();
  const int n = blocks.blocks_per_side;
  return fmt::format(
      "means      {}: the worst of {} differs by {:+.2f} standard errors ({} of ({}, {}) to ({}, {})); "
      "accepted "
      "to {:.2f}\n           of {}, by the variance of {}{}\n",
      blocks.means_agree() ? "agree" : "differ", blocks.scores.size(), worst.z, worst.channel, worst.x0,
      worst.y0, worst.x1, worst.y1, blocks.limit,
      n == 1  ? std::string("the whole picture alone, which is too small for blocks")
      : n < 4 ? fmt::format("the whole and {} x {} blocks, smaller ones having too few pixels", n, n)
              : fmt::format("the whole and {} x {} blocks", n, n),
      name_of(blocks.variance), blocks.other_is_exact ? ", the other taken as exact" : "");
}

std::string text_of(const Exceeded& e) {
  const std::string number = e.layer.empty() ? e.number : fmt::format("{} of {}", e.number, e.layer);
  if (std::isnan(e.value))
    return fmt::format("exceeded   {}: cannot be within {:.6g}, since values are not finite\n", number,
                       e.limit);
  return fmt::format("exceeded   {}: {:.6g}, limit {:.6g}, by {:.6g}\n", number, e.value, e.limit,
                     std::abs(e.value - e.limit));
}

Json json_of(const LayerReport& layer) {
  const NotFinite& n = layer.not_finite;
  Json json = {{"not_finite", {{"pixels", n.pixels}, {"test", n.test}, {"reference", n.reference}}},
               {"rmse", layer.rmse},
               {"relmse", layer.relative_mse}};
  if (layer.psnr) json["psnr"] = *layer.psnr;
  json["largest"] = {{"difference", layer.largest.difference},
                     {"channel", layer.largest.channel},
                     {"x", layer.largest.x},
                     {"y", layer.largest.y}};
  for (const ChannelDifference& c : layer.channels)
    json["channels"][c.channel] = {{"mean", c.mean},
                                   {"mean_absolute", c.mean_absolute},
                                   {"rmse", std::sqrt(c.mean_square)},
                                   {"lowest", c.lowest},
                                   {"highest", c.highest}};
  return json;
}

Json json_of(const FlipReport& flip) {
  Json json = {{"pixels_per_degree", flip.pixels_per_degree}, {"ldr", flip.ldr}};
  if (flip.hdr) {
    json["hdr"] = *flip.hdr;
    json["exposures"] = {
        {"start", flip.exposures.start}, {"stop", flip.exposures.stop}, {"count", flip.exposures.count}};
  }
  return json;
}

Json json_of(const BlockTest& blocks) {
  Json json = {{"agree", blocks.means_agree()},
               {"variance", name_of(blocks.variance)},
               {"other_is_exact", blocks.other_is_exact},
               {"blocks_per_side", blocks.blocks_per_side},
               {"limit", blocks.limit},
               {"worst", blocks.worst().z}};
  for (const BlockScore& s : blocks.scores)
    json["scores"].push_back(
        {{"channel", s.channel}, {"x0", s.x0}, {"y0", s.y0}, {"x1", s.x1}, {"y1", s.y1}, {"z", s.z}});
  return json;
}

}  // namespace

double LayerReport::mean_difference() const {
  double most = 0;
  for (const ChannelDifference& c : channels)
    if (!(std::abs(c.mean) <= most) && !std::isnan(most)) most = std::abs(c.mean);
  return most;
}

std::string to_text(const ComparisonReport& r) {
  std::string text = fmt::format("test       {}\nreference  {}\npixels     {} x {}\n", r.test, r.reference,
                                 r.width, r.height);
  for (const LayerReport& layer : r.layers) text += text_of(layer);
  if (r.flip) text += text_of(*r.flip);
  if (r.blocks) text += text_of(*r.blocks);
  for (const Exceeded& e : r.exceeded) text += text_of(e);
  return text;
}

std::string to_json(const ComparisonReport& r) {
  Json json = {{"test", r.test}, {"reference", r.reference}, {"width", r.width}, {"height", r.height}};
  for (const LayerReport& layer : r.layers) json["layers"][layer.name] = json_of(layer);
  if (r.flip) json["flip"] = json_of(*r.flip);
  if (r.blocks) json["means"] = json_of(*r.blocks);
  json["exceeded"] = Json::array();
  for (const Exceeded& e : r.exceeded)
    json["exceeded"].push_back(
        {{"number", e.number}, {"layer", e.layer}, {"value", e.value}, {"limit", e.limit}});
  // A file may have any name; what is no UTF-8 in it is replaced.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace parian
