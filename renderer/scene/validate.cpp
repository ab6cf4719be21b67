#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "renderer/base/error.h"
#include "renderer/base/parallel.h"
#include "renderer/scene/scene.h"

namespace parian {
namespace {

constexpr std::size_t kChunk = std::size_t(1) << 16;
constexpr float kUnitTolerance = 1e-3f;  // of a squared length
constexpr std::size_t kMaxVertices = std::numeric_limits<std::uint32_t>::max();

bool all_finite(const Imath::M44f& m) {
  return std::all_of(&m[0][0], &m[0][0] + 16, [](float x) { return std::isfinite(x); });
}

bool is_rotation(const Quatf& q) {
  return std::abs(q.r * q.r + q.v.dot(q.v) - 1) <= kUnitTolerance;  // false for NaN
}

bool is_unit(const Vec3f& v) { return std::abs(v.dot(v) - 1) <= kUnitTolerance; }

class Validation {
 public:
  Validation(const Scene& scene, const std::string& file) : scene_(scene), file_(file) {}

  void run() {
    each("images", scene_.images, [&](const Image& image, auto where) { check_image(image, where); });
    each("textures", scene_.textures, [&](const Texture& texture, auto where) {
      check_index(texture.image, scene_.images.size(), where + "/image");
    });
    each("materials", scene_.materials, [&](const Material& m, auto where) { check_material(m, where); });
    each("meshes", scene_.meshes, [&](const Mesh& mesh, auto where) {
      each("primitives", mesh.primitives,
           [&](const Primitive& p, auto place) { check_primitive(p, where + place); });
    });
    each("cameras", scene_.cameras, [&](const Camera& camera, auto where) { check_camera(camera, where); });
    each("lights", scene_.lights, [&](const Light& light, auto where) { check_light(light, where); });
    each("nodes", scene_.nodes, [&](const Node& node, auto where) { check_node(node, where); });
    check_forest();
    check_environment();
  }

 private:
  [[noreturn]] void fail(const std::string& where, std::string_view expected) const {
    throw InputError(file_, where, expected);
  }

  template <class T, class Body>
  void each(const char* name, const std::vector<T>& items, const Body& body) const {
    for (std::size_t i = 0; i < items.size(); ++i) body(items[i], fmt::format("/{}/{}", name, i));
  }

  void check_index(int index, std::size_t size, const std::string& where) const {
    if (index < 0 || std::size_t(index) >= size)
      fail(where, fmt::format("expected an index below {}, not {}", size, index));
  }

  void check_optional_index(int index, std::size_t size, const std::string& where) const {
    if (index != kNone) check_index(index, size, where);
  }

  void check_range(float value, float low, float high, const std::string& where) const {
    if (value >= low && value <= high) return;  // false for NaN
    if (low == std::numeric_limits<float>::min())
      fail(where, fmt::format("expected a number above 0, not {}", value));
    if (high == std::numeric_limits<float>::max())
      fail(where, fmt::format("expected a number of at least {}, not {}", low, value));
    fail(where, fmt::format("expected a number in [{}, {}], not {}", low, high, value));
  }
  void check_finite(float value, const std::string& where) const {
    if (!std::isfinite(value)) fail(where, fmt::format("expected a finite number, not {}", value));
  }
  void check_positive(float value, const std::string& where) const {
    check_range(value, std::numeric_limits<float>::min(), std::numeric_limits<float>::max(), where);
  }
  void check_not_negative(float value, const std::string& where) const {
    check_range(value, 0, std::numeric_limits<float>::max(), where);
  }
  void check_color(const Rgb& color, float high, const std::string& where) const {
    for (const float value : {color.x, color.y, color.z}) check_range(value, 0, high, where);
  }

  void check_image(const Image& image, const std::string& where) const {
    if (image.width < 1 || image.height < 1) fail(where, "expected a size of at least 1 x 1");
    if (image.channels < 1 || image.channels > 4) fail(where, "expected 1 to 4 channels");
    const std::size_t bytes = image.type == PixelType::u8 ? 1 : image.type == PixelType::f32 ? 4 : 2;
    const std::size_t expected =
        std::size_t(image.width) * std::size_t(image.height) * std::size_t(image.channels) * bytes;
    if (image.pixels.size() != expected) fail(where + "/pixels", fmt::format("expected {} bytes", expected));
  }

  void check_texture(const TextureRef& ref, const std::string& where) const {
    check_optional_index(ref.texture, scene_.textures.size(), where + "/texture");
    if (ref.uv_set != 0 && ref.uv_set != 1) fail(where + "/uv_set", "expected 0 or 1");
    for (const float value : ref.transform) check_finite(value, where + "/transform");
  }

