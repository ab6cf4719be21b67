/// What of two pictures is compared: their layers, and their colour for FLIP.
#pragma once

#include <string>
#include <vector>

#include "renderer/base/image.h"
#include "renderer/compare/plane.h"

namespace parian {

/// The layer of the channels R, G, B or Y, and A.
inline constexpr const char* kColorLayer = "rgb";

/// The layer that a channel belongs to: what is before its last dot, its whole name where it has none, and
/// kColorLayer for colour and alpha.
std::string layer_of(const std::string& channel);

/// The layers of a picture, in the order of its channels.
std::vector<std::string> layer_names(const Picture& picture);

/// The layers to compare: `wanted` alone, or all but `variance` and `samples`, which say how the others were
/// made. Throws InputError where sizes, layers or channels of layers differ; its message begins with the name
/// of a file. Throws UsageError where neither picture has a layer that is wanted.
std::vector<std::string> layers_to_compare(const Picture& test, const std::string& test_file,
                                           const Picture& reference, const std::string& reference_file,
                                           const std::string& wanted);

/// The channels of one layer, R, G, B, A first and then by name; no metadata.
Picture select_layer(const Picture& picture, const std::string& layer);

/// Channels R, G, B, or Y for all three, as linear planes: decoded where they are sRGB. A picture that has
/// neither gives planes of no size.
RgbPlanes rgb_planes(const Picture& picture, bool is_srgb);

}  // namespace parian
