/// What an encoded image is.
#pragma once

#include <string>
#include <string_view>

namespace parian {

/// The media type by the first bytes; that of any bytes where they are of no known format.
std::string image_type(std::string_view bytes);

/// Whether a file is WebP, which a texture names by an extension. False where it cannot be read.
bool is_webp_file(const std::string& path);

}  // namespace parian
