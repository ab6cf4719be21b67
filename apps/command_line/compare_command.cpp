#include <cmath>
#include <filesystem>
#include <optional>

#include "apps/command_line/commands.h"
#include "apps/command_line/compare_pictures.h"
#include "renderer/base/error.h"
#include "renderer/base/file.h"
#include "renderer/base/parallel.h"
#include "renderer/compare/layers.h"

namespace parian {
namespace {

using Limit = std::optional<double>;

struct CompareOptions {
  std::string test, reference, json, heat_map, heat_map_of;
  ComparisonSettings settings;
  Limit max_rmse, max_relmse, min_psnr, max_difference, max_mean_difference, max_flip, max_hdr_flip;
  bool same_means = false;
  int threads = 0;
};

void check_usage(const CompareOptions& o) {
  if (!o.heat_map_of.empty() && o.heat_map.empty())
    throw UsageError("--heat-map-of: expected --heat-map FILE.png with it");
  const std::string extension = std::filesystem::path(o.heat_map).extension();
  if (!o.heat_map.empty() && extension != ".png" && extension != ".jpg" && extension != ".jpeg")
    throw UsageError(fmt::format("--heat-map {}: expected a name that ends in .png or .jpg", o.heat_map));
  const std::string& layer = o.settings.layer;
  if (layer.empty() || layer == kColorLayer) return;
  for (const auto& [option, given] : {std::pair("--min-psnr", o.min_psnr.has_value()),
                                      {"--max-flip", o.max_flip.has_value()},
                                      {"--max-hdr-flip", o.max_hdr_flip.has_value()},
                                      {"--same-means", o.same_means},
                                      {"--heat-map-of", !o.heat_map_of.empty() && o.heat_map_of != "error"}})
    if (given) throw UsageError(fmt::format("{}: is for the layer rgb, not for --layer {}", option, layer));
}

// Refuses to hold a limit against a number that these pictures do not have.
void check_numbers(const CompareOptions& o, const ComparisonReport& report) {
  const auto require = [&](bool there, const char* option, const char* expected) {
    if (!there) throw InputError(o.test, "", fmt::format("{}: expected {}", option, expected));
  };
  constexpr const char* kColor = "channels R, G, B, or Y, with the primaries of Rec.709";
  require(!o.max_flip || report.flip, "--max-flip", kColor);
  require(!o.max_hdr_flip || (report.flip && report.flip->hdr), "--max-hdr-flip",
          "linear channels R, G, B, or Y, with the primaries of Rec.709");
  require(!o.min_psnr || report.layers.front().psnr, "--min-psnr", kColor);
  require(!o.same_means || report.blocks, "--same-means",
          "a layer variance (channels variance.R, variance.G, variance.B) here or in the reference");
}

std::vector<Exceeded> exceeded(const CompareOptions& o, const ComparisonReport& report) {
  bool finite = true;
  for (const LayerReport& layer : report.layers) finite = finite && layer.not_finite.pixels == 0;
  std::vector<Exceeded> found;
  const auto check = [&](const char* number, const std::string& layer, double value, const Limit& limit,
                         bool at_least = false) {
    if (!limit || (finite && (at_least ? value >= *limit : value <= *limit))) return;
    found.push_back({number, layer, finite ? value : NAN, *limit});
  };
  for (const LayerReport& layer : report.layers) {
    check("RMSE", layer.name, layer.rmse, o.max_rmse);
    check("relMSE", layer.name, layer.relative_mse, o.max_relmse);
    if (layer.psnr) check("PSNR", layer.name, *layer.psnr, o.min_psnr, true);
    check("largest difference", layer.name, layer.largest.difference, o.max_difference);
    check("mean difference", layer.name, layer.mean_difference(), o.max_mean_difference);
  }
  if (report.flip) check("FLIP", "", report.flip->ldr, o.max_flip);
  if (report.flip && report.flip->hdr) check("HDR FLIP", "", *report.flip->hdr, o.max_hdr_flip);
  if (report.blocks && o.same_means)
    check("standard errors of a mean", kColorLayer, std::abs(report.blocks->worst().z), report.blocks->limit);
  return found;
}

// The map asked for, or the first there is of FLIP and the error.
const Plane& chosen_map(const CompareOptions& o, const Comparison& comparison) {
  const std::string name = !o.heat_map_of.empty()             ? o.heat_map_of
                           : comparison.maps.contains("flip") ? "flip"
                                                              : "error";
  const auto found = comparison.maps.find(name);
  if (found == comparison.maps.end())
    throw InputError(
        o.test, "",
        fmt::format("--heat-map-of {}: expected linear channels R, G, B, or Y, with the primaries of "
                    "Rec.709; --heat-map-of error shows any",
                    name));
  return found->second;
}

int compare(const CompareOptions& o) {
  check_usage(o);
  if (o.threads > 0) set_thread_count(o.threads);
  Comparison comparison = compare_pictures(o.test, o.reference, o.settings);
  check_numbers(o, comparison.report);
  comparison.report.exceeded = exceeded(o, comparison.report);
  if (!o.heat_map.empty()) {
    const Plane& map = chosen_map(o, comparison);
    write_heat_map(map.values, map.width, map.height, o.heat_map);
  }
  if (!o.json.empty()) write_file(o.json, to_json(comparison.report));
  fmt::print("{}", to_text(comparison.report));
  return comparison.report.exceeded.empty() ? kDone : kDiffers;
}

}  // namespace

Command add_compare_command(CLI::App& app) {
  CLI::App& c = *app.add_subcommand("compare", "Say how far a picture is from a reference");
  const auto options = std::make_shared<CompareOptions>();
  CompareOptions& o = *options;
  c.add_option("TEST", o.test, "Picture to judge: EXR, PNG, JPEG or HDR")->required();
  c.add_option("REFERENCE", o.reference, "Picture to judge it by, of the same size and layers")->required();
  c.add_option("--layer", o.settings.layer, "One layer alone: rgb, albedo, ...; all by default")
      ->type_name("NAME");
  c.add_option("--json", o.json, "JSON to write all numbers to")->type_name("FILE.json");
  c.add_option("--heat-map", o.heat_map, "Picture to write of where the difference is")
      ->type_name("FILE.png");
  c.add_option("--heat-map-of", o.heat_map_of,
               "What it shows [flip where there is colour]: flip, hdr-flip, or error, the relative error")
      ->check(CLI::IsMember({"flip", "hdr-flip", "error"}).description(""))
      ->type_name("NAME");
  c.add_option("--ppd", o.settings.pixels_per_degree, "Pixels per degree of the viewer's sight [67]")
      ->check(number_between(10, 1000));
  c.add_option("--peak", o.settings.peak, "White of PSNR [1]")->check(number_between(1e-6, 1e30));
  const auto add_limit = [&](const char* name, Limit& limit, const char* help, double low = 0) {
    c.add_option(name, limit, help)->check(number_between(low, 1e30))->type_name("X");
  };
  add_limit("--max-rmse", o.max_rmse, "Limit of the RMSE, of each layer");
  add_limit("--max-relmse", o.max_relmse, "Limit of the relative mean squared error, of each layer");
  add_limit("--min-psnr", o.min_psnr, "Limit of the PSNR in dB, from below", -1e30);
  add_limit("--max-difference", o.max_difference, "Limit of the largest difference, of each layer");
  add_limit("--max-mean-difference", o.max_mean_difference,
            "Limit of the mean difference, of each channel, without its sign");
  add_limit("--max-flip", o.max_flip, "Limit of the mean of FLIP");
  add_limit("--max-hdr-flip", o.max_hdr_flip, "Limit of the mean of FLIP over exposures");
  c.add_flag("--same-means", o.same_means, "Means of blocks must agree, by the layer variance");
  c.add_option("--significance", o.settings.significance,
               "Chance that any of the means that agree is said to differ [1e-4]")
      ->check(number_between(1e-12, 0.5));
  c.add_option("--threads", o.threads, "Threads; all cores by default")
      ->check(CLI::Range(1, 4096).description(""));
  return [options] { return compare(*options); };
}

}  // namespace parian
