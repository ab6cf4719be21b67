/// The functions of ImageLibrary, by OpenImageIO.
#pragma once

#include "images/image_library.h"

namespace parian::oiio {

Image read_image(std::span<const std::byte> encoded, const std::string& name);
std::size_t decoded_bytes(std::span<const std::byte> encoded, const std::string& name);
Picture read_picture(const std::string& path);
ColorEncoding read_color_encoding(const std::string& path);
void write_exr(const Picture& picture, const std::string& path);
void write_display_image(const Picture& picture, const std::string& path);
std::vector<ChannelDifference> channel_differences(const Picture& test, const Picture& reference);
void write_heat_map(std::span<const float> values, int width, int height, const std::string& path);
std::shared_ptr<TileCache> make_tile_cache();

/// As many threads as the program has.
int library_threads();

}  // namespace parian::oiio
