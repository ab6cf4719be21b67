// Where the bytes come from: containers, URIs, and JSON that is not glTF.
#include <gtest/gtest.h>

#include "renderer/base/memory.h"
#include "tests/scene_io/support/gltf_builder.h"

namespace parian {
namespace {

class GltfFile : public GltfTest {
 protected:
  static GltfBuilder triangle() {
    GltfBuilder builder;
    builder.add_triangle();
    return builder;
  }
};

void expect_triangle(const Scene& scene) {
  ASSERT_EQ(scene.meshes.size(), 1u);
  const Primitive& primitive = scene.meshes[0].primitives.at(0);
  ASSERT_EQ(primitive.positions.size(), 3u);
  EXPECT_EQ(primitive.positions[1], Vec3f(1, 0, 0));
}

TEST_F(GltfFile, ReadsBinaryContainer) { expect_triangle(load(triangle().glb())); }

TEST_F(GltfFile, ReadsDataUri) {
  const GltfBuilder builder = triangle();
  for (const std::string type : {"application/octet-stream", "application/gltf-buffer"}) {
    expect_triangle(load(builder.gltf("data:" + type + ";base64," + base64(builder.binary)), "scene.gltf"));
  }
}

TEST_F(GltfFile, ReadsBase64OfEveryLength) {
  GltfBuilder builder = triangle();
  for (int i = 0; i < 3; ++i) {
    builder.binary += char('\xF0' + i);
    expect_triangle(load(builder.gltf("data:;base64," + base64(builder.binary)), "scene.gltf"));
  }
}

TEST_F(GltfFile, ReadsExternalFileWithEscapes) {
  const GltfBuilder builder = triangle();
  write("sub dir/my data.bin", builder.binary);
  expect_triangle(load(builder.gltf("sub%20dir/my%20data.bin"), "scene.gltf"));
  expect_triangle(load(builder.gltf("sub dir/my data.bin"), "scene.gltf"));
}

// Ten thousand buffers that name one file of 4 MB take it once. Caught: 40 GB, or the time to read them.
TEST_F(GltfFile, ReadsAFileOnceHoweverManyBuffersNameIt) {
  GltfBuilder builder = triangle();
  builder.binary.resize(std::size_t(4) << 20);
  write("data.bin", builder.binary);
  json document = json::parse(builder.gltf("data.bin"));
  for (int i = 0; i < 10000; ++i) document["buffers"].push_back(document["buffers"][0]);
  expect_triangle(load(document.dump(), "scene.gltf"));
  EXPECT_LT(peak_memory(), std::size_t(4) << 30);
}

TEST_F(GltfFile, TellsTheFormatByContentNotName) { expect_triangle(load(triangle().glb(), "scene.gltf")); }

TEST_F(GltfFile, ReadsByteOrderMark) {
  const GltfBuilder builder = triangle();
  expect_triangle(
      load("\xEF\xBB\xBF" + builder.gltf("data:;base64," + base64(builder.binary)), "scene.gltf"));
}

TEST_F(GltfFile, IgnoresFurtherChunksAndExtras) {
  GltfBuilder builder = triangle();
  builder.root["extras"] = {{"anything", {1, "two", nullptr}}};
  const std::string glb = builder.glb();
  expect_triangle(load(GltfBuilder::container(glb.substr(12) + GltfBuilder::chunk("junk", "JUNK", ' '))));
}

TEST_F(GltfFile, ReadsIntegersWrittenAsReals) {
  GltfBuilder builder = triangle();
  builder.root["accessors"][0]["count"] = 3.0;
  builder.root["accessors"][0]["componentType"] = 5126.0;
  expect_triangle(load(builder.glb()));
}

TEST_F(GltfFile, ReadsDocumentWithNothingInIt) {
  const Scene scene = load(R"({"asset": {"version": "2.0"}})", "scene.gltf");
  EXPECT_EQ(scene, Scene());
}

TEST_F(GltfFile, RefusesMissingFiles) {
  EXPECT_THROW(load_gltf(path("absent.glb"), {}, warnings), InputError);
  EXPECT_THROW(load_gltf(path(""), {}, warnings), InputError);  // the folder
  EXPECT_THROW(load_gltf("/dev/zero", {}, warnings), InputError);
  const GltfBuilder builder = triangle();
  EXPECT_EQ(refusal(builder.gltf("absent.bin"), "scene.gltf"),
            "/buffers/0/uri: expected a file, '" + path("absent.bin") + "' is not one");
  EXPECT_EQ(refusal(builder.gltf("https://example.org/a.bin"), "scene.gltf").substr(0, 15),
            "/buffers/0/uri:");
  EXPECT_EQ(refusal(builder.gltf("a%00b"), "scene.gltf").substr(0, 15), "/buffers/0/uri:");
}

TEST_F(GltfFile, RefusesBrokenDataUris) {
  const GltfBuilder builder = triangle();
  for (const std::string uri :
       {"data:", "data:,plain", "data:;base64", "data:;base64,!!!!", "data:;base64,AAAAA"}) {
    EXPECT_EQ(refusal(builder.gltf(uri), "scene.gltf").substr(0, 15), "/buffers/0/uri:") << uri;
  }
  EXPECT_EQ(refusal(builder.gltf("data:;base64,AAAA"), "scene.gltf"),
            "/buffers/0/byteLength: expected at most 3, the bytes that are there");
}

TEST_F(GltfFile, RefusesEveryPrefixOfAContainer) {
  const std::string glb = triangle().glb();
  for (std::size_t size = 0; size < glb.size(); ++size) {
    EXPECT_NE(refusal(glb.substr(0, size)), "") << size;
  }
}

TEST_F(GltfFile, RefusesLyingChunks) {
  const std::string json = R"({"asset":{"version":"2.0"}}   )";
  const std::string good = GltfBuilder::chunk(json, "JSON", ' ');
  EXPECT_EQ(refusal(GltfBuilder::container(good)), "");
  EXPECT_EQ(refusal("glTF" + GltfBuilder::u32(1) + GltfBuilder::u32(12) + good),
            "byte 4: expected .glb version 2, found 1");
  EXPECT_EQ(refusal(GltfBuilder::container(GltfBuilder::u32(0xFFFFFFFF) + "JSON" + json)),
            "byte 12: expected a chunk of at most 30 bytes, found 4294967295");
  EXPECT_EQ(refusal(GltfBuilder::container(GltfBuilder::chunk(json, "BIN\0", ' '))),
            "byte 12: expected the first chunk to be JSON");
  EXPECT_EQ(refusal("glTF" + GltfBuilder::u32(2) + GltfBuilder::u32(9) + good).substr(0, 8), "byte 12:");
  EXPECT_EQ(refusal(GltfBuilder::container(good + "abc")).substr(0, 5), "byte ");
}

TEST_F(GltfFile, RefusesWhatIsNotJson) {
  for (const std::string text :
       {"", "{", "null", "[]", "{\"asset\":", "\xFF\xFE", "{\"asset\": {\"version\": 1e999}}"}) {
    EXPECT_NE(refusal(text, "scene.gltf"), "") << text;
  }
  EXPECT_EQ(refusal("[]", "scene.gltf"), "expected an object");
  EXPECT_EQ(refusal("hello", "scene.gltf").substr(0, 20), "expected valid JSON:");
}

// Neither takes the stack down nor, at 16 MB, more than a moment.
TEST_F(GltfFile, RefusesBombs) {
  const std::string deep(std::size_t(16) << 20, '[');
  EXPECT_EQ(refusal(deep, "scene.gltf"), "expected JSON nested at most 64 deep");
  EXPECT_EQ(refusal("{\"a\":" + deep, "scene.gltf"), "expected JSON nested at most 64 deep");
  EXPECT_NE(refusal(std::string(std::size_t(16) << 20, '\x7F'), "scene.gltf"), "");
  EXPECT_NE(refusal(std::string(std::size_t(16) << 20, '\0'), "scene.gltf"), "");
}

TEST_F(GltfFile, LoadsSeveralFilesAsOneScene) {
  GltfBuilder second = triangle();
  second.root["materials"] = {{{"name", "red"}}};
  second.root["meshes"][0]["primitives"][0]["material"] = 0;
  second.root["nodes"] = {{{"mesh", 0}}};
  second.root["scenes"] = {{{"nodes", {0}}}};
  const Scene scene =
      load_scene({write("a.glb", triangle().glb()), write("b.glb", second.glb())}, {}, warnings);
  ASSERT_EQ(scene.meshes.size(), 2u);
  EXPECT_EQ(scene.materials.at(std::size_t(scene.meshes[1].primitives[0].material)).name, "red");
  EXPECT_EQ(scene.nodes.at(0).mesh, 1);
  EXPECT_EQ(scene.roots, std::vector<int>{0});
}

}  // namespace
}  // namespace parian
