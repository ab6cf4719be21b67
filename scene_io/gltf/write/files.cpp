/// write_files(): the containers.
#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "renderer/base/error.h"
#include "scene_io/gltf/file/file.h"
#include "scene_io/gltf/write/draft.h"
#include "scene_io/gltf/write/format.h"
#include "scene_io/gltf/write/layout.h"
#include "scene_io/gltf/write/uri.h"

namespace parian {
namespace fs = std::filesystem;

namespace {

using nlohmann::json;

constexpr std::uint32_t kMagic = 0x46546C67, kJson = 0x4E4F534A, kBinary = 0x004E4942;

void write_pieces(FileWriter& file, const std::vector<Piece>& pieces) {
  for (const Piece& piece : pieces) piece.write(file);
}

void write_u32(FileWriter& file, std::size_t value) {
  const auto bits = std::uint32_t(value);
  file.write(&bits, sizeof(bits));
}

std::size_t padding(std::size_t size) { return (4 - size % 4) % 4; }

void write_glb(const Draft& draft, const std::vector<Piece>& pieces) {
  std::string text = draft.root.dump();
  text.append(padding(text.size()), ' ');
  const std::size_t bytes = total_bytes(pieces), gap = padding(bytes);
  const std::size_t length = 12 + 8 + text.size() + (bytes > 0 ? 8 + bytes + gap : 0);
  if (length > std::numeric_limits<std::uint32_t>::max()) {
    throw InputError(draft.path.string(), "",
                     fmt::format("cannot be written: a .glb has at most 4 GiB, and this would have {} bytes; "
                                 "expected a name that ends in .gltf",
                                 length));
  }
  FileWriter file(draft.path.string());
  for (const std::size_t value :
       {std::size_t(kMagic), std::size_t(2), length, text.size(), std::size_t(kJson)})
    write_u32(file, value);
  file.write(text);
  if (bytes > 0) {
    write_u32(file, bytes + gap);
    write_u32(file, kBinary);
    write_pieces(file, pieces);
    file.write(std::string(gap, '\0'));
  }
  file.commit();
}

/// Whether a file of this name is one that a .gltf called `stem` may have been given here.
bool is_own_name(const std::string& name, const std::string& stem) {
  if (!name.starts_with(stem) || !name.ends_with(".bin") || name.size() < stem.size() + 4) return false;
  const std::string middle = name.substr(stem.size(), name.size() - stem.size() - 4);
  return middle.empty() || (middle.size() > 1 && middle[0] == '-' &&
                            middle.find_first_not_of("0123456789", 1) == std::string::npos);
}

/// The .bin that the .gltf at the path has now and will not need any more.
std::optional<fs::path> find_old_binary(const Draft& draft) try {
  const std::vector<char> text = read_file(draft.path.string());
  const json old = json::parse(text.begin(), text.end());
  const json& buffers = old.at("buffers");
  // Behind it there may be those that bufferViews fall back to, which stay.
  const json staying = draft.root.value("buffers", json::array());
  for (std::size_t i = 1; i < buffers.size(); ++i)
    if (std::ranges::find(staying, buffers[i]) == staying.end()) return std::nullopt;
  const fs::path path = resolve_uri(buffers.at(0).at("uri").get<std::string>(), draft.folder);
  for (const json& buffer : staying)
    if (buffer.contains("uri") && resolve_uri(buffer["uri"].get<std::string>(), draft.folder) == path)
      return std::nullopt;
  const bool own =
      path.parent_path() == draft.folder && is_own_name(path.filename().string(), draft.path.stem().string());
  return own ? std::optional(path) : std::nullopt;
} catch (const std::exception&) {
  return std::nullopt;  // there is none, or none that can be read
}

/// A name that is free, so that a .gltf that is there keeps its own until it is replaced itself.
fs::path free_name(const Draft& draft) {
  const std::string stem = draft.path.stem().string();
  for (int i = 0;; ++i) {
    fs::path path = draft.folder / (i == 0 ? stem + ".bin" : fmt::format("{}-{}.bin", stem, i));
    if (!fs::exists(fs::symlink_status(path))) return path;
  }
}

void write_gltf_and_binary(Draft& draft, const std::vector<Piece>& pieces) {
  const std::optional<fs::path> old = find_old_binary(draft);
  std::optional<fs::path> binary;
  if (total_bytes(pieces) > 0) {
    binary = free_name(draft);
    draft.root["buffers"][0]["uri"] = make_uri(*binary, draft.folder);
  }
  FileWriter text(draft.path.string());
  text.write(format_json(draft.root));
  text.finish();
  if (binary) {
    FileWriter bytes(binary->string());
    write_pieces(bytes, pieces);
    bytes.commit();
  }
  std::error_code error;
  try {
    text.commit();
  } catch (const InputError&) {
    if (binary) fs::remove(*binary, error);
    throw;
  }
  if (old) fs::remove(*old, error);
}

}  // namespace

void write_files(Draft& draft) {
  const std::vector<Piece> pieces = lay_out(draft);
  write_header(draft);
  try {
    if (draft.is_glb)
      write_glb(draft, pieces);
    else
      write_gltf_and_binary(draft, pieces);
  } catch (const json::type_error&) {
    throw InputError(draft.path.string(), "", "cannot be written: expected names in UTF-8");
  }
}

}  // namespace parian
