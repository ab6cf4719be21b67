/// glTF files made in memory, for the tests of the reader.
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "images/image_io.h"
#include "renderer/base/error.h"
#include "renderer/base/image.h"
#include "scene_io/gltf/gltf.h"

namespace parian {

using nlohmann::json;

/// An empty folder of the test's own, gone with it.
class GltfTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(testing::TempDir()) /
              fmt::format("parian_{}_{}", test->test_suite_name(), test->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  std::string write(const std::string& name, const std::string& bytes) const {
    std::filesystem::create_directories(std::filesystem::path(path(name)).parent_path());
    std::ofstream(path(name), std::ios::binary) << bytes;
    return path(name);
  }

  Scene load(const std::string& bytes, const std::string& name = "scene.glb") {
    warnings.clear();
    return load_gltf(write(name, bytes), settings, warnings);
  }

  /// The message with which a file is refused, without the path of the file; empty where it is read.
  std::string refusal(const std::string& bytes, const std::string& name = "scene.glb") {
    try {
      load(bytes, name);
    } catch (const InputError& error) {
      const std::string what = error.what(), prefix = path(name) + ": ";
      EXPECT_TRUE(what.starts_with(prefix)) << what;
      EXPECT_EQ(what.find('\n'), std::string::npos) << what;
      return what.substr(std::min(prefix.size(), what.size()));
    }
    return {};
  }

  LoadSettings settings;
  std::vector<std::string> warnings;

 private:
  std::filesystem::path folder_;
};

inline std::string read_bytes(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

inline std::string base64(const std::string& bytes) {
  constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? std::uint8_t(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? digits[bits >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

/// A PNG file of the size, all of one colour.
inline std::string png(const std::string& scratch_path, int width = 2, int height = 2) {
  Picture picture{
      .width = width, .height = height, .channels = {"R", "G", "B"}, .pixels = {}, .metadata = {}};
  picture.pixels.assign(std::size_t(width * height) * 3, 0.5f);
  write_display_image(picture, scratch_path);
  return read_bytes(scratch_path);
}

/// A document with one buffer, to which arrays are added.
struct GltfBuilder {
  json root = {{"asset", {{"version", "2.0"}}}};
  std::string binary;

  int add_bytes(const std::string& bytes) {
    while (binary.size() % 4) binary += '\0';
    root["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes.size()}});
    binary += bytes;
    return int(root["bufferViews"].size()) - 1;
  }

  template <class T>
  int add_view(const std::vector<T>& values) {
    return add_bytes({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
  }

  template <class T>
  static int component_type() {
    if (std::is_same_v<T, std::int8_t>) return 5120;
    if (std::is_same_v<T, std::uint8_t>) return 5121;
    if (std::is_same_v<T, std::int16_t>) return 5122;
    if (std::is_same_v<T, std::uint16_t>) return 5123;
    return std::is_same_v<T, std::uint32_t> ? 5125 : 5126;
  }

  /// The index of a new accessor; type SCALAR, VEC2, VEC3, VEC4 or MAT4.
  template <class T>
  int add(const std::vector<T>& values, const std::string& type, bool normalized = false) {
    const std::size_t components = type == "SCALAR" ? 1 : type == "MAT4" ? 16 : std::size_t(type[3] - '0');
    json accessor = {{"bufferView", add_view(values)},
                     {"componentType", component_type<T>()},
                     {"count", values.size() / components},
                     {"type", type}};
    if (normalized) accessor["normalized"] = true;
    root["accessors"].push_back(accessor);
    return int(root["accessors"].size()) - 1;
  }

  /// A mesh of one primitive.
  json& add_mesh(json attributes) {
    json primitive;
    primitive["attributes"] = std::move(attributes);
    json mesh;
    mesh["primitives"] = json::array({std::move(primitive)});
    root["meshes"].push_back(std::move(mesh));
    return root["meshes"].back()["primitives"][0];
  }

  /// A mesh of one right triangle in the xy plane.
  json& add_triangle() { return add_mesh({{"POSITION", add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3")}}); }

  void use_extension(const std::string& name) { root["extensionsUsed"].push_back(name); }

  static std::string chunk(std::string content, const char* type, char padding) {
    while (content.size() % 4) content += padding;
    return u32(std::uint32_t(content.size())) + std::string(type, 4) + content;
  }

  static std::string u32(std::uint32_t value) { return {reinterpret_cast<const char*>(&value), 4}; }

  static std::string container(const std::string& chunks) {
    return "glTF" + u32(2) + u32(std::uint32_t(12 + chunks.size())) + chunks;
  }

  std::string glb() const {
    json document = root;
    if (!binary.empty() && !document.contains("buffers"))
      document["buffers"] = {{{"byteLength", binary.size()}}};
    return container(chunk(document.dump(), "JSON", ' ') +
                     (binary.empty() ? "" : chunk(binary, "BIN\0", '\0')));
  }

  /// A .gltf whose buffer is at `uri`.
  std::string gltf(const std::string& uri) const {
    json document = root;
    document["buffers"] = {{{"byteLength", binary.size()}, {"uri", uri}}};
    return document.dump();
  }
};

}  // namespace parian
