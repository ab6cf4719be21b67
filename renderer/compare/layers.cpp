#include "renderer/compare/layers.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "renderer/base/error.h"

namespace parian {
namespace {

using Names = std::vector<std::string>;

bool contains(const Names& names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

// In the order of colour and of the alphabet.
Names channels_of(const Picture& picture, const std::string& layer) {
  Names names;
  for (const std::string& channel : picture.channels)
    if (layer_of(channel) == layer) names.push_back(channel);
  const auto key = [](const std::string& name) {
    const std::string last = name.substr(name.rfind('.') + 1);
    return std::pair(std::string("RGBA").find(last), name);
  };
  std::ranges::sort(names, {}, key);
  return names;
}

// Layers of `picture` that `other` has not.
void check_layers(const Picture& picture, const std::string& file, const Picture& other,
                  const std::string& other_file) {
  const Names have = layer_names(other);
  Names missing;
  for (const std::string& layer : layer_names(picture))
    if (layer != "variance" && layer != "samples" && !contains(have, layer)) missing.push_back(layer);
  if (missing.empty()) return;
  throw InputError(
      other_file, "",
      fmt::format("has no {}; expected the layers of {}. --layer NAME (--layer {}) compares one alone",
                  fmt::join(missing, ", "), file, have.empty() ? kColorLayer : have.front()));
}

double decoded_srgb(double value) {
  return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

}  // namespace

std::string layer_of(const std::string& channel) {
  for (const char* color : {"R", "G", "B", "Y", "A"})
    if (channel == color) return kColorLayer;
  return channel.substr(0, channel.rfind('.'));
}

Names layer_names(const Picture& picture) {
  Names names;
  for (const std::string& channel : picture.channels)
    if (const std::string layer = layer_of(channel); !contains(names, layer)) names.push_back(layer);
  return names;
}

Names layers_to_compare(const Picture& test, const std::string& test_file, const Picture& reference,
                        const std::string& reference_file, const std::string& wanted) {
  if (test.width != reference.width || test.height != reference.height)
    throw InputError(test_file, "",
                     fmt::format("{} x {} pixels; expected {} x {} as {} has", test.width, test.height,
                                 reference.width, reference.height, reference_file));
  const Names in_test = layer_names(test), in_reference = layer_names(reference);
  Names layers;
  if (wanted.empty()) {
    check_layers(reference, reference_file, test, test_file);
    check_layers(test, test_file, reference, reference_file);
    for (const std::string& layer : in_reference)
      if (layer != "variance" && layer != "samples") layers.push_back(layer);
  } else {
    if (!contains(in_test, wanted) && !contains(in_reference, wanted))
      throw UsageError(
          fmt::format("--layer {}: no such layer; there are: {}", wanted, fmt::join(in_reference, ", ")));
    for (const auto& [names, file] : {std::pair(&in_test, &test_file), {&in_reference, &reference_file}})
      if (!contains(*names, wanted))
        throw InputError(*file, "",
                         fmt::format("has no layer {}; there are: {}", wanted, fmt::join(*names, ", ")));
    layers = {wanted};
  }
  for (const std::string& layer : layers)
    if (const Names a = channels_of(test, layer), b = channels_of(reference, layer); a != b)
      throw InputError(test_file, "",
                       fmt::format("channels {}; expected {} as {} has", fmt::join(a, ", "),
                                   fmt::join(b, ", "), reference_file));
  return layers;
}

Picture select_layer(const Picture& picture, const std::string& layer) {
  Picture selected{picture.width, picture.height, channels_of(picture, layer), {}, {}};
  std::vector<std::size_t> from;
  for (const std::string& channel : selected.channels)
    from.push_back(std::size_t(std::ranges::find(picture.channels, channel) - picture.channels.begin()));
  selected.pixels.reserve(from.size() * picture.width * picture.height);
  for (std::size_t first = 0; first < picture.pixels.size(); first += picture.channels.size())
    for (const std::size_t c : from) selected.pixels.push_back(picture.pixels[first + c]);
  return selected;
}

RgbPlanes rgb_planes(const Picture& picture, bool is_srgb) {
  const Names& channels = picture.channels;
  const bool grey = contains(channels, "Y");
  RgbPlanes planes;
  if (!grey && !(contains(channels, "R") && contains(channels, "G") && contains(channels, "B")))
    return planes;
  const auto plane = [&](const char* name) {
    const std::size_t c = std::size_t(std::ranges::find(channels, grey ? "Y" : name) - channels.begin());
    Plane values(picture.width, picture.height);
    for (std::size_t i = 0; i < values.values.size(); ++i) {
      const float value = picture.pixels[i * channels.size() + c];
      values.values[i] = is_srgb ? float(decoded_srgb(value)) : value;
    }
    return values;
  };
  return {plane("R"), plane("G"), plane("B")};
}

}  // namespace parian
