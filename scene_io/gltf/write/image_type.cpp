#include "scene_io/gltf/write/image_type.h"

#include <fstream>

namespace parian {

std::string image_type(std::string_view bytes) {
  if (bytes.starts_with("\x89PNG")) return "image/png";
  if (bytes.starts_with("\xff\xd8\xff")) return "image/jpeg";
  if (bytes.size() >= 12 && bytes.starts_with("RIFF") && bytes.substr(8, 4) == "WEBP") return "image/webp";
  if (bytes.starts_with("#?")) return "image/vnd.radiance";
  if (bytes.starts_with("\x76\x2f\x31\x01")) return "image/x-exr";
  return "application/octet-stream";
}

bool is_webp_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  char head[12] = {};
  file.read(head, sizeof(head));
  return image_type({head, std::size_t(file.gcount())}) == "image/webp";
}

}  // namespace parian
