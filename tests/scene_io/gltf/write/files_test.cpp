// The files: whole or not at all.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>

#include "tests/scene_io/support/round_trip.h"

namespace parian {
namespace {

namespace fs = std::filesystem;

class WriteFiles : public WriteTest {
 protected:
  WriteFiles() {
    builder.add_triangle();
    builder.root["nodes"] = {{{"mesh", 0}}};
    builder.root["scenes"] = {{{"nodes", {0}}}};
  }

  std::string failure(const Loaded& loaded, const std::string& to) {
    try {
      write_gltf(loaded.scene, loaded.sources, to);
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  }

  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(path(""))) names.push_back(entry.path().filename());
    std::ranges::sort(names);
    return names;
  }

  GltfBuilder builder;
};

// What is loaded may lie in the pages of the file that is replaced.
TEST_F(WriteFiles, CanReplaceTheirSource) {
  Loaded loaded = load_source(builder);
  loaded.scene.nodes[0].name = "new";
  for (int i = 0; i < 2; ++i) write_gltf(loaded.scene, loaded.sources, path("source.glb"));
  EXPECT_EQ(load_with_source(path("source.glb")).scene, loaded.scene);
  EXPECT_EQ(names(), std::vector<std::string>{"source.glb"});
}

// Never the .bin that the .gltf has while it is there.
TEST_F(WriteFiles, AGltfKeepsItsBinaryUntilItIsReplaced) {
  const Loaded loaded = load_source(builder);
  write_gltf(loaded.scene, loaded.sources, path("x.gltf"));
  EXPECT_EQ(names(), (std::vector<std::string>{"source.glb", "x.bin", "x.gltf"}));
  const Loaded second = load_with_source(path("x.gltf"));
  write_gltf(second.scene, second.sources, path("x.gltf"));
  EXPECT_EQ(names(), (std::vector<std::string>{"source.glb", "x-1.bin", "x.gltf"}));
  EXPECT_EQ(load_with_source(path("x.gltf")).scene, loaded.scene);
  write_gltf(second.scene, second.sources, path("x.gltf"));
  EXPECT_EQ(names(), (std::vector<std::string>{"source.glb", "x.bin", "x.gltf"}));
  EXPECT_EQ(load_with_source(path("x.gltf")).scene, loaded.scene);
}

// Caught: a URI taken for the name of the file, so that each save left one more .bin.
TEST_F(WriteFiles, ANameWithBlanksKeepsOneBinary) {
  const Loaded loaded = load_source(builder);
  for (int i = 0; i < 3; ++i) write_gltf(loaded.scene, loaded.sources, path("a b.gltf"));
  EXPECT_EQ(names(), (std::vector<std::string>{"a b.bin", "a b.gltf", "source.glb"}));
  EXPECT_EQ(load_with_source(path("a b.gltf")).scene, loaded.scene);
}

TEST_F(WriteFiles, AnotherFilesBinaryIsLeftAlone) {
  const Loaded loaded = load_source(builder);
  write("x.bin", "of somebody else");
  write("x.gltf", builder.gltf("other.bin"));
  write("other.bin", builder.binary);
  write_gltf(loaded.scene, loaded.sources, path("x.gltf"));
  EXPECT_EQ(read_bytes(path("x.bin")), "of somebody else");
  EXPECT_EQ(read_bytes(path("other.bin")), builder.binary);
  EXPECT_EQ(load_with_source(path("x.gltf")).scene, loaded.scene);
}

TEST_F(WriteFiles, NameWhatIsWrong) {
  const Loaded loaded = load_source(builder);
  EXPECT_EQ(failure(loaded, path("x.obj")),
            path("x.obj") + ": cannot be written: expected a name that ends in .glb or .gltf");
  EXPECT_TRUE(failure(loaded, path("no/x.glb")).starts_with(path("no/x.glb") + ": cannot be written: "));
  fs::create_directory(path("folder.glb"));
  EXPECT_EQ(failure(loaded, path("folder.glb")),
            path("folder.glb") + ": cannot be written: it is not a file");
  Loaded broken = load_source(builder);
  broken.scene.nodes[0].mesh = 7;
  EXPECT_EQ(failure(broken, path("x.glb")),
            path("x.glb") + ": /nodes/0/mesh: expected an index below 1, not 7");
  broken = load_source(builder);
  broken.scene.nodes[0].name = "\xff";
  for (const char* name : {"x.glb", "x.gltf"})
    EXPECT_EQ(failure(broken, path(name)), path(name) + ": cannot be written: expected names in UTF-8");
  EXPECT_EQ(names(), (std::vector<std::string>{"folder.glb", "source.glb"}));
}

// No more than some bytes can be written, as on a full disk.
TEST_F(WriteFiles, AFullDiskLeavesTheOldFiles) {
  builder.add_bytes(std::string(1 << 16, 'x'));
  const Loaded loaded = load_source(builder);
  write("x.glb", "old");
  write("x.gltf", "old");
  rlimit old{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &old), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{1 << 14, old.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::string glb = failure(loaded, path("x.glb")), gltf = failure(loaded, path("x.gltf"));
  setrlimit(RLIMIT_FSIZE, &old);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(glb, path("x.glb") + ": cannot be written: File too large");
  EXPECT_EQ(gltf, path("x.bin") + ": cannot be written: File too large");
  EXPECT_EQ(read_bytes(path("x.glb")), "old");
  EXPECT_EQ(read_bytes(path("x.gltf")), "old");
  EXPECT_EQ(names(), (std::vector<std::string>{"source.glb", "x.glb", "x.gltf"}));
}

TEST_F(WriteFiles, AReadOnlyFolderLeavesTheOldFile) {
  const Loaded loaded = load_source(builder);
  write("locked/x.glb", "old");
  fs::permissions(path("locked"), fs::perms::owner_read | fs::perms::owner_exec);
  const bool is_root = ::access(path("locked").c_str(), W_OK) == 0;
  const std::string what = is_root ? "" : failure(loaded, path("locked/x.glb"));
  fs::permissions(path("locked"), fs::perms::owner_all);
  if (is_root) GTEST_SKIP() << "root may write anywhere";
  EXPECT_EQ(what, path("locked/x.glb") + ": cannot be written: Permission denied");
  EXPECT_EQ(read_bytes(path("locked/x.glb")), "old");
}

// Uris lead from the new folder to where the images are; names with blanks too.
TEST_F(WriteFiles, ImagesAreFoundFromOtherFolders) {
  write("from/a b.png", png(path("p.png")));
  builder.root["images"] = {{{"uri", "a%20b.png"}}};
  builder.root["textures"] = {{{"source", 0}}};
  builder.root["materials"] = {{{"normalTexture", {{"index", 0}}}}};
  const Loaded loaded = load_with_source(write("from/source.glb", builder.glb()));
  fs::create_directories(path("to/deep"));
  for (const char* name : {"to/deep/x.glb", "to/deep/x.gltf"}) {
    write_gltf(loaded.scene, loaded.sources, path(name));
    EXPECT_EQ(document_of(path(name))["images"][0]["uri"], "../../from/a%20b.png");
    EXPECT_EQ(load_with_source(path(name)).scene, loaded.scene);
  }
}

// Views of the same bytes stay views of the same bytes, and unaligned ones stay where they are to 4 bytes.
TEST_F(WriteFiles, SharedBytesAreWrittenOnce) {
  const int view = builder.add_bytes(std::string(4000, 'a'));
  json& views = builder.root["bufferViews"];
  for (int i = 0; i < 50; ++i) views.push_back(views[std::size_t(view)]);
  const Loaded loaded = load_source(builder);
  write_gltf(loaded.scene, loaded.sources, path("x.glb"));
  EXPECT_LT(fs::file_size(path("x.glb")), fs::file_size(path("source.glb")) + 200);
  EXPECT_EQ(document_of(path("x.glb"))["bufferViews"].size(), views.size());
}

// Caught: chunks of any length.
TEST_F(WriteFiles, ChunksOfAGlbAreWholeWords) {
  builder.add_bytes("abcde");
  Loaded loaded = load_source(builder);
  for (const char* name : {"a", "ab", "abc", "abcd"}) {
    loaded.scene.nodes[0].name = name;
    write_gltf(loaded.scene, loaded.sources, path("x.glb"));
    const std::string bytes = read_bytes(path("x.glb"));
    std::uint32_t header[4];
    std::memcpy(header, bytes.data(), sizeof(header));
    EXPECT_EQ(header[2], bytes.size());
    EXPECT_EQ(header[3] % 4, 0u);
    EXPECT_EQ(bytes.size() % 4, 0u);
  }
}

// Caught: data URIs taken for paths; characters of a path that mean something in a URI.
TEST_F(WriteFiles, ImagesOfAnyName) {
  write("from/50%25 #1?.png", png(path("p.png")));
  builder.root["images"] = {{{"uri", "50%2525%20%231%3F.png"}},
                            {{"uri", "data:image/png;base64," + base64(png(path("p.png"), 3, 1))}}};
  builder.root["textures"] = {{{"source", 0}}, {{"source", 1}}};
  builder.root["materials"] = {{{"normalTexture", {{"index", 0}}}, {"emissiveTexture", {{"index", 1}}}}};
  const Loaded loaded = load_with_source(write("from/source.glb", builder.glb()));
  ASSERT_EQ(loaded.scene.images.size(), 2u);
  EXPECT_EQ(again(loaded, "to/x.glb").scene, loaded.scene);
  const json images = document_of(path("to/x.glb"))["images"];
  EXPECT_EQ(images[0]["uri"], "../from/50%2525%20%231%3F.png");
  EXPECT_EQ(images[1]["uri"], builder.root["images"][1]["uri"]);
}

}  // namespace
}  // namespace parian
