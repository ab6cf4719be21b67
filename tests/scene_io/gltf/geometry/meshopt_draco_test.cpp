// Files that have both compressions.
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <cstring>
#include <filesystem>

#include "tests/scene_io/support/draco_builder.h"
#include "tests/scene_io/support/round_trip.h"

namespace parian {
namespace {

/// A stream of meshoptimizer's of elements of 4 bytes. `bytes` are filled up to whole ones.
std::string meshopt_encode(std::string& bytes) {
  while (bytes.size() % 4) bytes += '\0';
  std::vector<unsigned char> stream(2 * bytes.size() + 1024);
  meshopt_encodeVertexVersion(0);
  const std::size_t size =
      meshopt_encodeVertexBuffer(stream.data(), stream.size(), bytes.data(), bytes.size() / 4, 4);
  EXPECT_GT(size, 0u);
  return {reinterpret_cast<const char*>(stream.data()), size};
}

/// A Draco stream that lies in a bufferView which is compressed itself, and a mesh of its own in another.
class GltfDecompress : public WriteTest {
 protected:
  void add_view(std::string bytes) {
    const std::string stream = meshopt_encode(bytes);
    json& views = builder_.root["bufferViews"];
    const int number = builder_.add_bytes(stream);
    json view = {{"buffer", 1}, {"byteOffset", fallback_}, {"byteLength", bytes.size()}};
    view["extensions"]["EXT_meshopt_compression"] = {{"buffer", 0},
                                                     {"byteOffset", views[std::size_t(number)]["byteOffset"]},
                                                     {"byteLength", stream.size()},
                                                     {"byteStride", 4},
                                                     {"mode", "ATTRIBUTES"},
                                                     {"count", bytes.size() / 4}};
    views[std::size_t(number)] = view;
    fallback_ += bytes.size();
  }

  std::string both() {
    const std::vector<std::uint32_t> corners = {0, 1, 2, 2, 1, 3};
    DracoBuilder draco(corners);
    draco.add(draco::GeometryAttribute::POSITION, 7, corners_of_square_, 3);
    add_view(draco.sequential());
    add_view({reinterpret_cast<const char*>(corners_of_square_.data()), corners_of_square_.size() * 4});
    json& root = builder_.root;
    const json positions = {{"componentType", 5126}, {"count", 4}, {"type", "VEC3"}};
    root["accessors"] = {positions, {{"componentType", 5125}, {"count", 6}, {"type", "SCALAR"}}, positions};
    root["accessors"][2].update({{"bufferView", 1}, {"count", 3}});
    json& packed = builder_.add_mesh({{"POSITION", 0}});
    packed["indices"] = 1;
    packed["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", 0},
                                                          {"attributes", {{"POSITION", 7}}}};
    builder_.add_mesh({{"POSITION", 2}});
    root["nodes"] = {{{"mesh", 0}}, {{"mesh", 1}}};
    root["buffers"] = {{{"byteLength", builder_.binary.size()}}, {{"byteLength", fallback_}}};
    for (const char* list : {"extensionsUsed", "extensionsRequired"})
      root[list] = {"EXT_meshopt_compression", "KHR_draco_mesh_compression"};
    return builder_.glb();
  }

  const std::vector<float> corners_of_square_ = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0.5f};
  std::size_t fallback_ = 0;
  GltfBuilder builder_;
};

// Caught: Draco decoded before meshopt.
TEST_F(GltfDecompress, ReadsADracoStreamInACompressedView) {
  const Loaded loaded = load_with_source(write("both.glb", both()));
  ASSERT_EQ(loaded.scene.meshes.size(), 2u);
  const Primitive &first = loaded.scene.meshes[0].primitives.at(0),
                  &second = loaded.scene.meshes[1].primitives.at(0);
  ASSERT_EQ(first.positions.size(), 4u);
  EXPECT_EQ(first.positions[3], Vec3f(1, 1, 0.5f));
  ASSERT_EQ(first.triangles.size(), 2u);
  EXPECT_EQ(first.triangles[1], (Triangle{2, 1, 3}));
  ASSERT_EQ(second.positions.size(), 3u);
  EXPECT_EQ(second.positions[2], Vec3f(0, 1, 0));
  for (const char* name : {"x.glb", "x.gltf"}) EXPECT_EQ(again(loaded, name).scene, loaded.scene);
}

