#include "apps/command_line/compare_pictures.h"

#include <algorithm>
#include <cmath>

#include "renderer/compare/layers.h"

namespace parian {
namespace {

// One layer of both pictures, and which pixels are not finite in either.
struct Layer {
  Picture test, reference;
  std::vector<bool> not_finite;
  NotFinite count;
};

Layer layer_of_both(const Picture& test, const Picture& reference, const std::string& name) {
  Layer layer{select_layer(test, name), select_layer(reference, name), {}, {}};
  const auto count = [](const std::vector<bool>& pixels) {
    return std::size_t(std::ranges::count(pixels, true));
  };
  const std::vector<bool> in_test = not_finite_pixels(layer.test);
  layer.not_finite = not_finite_pixels(layer.reference);
  layer.count.test = count(in_test);
  layer.count.reference = count(layer.not_finite);
  for (std::size_t i = 0; i < in_test.size(); ++i)
    if (in_test[i]) layer.not_finite[i] = true;
  layer.count.pixels = count(layer.not_finite);
  return layer;
}

LayerReport compare_layer(const Layer& layer, const std::string& name, float peak) {
  LayerReport report{name,
                     layer.count,
                     0,
                     relative_mse(layer.test, layer.reference),
                     {},
                     largest_difference(layer.test, layer.reference),
                     channel_differences(layer.test, layer.reference)};
  double mean_square = 0;
  for (const ChannelDifference& c : report.channels)
    mean_square += c.mean_square / double(report.channels.size());
  report.rmse = std::sqrt(mean_square);
  if (name == kColorLayer) report.psnr = peak_signal_to_noise(mean_square, peak);
  return report;
}

// Linear planes of a picture, black where pixels are not finite: a filter would spread them.
RgbPlanes finite_planes(const Picture& picture, bool is_srgb, const std::vector<bool>& not_finite) {
  RgbPlanes planes = rgb_planes(picture, is_srgb);
  for (Plane* plane : {&planes.r, &planes.g, &planes.b})
    for (std::size_t i = 0; i < plane->values.size(); ++i)
      if (not_finite[i]) plane->values[i] = 0;
  return planes;
}

// FLIP where the pictures have a colour that the screen's primaries make.
void compare_color(const Layer& color, const ColorEncoding& encoding, float pixels_per_degree,
                   Comparison& comparison) {
  const bool is_linear = encoding.transfer == ColorEncoding().transfer;
  const RgbPlanes test = finite_planes(color.test, !is_linear, color.not_finite),
                  reference = finite_planes(color.reference, !is_linear, color.not_finite);
  if (test.r.values.empty() || !same_chromaticities(encoding, {})) return;
  // The map says 1 where pixels are not finite: nobody can say what they look like. There is no mean then.
  const auto add = [&](const char* name, Plane map) {
    for (std::size_t i = 0; i < map.values.size(); ++i)
      if (color.not_finite[i]) map.values[i] = 1;
    const double value = color.count.pixels > 0 ? NAN : mean(map);
    comparison.maps[name] = std::move(map);
    return value;
  };
  FlipReport flip;
  flip.pixels_per_degree = pixels_per_degree;
  flip.ldr = add("flip", ldr_flip(test, reference, pixels_per_degree));
  if (is_linear) {
    flip.exposures = exposure_range(reference);
    flip.hdr = add("hdr-flip", hdr_flip(test, reference, flip.exposures, pixels_per_degree));
  }
  comparison.report.flip = flip;
}

}  // namespace

Comparison compare_pictures(const std::string& test_file, const std::string& reference_file,
                            const ComparisonSettings& settings) {
  const Picture test = read_picture(test_file), reference = read_picture(reference_file);
  const ColorEncoding encoding = shared_color_encoding(test_file, reference_file);
  Comparison comparison;
  ComparisonReport& report = comparison.report;
  report.test = test_file;
  report.reference = reference_file;
  report.width = test.width;
  report.height = test.height;
  for (const std::string& name :
       layers_to_compare(test, test_file, reference, reference_file, settings.layer)) {
    const Layer layer = layer_of_both(test, reference, name);
    report.layers.push_back(compare_layer(layer, name, settings.peak));
    if (!comparison.maps.contains("error"))
      comparison.maps["error"] = relative_errors(layer.test, layer.reference);
    if (name != kColorLayer) continue;
    compare_color(layer, encoding, settings.pixels_per_degree, comparison);
    report.blocks = block_test(test, reference, {settings.significance});
  }
  return comparison;
}

}  // namespace parian
