// What is edited is saved: after every hundred random commands the scene is written and read again.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <utility>
#include <vector>

#include "images/image_io.h"
#include "renderer/base/error.h"
#include "scene_io/gltf/gltf.h"
#include "scene_io/gltf/source.h"
#include "scene_io/gltf/write/write.h"
#include "tests/editing/support/random_commands.h"

namespace parian {
namespace {

namespace fs = std::filesystem;

/// Of two references to textures, whether they show the same: lists of textures and images may be in another
/// order.
bool same_texture(const Scene& a, const TextureRef& use_a, const Scene& b, const TextureRef& use_b) {
  if (bool(use_a) != bool(use_b)) return false;
  if (!use_a) return true;
  Texture x = a.textures[std::size_t(use_a.texture)], y = b.textures[std::size_t(use_b.texture)];
  const Image &p = a.images[std::size_t(std::exchange(x.image, 0))],
              &q = b.images[std::size_t(std::exchange(y.image, 0))];
  return x == y && use_a.uv_set == use_b.uv_set && use_a.transform == use_b.transform && p.pixels == q.pixels;
}

void expect_same_material(const Scene& a, const Material& of_a, const Scene& b, const Material& of_b,
                          const std::string& where) {
  std::vector<TextureRef> in_a, in_b;
  Material x = of_a, y = of_b;
  const auto take = [](Material& m, std::vector<TextureRef>& into) {
    for_each_texture(m, [&](TextureRef& t) { into.push_back(std::exchange(t, TextureRef())); });
  };
  take(x, in_a);
  take(y, in_b);
  EXPECT_TRUE(x == y) << where;
  ASSERT_EQ(in_a.size(), in_b.size()) << where;
  for (std::size_t i = 0; i < in_a.size(); ++i)
    EXPECT_TRUE(same_texture(a, in_a[i], b, in_b[i])) << where << " texture " << i;
}

template <class T>
const T* find(const std::vector<T>& array, int index) {
  return index == kNone ? nullptr : &array[std::size_t(index)];
}

template <class T>
bool same(const T* a, const T* b) {
  return a && b ? *a == *b : !a && !b;
}

/// Without what only the other projection has, which no file holds.
Camera as_saved(Camera camera) {
  if (camera.projection == Projection::perspective)
    camera.xmag = camera.ymag = 1;
  else
    camera.yfov = camera.aspect = 0;
  return camera;
}

/// Without what only other kinds have.
Light as_saved(Light light) {
  if (light.kind != LightKind::spot) light.inner_angle = light.outer_angle = 0;
  if (light.kind != LightKind::rectangle) light.height = 1;
  if (light.kind != LightKind::rectangle && light.kind != LightKind::disk) light.width = 1;
  if (light.kind != LightKind::point && light.kind != LightKind::spot) light.range = 0;
  return light;
}

void expect_same_node(const Scene& a, const Scene& b, std::size_t i) {
  Node x = a.nodes[i], y = b.nodes[i];
  const Light *p = find(a.lights, std::exchange(x.light, kNone)),
              *q = find(b.lights, std::exchange(y.light, kNone));
  EXPECT_TRUE(p && q ? as_saved(*p) == as_saved(*q) : !p && !q) << "light of node " << i;
  EXPECT_TRUE(
      same(find(a.meshes, std::exchange(x.mesh, kNone)), find(b.meshes, std::exchange(y.mesh, kNone))))
      << "mesh of node " << i;
  EXPECT_TRUE(
      same(find(a.shapes, std::exchange(x.shape, kNone)), find(b.shapes, std::exchange(y.shape, kNone))))
      << "shape of node " << i;
  EXPECT_TRUE(x == y) << "node " << i;
}

/// But for the order of lists that have no meaning in it.
void expect_same_scene(const Scene& a, const Scene& b) {
  EXPECT_EQ(a.roots, b.roots);
  ASSERT_EQ(a.nodes.size(), b.nodes.size());
  for (std::size_t i = 0; i < a.nodes.size(); ++i) expect_same_node(a, b, i);
  ASSERT_EQ(a.materials.size(), b.materials.size());
  for (std::size_t i = 0; i < a.materials.size(); ++i)
    expect_same_material(a, a.materials[i], b, b.materials[i], fmt::format("material {}", i));
  ASSERT_EQ(a.cameras.size(), b.cameras.size());
  for (std::size_t i = 0; i < a.cameras.size(); ++i)
    EXPECT_TRUE(as_saved(a.cameras[i]) == as_saved(b.cameras[i])) << "camera " << i;
  EXPECT_EQ(a.environment.radiance, b.environment.radiance);
  EXPECT_EQ(a.environment.rotation, b.environment.rotation);
  const Image *p = find(a.images, a.environment.image), *q = find(b.images, b.environment.image);
  EXPECT_TRUE(p && q ? p->pixels == q->pixels : !p && !q) << "environment";
}

class Saved : public testing::Test {
 protected:
  Saved() : folder_(fs::temp_directory_path() / ("parian_saved_" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
  }
  ~Saved() override { fs::remove_all(folder_); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  Scene load(const std::string& file, std::vector<GltfSource>* sources = nullptr) const {
    std::vector<std::string> warnings;
    LoadSettings settings;
    settings.sources = sources;
    return load_gltf(file, settings, warnings);
  }
  /// The small images of the commands as files, which is where an editor has them from.
  Image image_file(std::uint8_t shade) const {
    const std::string file = path(fmt::format("image{}.png", shade));
    if (!fs::exists(file))
      write_display_image(
          {2, 1, {"R", "G", "B"}, {float(shade) / 255, 0.2f, 0.8f, 0.4f, float(shade) / 255, 0.9f}, {}},
          file);
    return read_image(file);
  }

  fs::path folder_;
};

// Caught: new bytes that stayed in the buffer where nothing used their view any more.
TEST_F(Saved, EveryHundredCommands) {
  for (const char* name : {"textured", "shapes-still-life"}) {
    SCOPED_TRACE(name);
    std::vector<GltfSource> sources;
    Scene scene = load(fmt::format("{}/scenes/{}/{}.gltf", PARIAN_SOURCE_DIR, name, name), &sources);
    RandomCommands commands(11, [this](std::uint8_t shade) { return image_file(shade); });
    int done = 0;
    for (int i = 1; i <= 2000; ++i) {
      try {
        commands.run(scene);
        ++done;
      } catch (const UsageError&) {
      }
      if (i % 100) continue;
      const std::string file = path(i % 200 ? "edited.glb" : "edited.gltf");
      write_gltf(scene, sources, file);
      expect_same_scene(load(file), scene);
      ASSERT_FALSE(HasFailure()) << "after " << i << " commands";
    }
    EXPECT_GT(done, 1000);
  }
}

}  // namespace
}  // namespace parian