// A changed primitive has no stream any more. Caught: the old stream beside the new vertices.
TEST_F(GltfDecompress, AChangedPrimitiveIsWrittenPlain) {
  Loaded loaded = load_with_source(write("both.glb", both()));
  loaded.scene.meshes[0].primitives[0].positions =
      std::vector<Vec3f>{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {2, 2, 0}};
  const json root = written(loaded);
  EXPECT_FALSE(root["meshes"][0]["primitives"][0].contains("extensions"));
  EXPECT_EQ(root.value("extensionsRequired", json()), json::array({"EXT_meshopt_compression"}));
  for (const char* name : {"x.glb", "x.gltf"}) EXPECT_EQ(again(loaded, name).scene, loaded.scene);
}

// Caught: a .bin more for each save, since there is a second buffer to fall back to; that buffer's file taken
// for the old .bin and removed.
TEST_F(GltfDecompress, SavesLeaveNoOldBinary) {
  const auto binaries = [&] {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(path("")))
      if (entry.path().extension() == ".bin") names.push_back(entry.path().filename());
    std::ranges::sort(names);
    return names;
  };
  Loaded loaded = load_with_source(write("both.glb", both()));
  for (int i = 0; i < 3; ++i) {
    write_gltf(loaded.scene, loaded.sources, path("x.gltf"));
    EXPECT_EQ(binaries().size(), 1u) << i;
    loaded = load_with_source(path("x.gltf"));
  }
  // What the new file falls back to is the binary of the one that it replaces.
  json root = document_of(path("x.gltf"));
  root["buffers"][1]["uri"] = "y.bin";
  loaded = load_with_source(write("z.gltf", root.dump()));
  write("y.bin", std::string(fallback_, 'f'));
  write("y.gltf", json{{"buffers", {{{"uri", "y.bin"}, {"byteLength", fallback_}}}}}.dump());
  write_gltf(loaded.scene, loaded.sources, path("y.gltf"));
  EXPECT_EQ(document_of(path("y.gltf"))["buffers"][1]["uri"], "y.bin");
  EXPECT_EQ(read_bytes(path("y.bin")), std::string(fallback_, 'f'));
}

// A buffer that one view falls back to and another reads. Caught: nothing read of it.
TEST_F(GltfDecompress, ABufferOfBothKindsIsRead) {
  both();
  std::string bytes(fallback_, 'f');
  const std::size_t place = fallback_ - 48;
  std::memcpy(bytes.data() + place, corners_of_square_.data(), 48);
  json& root = builder_.root;
  root["buffers"][1]["uri"] = "data:application/octet-stream;base64," + base64(bytes);
  root["bufferViews"].push_back({{"buffer", 1}, {"byteOffset", place}, {"byteLength", 48}});
  root["accessors"][2]["bufferView"] = 2;
  const Loaded loaded = load_with_source(write("both.glb", builder_.glb()));
  EXPECT_EQ(loaded.scene.meshes.at(1).primitives.at(0).positions[1], Vec3f(1, 0, 0));
  EXPECT_EQ(again(loaded).scene, loaded.scene);
}

// Caught: a strip of fewer indices than the triangles of its stream take.
TEST_F(GltfDecompress, AStripHasIndicesForItsTriangles) {
  both();
  json& root = builder_.root;
  root["meshes"][0]["primitives"][0]["mode"] = 5;
  root["accessors"][1]["count"] = 4;
  EXPECT_EQ(refusal(builder_.glb()), "");
  root["accessors"][1]["count"] = 3;
  EXPECT_EQ(refusal(builder_.glb()),
            "/meshes/0/primitives/0/indices: expected an accessor of 4 indices, since the stream has 2 "
            "triangles");
}

}  // namespace
}  // namespace parian