  void check_material(const Material& m, const std::string& where) const {
    constexpr float kMax = std::numeric_limits<float>::max();
    check_color(m.base_color, 1, where + "/base_color");
    check_range(m.alpha, 0, 1, where + "/alpha");
    check_range(m.metallic, 0, 1, where + "/metallic");
    check_range(m.roughness, 0, 1, where + "/roughness");
    check_finite(m.normal_scale, where + "/normal_scale");
    check_color(m.emission, kMax, where + "/emission");
    if (m.ior != 0) check_range(m.ior, 1, kMax, where + "/ior");
    check_range(m.specular, 0, 1, where + "/specular");
    check_color(m.specular_color, kMax, where + "/specular_color");
    check_not_negative(m.alpha_cutoff, where + "/alpha_cutoff");
    check_texture(m.base_color_texture, where + "/base_color_texture");
    check_texture(m.metallic_roughness_texture, where + "/metallic_roughness_texture");
    check_texture(m.normal_texture, where + "/normal_texture");
    check_texture(m.emission_texture, where + "/emission_texture");
    check_texture(m.specular_texture, where + "/specular_texture");
    check_texture(m.specular_color_texture, where + "/specular_color_texture");
  }

  /// Every element of the array, in parallel; once for an array that several primitives share.
  template <class T, class Predicate>
  void check_elements(const SharedArray<T>& array, const std::string& where, const char* expected,
                      const Predicate& holds) {
    if (array.empty() || !seen_.insert({array.data(), array.size()}).second) return;
    parallel_for((array.size() + kChunk - 1) / kChunk, 1, [&](std::size_t chunk) {
      const std::size_t end = std::min(array.size(), (chunk + 1) * kChunk);
      for (std::size_t i = chunk * kChunk; i < end; ++i) {
        if (!holds(array[i])) fail(fmt::format("{}/{}", where, i), expected);
      }
    });
  }

  template <class T>
  void check_length(const SharedArray<T>& array, const Primitive& primitive, const std::string& where) const {
    if (array.empty() || array.size() == primitive.positions.size()) return;
    fail(where, fmt::format("expected {} elements, one per vertex, not {}", primitive.positions.size(),
                            array.size()));
  }

  void check_primitive(const Primitive& p, const std::string& where) {
    check_index(p.material, scene_.materials.size(), where + "/material");
    if (p.positions.size() > kMaxVertices) fail(where + "/positions", "expected fewer than 2^32 vertices");
    check_length(p.normals, p, where + "/normals");
    check_length(p.tangents, p, where + "/tangents");
    check_length(p.colors, p, where + "/colors");
    check_elements(p.positions, where + "/positions", "expected finite numbers", is_finite);
    check_elements(p.normals, where + "/normals", "expected a unit vector", is_unit);
    check_elements(p.tangents, where + "/tangents", "expected a unit vector, and w of 1 or -1",
                   [](const Vec4f& t) {
                     return is_unit({t.x, t.y, t.z}) && std::abs(t.w) == 1;
                   });
    check_elements(p.colors, where + "/colors", "expected finite numbers of at least 0", [](const Vec4f& c) {
      return std::ranges::all_of(std::array{c.x, c.y, c.z, c.w},
                                 [](float x) { return x >= 0 && std::isfinite(x); });
    });
    for (std::size_t set = 0; set < p.uvs.size(); ++set) {
      const std::string place = fmt::format("{}/uvs/{}", where, set);
      check_length(p.uvs[set], p, place);
      check_elements(p.uvs[set], place, "expected finite numbers",
                     [](const Vec2f& uv) { return std::isfinite(uv.x) && std::isfinite(uv.y); });
    }
    check_triangles(p, where + "/triangles");
  }

  // Not check_elements(): two primitives may share triangles but not vertices.
  void check_triangles(const Primitive& p, const std::string& where) {
    const std::size_t vertices = p.positions.size();
    const auto [known, is_new] =
        triangles_for_.try_emplace({p.triangles.data(), p.triangles.size()}, vertices);
    if (!is_new && known->second <= vertices) return;
    known->second = vertices;
    parallel_for((p.triangles.size() + kChunk - 1) / kChunk, 1, [&](std::size_t chunk) {
      const std::size_t end = std::min(p.triangles.size(), (chunk + 1) * kChunk);
      for (std::size_t i = chunk * kChunk; i < end; ++i) {
        const auto& [a, b, c] = p.triangles[i];
        if (std::max({a, b, c}) >= vertices) {
          fail(fmt::format("{}/{}", where, i),
               fmt::format("expected vertices below {}, not {}", vertices, std::max({a, b, c})));
        }
      }
    });
  }

