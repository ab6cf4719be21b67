#include "scene_io/statistics.h"

#include <fmt/format.h>

#include <algorithm>

#include "renderer/base/memory.h"

namespace parian {
namespace {

std::size_t bytes_of(const Primitive& p) {
  return p.positions.bytes() + p.normals.bytes() + p.tangents.bytes() + p.uvs[0].bytes() + p.uvs[1].bytes() +
         p.colors.bytes() + p.triangles.bytes();
}

const char* pixel_type_name(PixelType type) {
  switch (type) {
    case PixelType::u8:
      return "8-bit";
    case PixelType::u16:
      return "16-bit";
    case PixelType::f16:
      return "half";
    case PixelType::f32:
      return "float";
  }
  return "";
}

/// What the materials have beyond metallic-roughness, and how many of them have it; empty where none has any.
std::string describe_features(const std::vector<Material>& materials) {
  std::string text;
  const auto add = [&](const char* name, const auto& has) {
    if (const auto count = std::ranges::count_if(materials, has))
      text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, name);
  };
  add("transmission", [](const Material& m) { return m.transmission.has_value(); });
  add("volume", [](const Material& m) { return m.volume.has_value(); });
  add("volume scatter", [](const Material& m) { return m.scatter.has_value(); });
  add("dispersion", [](const Material& m) { return m.dispersion > 0; });
  add("priority", [](const Material& m) { return m.priority != 0; });
  add("diffuse transmission", [](const Material& m) { return m.diffuse_transmission.has_value(); });
  add("clearcoat", [](const Material& m) { return m.clearcoat.has_value(); });
  add("sheen", [](const Material& m) { return m.sheen.has_value(); });
  add("anisotropy", [](const Material& m) { return m.anisotropy.has_value(); });
  add("iridescence", [](const Material& m) { return m.iridescence.has_value(); });
  add("Phong", [](const Material& m) { return m.phong.has_value(); });
  add("conductor", [](const Material& m) { return m.conductor.has_value(); });
  add("subsurface", [](const Material& m) { return m.subsurface.has_value(); });
  return text;
}

}  // namespace

SceneStatistics scene_statistics(const Scene& scene, const World& world) {
  SceneStatistics s;
  for (const Part& part : world.parts) {
    s.triangles_stored += part.primitive->triangles.size();
    s.vertices += part.primitive->positions.size();
    s.geometry_bytes += bytes_of(*part.primitive);
    s.alpha_primitives += part.alpha;
  }
  s.primitives = world.parts.size();
  s.placements = world.placements.size();
  for (const Placement& p : world.placements)
    for (std::uint32_t i = 0; i < p.part_count; ++i) {
      const Part& part = world.parts[p.first_part + i];
      s.triangles_drawn += part.primitive->triangles.size();
      if (part.emissive) s.emissive_triangles += part.primitive->triangles.size();
    }
  s.solids = world.solids.size();
  for (const PlacedSolid& solid : world.solids) s.emissive_solids += world.solid_parts[solid.part].emissive;
  for (const Part& part : world.solid_parts) s.alpha_primitives += part.alpha;
  for (const Image& image : scene.images)
    (image.source ? s.cached_image_bytes : s.image_bytes) += image_bytes(image);
  return s;
}

std::string describe(const Scene& scene, const World& world) {
  const SceneStatistics s = scene_statistics(scene, world);
  std::string text;
  const auto line = [&](std::string_view name, const std::string& value) {
    text += fmt::format("{:<12} {}\n", name, value);
  };
  line("triangles", fmt::format("{} stored in {} meshes, {} drawn by {} placements", s.triangles_stored,
                                scene.meshes.size(), s.triangles_drawn, s.placements));
  if (s.solids) line("solids", fmt::format("{} spheres, cylinders and cones", s.solids));
  if (!world.bounds.isEmpty()) {
    const Vec3f size = world.bounds.size(), center = world.bounds.center();
    line("bounds", fmt::format("{:.4g} x {:.4g} x {:.4g} m around ({:.4g}, {:.4g}, {:.4g})", size.x, size.y,
                               size.z, center.x, center.y, center.z));
  }
  line("materials",
       fmt::format("{}, {} primitives tested for alpha", scene.materials.size(), s.alpha_primitives));
  if (const std::string features = describe_features(scene.materials); !features.empty())
    line("with", features);
  line("lights",
       fmt::format("{} emissive triangles, {} emissive solids, {} rectangles and disks, {} punctual, {}",
                   s.emissive_triangles, s.emissive_solids, world.area_lights.size(),
                   world.punctual_lights.size(),
                   is_black(scene.environment.radiance) ? "no environment"
                   : scene.environment.image == kNone   ? "a constant environment"
                                                        : "an environment map"));
  for (std::size_t i = 0; i < world.cameras.size(); ++i) {
    const Camera& camera = scene.cameras[world.cameras[i].camera];
    const std::string& node = scene.nodes[world.cameras[i].node].name;
    line(fmt::format("camera {}", i),
         fmt::format("\"{}\", {}{}", node.empty() ? camera.name : node,
                     camera.projection == Projection::perspective ? "perspective" : "orthographic",
                     camera.lens ? ", thin lens" : ""));
  }
  for (const Image& image : scene.images)
    line("image", fmt::format("{}: {}x{}, {} channels, {}, {}{}", image.name, image.width, image.height,
                              image.channels, pixel_type_name(image.type),
                              format_bytes(double(image_bytes(image))), image.source ? ", cached" : ""));
  line("memory", fmt::format("{} geometry, {} images", format_bytes(double(s.geometry_bytes)),
                             format_bytes(double(s.image_bytes))));
  if (s.cached_image_bytes)
    line("cached", fmt::format("{} images more, in a temporary file, of which the cache holds a part",
                               format_bytes(double(s.cached_image_bytes))));
  return text;
}

}  // namespace parian
