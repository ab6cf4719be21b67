#include "scene_io/gltf/write/uri.h"

#include <fmt/format.h>

#include <stdexcept>

#include "scene_io/gltf/file/file.h"

namespace parian {
namespace fs = std::filesystem;

namespace {

fs::path to_canonical(const fs::path& path) {
  return fs::weakly_canonical(fs::absolute(path.empty() ? "." : path));
}

/// All but what RFC 3986 has unreserved, and the slashes between.
std::string encode_percent(std::string_view text) {
  std::string uri;
  for (const char c : text) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       std::string_view("-._~/").find(c) != std::string_view::npos;
    uri += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return uri;
}

}  // namespace

std::string make_uri(const fs::path& path, const fs::path& folder) {
  const fs::path target = to_canonical(path), relative = target.lexically_relative(to_canonical(folder));
  return encode_percent(relative.empty() ? target.string() : relative.string());
}

std::string move_uri(const std::string& uri, const fs::path& from, const fs::path& to) {
  if (is_data_uri(uri) || to_canonical(from) == to_canonical(to)) return uri;
  try {
    return make_uri(resolve_uri(uri, from), to);
  } catch (const std::runtime_error&) {
    return uri;
  }
}

}  // namespace parian