  void check_camera(const Camera& camera, const std::string& where) const {
    if (camera.projection == Projection::perspective) {
      check_range(camera.yfov, 1e-6f, std::nextafter(kPi, 0.0f), where + "/yfov");
      check_not_negative(camera.aspect, where + "/aspect");
    } else {
      check_positive(camera.xmag, where + "/xmag");
      check_positive(camera.ymag, where + "/ymag");
    }
    check_not_negative(camera.znear, where + "/znear");
    check_not_negative(camera.zfar, where + "/zfar");
    if (!camera.lens) return;
    check_positive(camera.lens->focal_length, where + "/lens/focal_length");
    check_positive(camera.lens->f_stop, where + "/lens/f_stop");
    check_positive(camera.lens->focus_distance, where + "/lens/focus_distance");
    for (const float side : camera.lens->sensor_size) check_positive(side, where + "/lens/sensor_size");
  }

  void check_light(const Light& light, const std::string& where) const {
    check_color(light.color, std::numeric_limits<float>::max(), where + "/color");
    check_not_negative(light.intensity, where + "/intensity");
    check_not_negative(light.range, where + "/range");
    if (light.kind == LightKind::spot) {
      check_range(light.outer_angle, std::numeric_limits<float>::min(), kPi / 2, where + "/outer_angle");
      check_range(light.inner_angle, 0, std::nextafter(light.outer_angle, 0.0f), where + "/inner_angle");
    }
    if (light.kind == LightKind::rectangle || light.kind == LightKind::disk) {
      check_positive(light.width, where + "/width");
      check_positive(light.height, where + "/height");
    }
  }

  void check_transform(const Transform& t, const std::string& where) const {
    if (!is_finite(t.translation)) fail(where + "/translation", "expected finite numbers");
    if (!is_rotation(t.rotation)) fail(where + "/rotation", "expected a unit quaternion");
    if (!is_finite(t.scale)) fail(where + "/scale", "expected finite numbers");
    if (!t.matrix) return;
    const Imath::M44f& m = *t.matrix;
    if (!all_finite(m)) fail(where + "/matrix", "expected finite numbers");
    if (m[0][3] != 0 || m[1][3] != 0 || m[2][3] != 0 || m[3][3] != 1)
      fail(where + "/matrix", "expected an affine matrix");
  }

  void check_node(const Node& node, const std::string& where) const {
    check_transform(node.transform, where + "/transform");
    for (std::size_t i = 0; i < node.instances.size(); ++i) {
      check_transform(node.instances[i], fmt::format("{}/instances/{}", where, i));
    }
    check_optional_index(node.mesh, scene_.meshes.size(), where + "/mesh");
    check_optional_index(node.camera, scene_.cameras.size(), where + "/camera");
    check_optional_index(node.light, scene_.lights.size(), where + "/light");
    for (std::size_t i = 0; i < node.children.size(); ++i) {
      check_index(node.children[i], scene_.nodes.size(), fmt::format("{}/children/{}", where, i));
    }
  }

  // One parent at most, so that a walk from the nodes without one reaches all but cycles. No recursion: a
  // chain of nodes may be as deep as the file is long.
  void check_forest() const {
    std::vector<bool> taken(scene_.nodes.size(), false), reached(scene_.nodes.size(), false);
    for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
      for (std::size_t c = 0; c < scene_.nodes[i].children.size(); ++c) {
        const auto child = std::size_t(scene_.nodes[i].children[c]);
        if (taken[child])
          fail(fmt::format("/nodes/{}/children/{}", i, c), "expected a node without another parent");
        taken[child] = true;
      }
    }
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < taken.size(); ++i) {
      if (!taken[i]) open.push_back(i);
    }
    while (!open.empty()) {
      const std::size_t node = open.back();
      open.pop_back();
      reached[node] = true;
      for (const int child : scene_.nodes[node].children) open.push_back(std::size_t(child));
    }
    for (std::size_t i = 0; i < reached.size(); ++i) {
      if (!reached[i]) fail(fmt::format("/nodes/{}/children", i), "expected no cycle");
    }
    for (std::size_t i = 0; i < scene_.roots.size(); ++i) {
      const std::string where = fmt::format("/roots/{}", i);
      check_index(scene_.roots[i], scene_.nodes.size(), where);
      // A root counts as taken once it is listed.
      if (taken[std::size_t(scene_.roots[i])]) fail(where, "expected a node without a parent, listed once");
      taken[std::size_t(scene_.roots[i])] = true;
    }
  }

  void check_environment() const {
    check_color(scene_.environment.radiance, std::numeric_limits<float>::max(), "/environment/radiance");
    check_optional_index(scene_.environment.image, scene_.images.size(), "/environment/image");
    if (!is_rotation(scene_.environment.rotation))
      fail("/environment/rotation", "expected a unit quaternion");
  }

  const Scene& scene_;
  const std::string& file_;
  std::set<std::pair<const void*, std::size_t>> seen_;
  std::map<std::pair<const void*, std::size_t>, std::size_t>
      triangles_for_;  // to the vertices they were checked for
};

}  // namespace

void validate(const Scene& scene, const std::string& file) { Validation(scene, file).run(); }

}  // namespace parian
