/// A scene with something of everything, sessions over it, and their pictures bit by bit.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <vector>

#include "integrators/integrators.h"
#include "renderer/session/session.h"
#include "tests/integrators/support/shapes.h"

namespace parian {

/// Something of everything: a textured floor, boxes drawn once and twice, a blended pane, lights of all
/// kinds, a lens, solids that emit, reflect and blend, a box without a mesh.
inline Scene everything() {
  Scene scene;
  Material checks = make_lambert({0.8f, 0.8f, 0.8f});
  checks.base_color_texture = add_texture(
      scene, make_image(2, 2, 3, PixelType::u8,
                        std::vector<std::uint8_t>{255, 255, 255, 90, 40, 20, 60, 90, 160, 255, 255, 255}));
  Material pane = make_lambert({0.2f, 0.9f, 0.3f});
  pane.alpha_mode = AlphaMode::blend;
  pane.alpha = 0.5f;
  add_mesh(scene, make_quad({0, 0, 0}, {3, 0, 0}, {0, 0, -3}), add_material(scene, checks));  // 0
  add_mesh(scene, make_box({0, 0, 0}, {0.6f, 0.6f, 0.6f}), add_material(scene, Material{}),
           translate({-1, 0, -0.5f}));  // 1
  Node second = scene.nodes[1];
  second.transform = translate({0.5f, 0.1f, -1});
  second.transform.rotation = Quatf(0.9f, 0, 0.4f, 0).normalized();
  add_root(scene, second);                                                                             // 2
  add_mesh(scene, make_quad({0, 0.6f, 0.3f}, {0.5f, 0, 0}, {0, 0.5f, 0}), add_material(scene, pane));  // 3
  add_mesh(scene, make_uv_sphere({0, 0, 0}, 0.2f, 8), add_material(scene, make_emitter({3, 2, 1})),
           translate({1.2f, 0.8f, 0}));  // 4
  add_light(scene, make_area_light(LightKind::disk, 6, 0.8f),
            look_along({-1, 2, 1}, normalize(Vec3f(0.5f, -1, -0.5f))));  // 5
  Light point;
  point.intensity = 2;
  add_light(scene, point, translate({0, 1.5f, 1}));  // 6
  scene.environment.radiance = Rgb(0.1f, 0.15f, 0.3f);
  Camera camera;
  camera.yfov = 0.7f;
  camera.lens = Lens{};
  camera.lens->focus_distance = 4;
  add_camera(scene, camera, look_along({1, 1.5f, 4}, normalize(Vec3f(-0.25f, -0.3f, -1))));  // 7
  add_shape(scene, make_sphere(0.25f), add_material(scene, make_emitter({1, 3, 2})),
            translate({0.2f, 0.4f, 0.9f}));                                                       // 8
  add_shape(scene, make_cylinder(0.3f, 0.1f, 0.6f), 1, translate({-0.6f, 0.3f, 0.9f}));           // 9
  add_shape(scene, make_flat_shape(ShapeKind::box, Vec3f(0.3f)), 1, translate({1, 0.2f, 0.6f}));  // 10
  add_shape(scene, make_sphere(0.2f), 2, translate({-0.2f, 0.9f, 0.6f}));                         // 11
  return scene;
}

/// A small picture whose sides no tile size divides, with all layers.
inline RenderSettings small(std::uint32_t spp = 7) {
  RenderSettings s;
  s.width = 53;
  s.height = 37;
  s.spp = spp;
  s.seed = 5;
  s.layers = {true, true, true};
  return s;
}

/// A session over a valid scene, with the path integrator.
inline Session make_session(const Scene& scene, const RenderSettings& settings) {
  validate(scene, "test scene");
  return Session(std::make_shared<const Scene>(scene), settings, make_integrator("path", {}));
}

/// Renders to the end.
inline Picture finish(Session& session) {
  session.start();
  session.wait();
  return session.snapshot();
}

/// The finished picture of everything().
inline Picture render_everything(const RenderSettings& settings) {
  Session session = make_session(everything(), settings);
  return finish(session);
}

/// Whether two pictures have the same layers and the same values, to the bit.
inline testing::AssertionResult same_bits(const Picture& a, const Picture& b) {
  if (a.channels != b.channels || a.pixels.size() != b.pixels.size())
    return testing::AssertionFailure() << "other layers";
  std::size_t differ = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    differ += std::memcmp(&a.pixels[i], &b.pixels[i], sizeof(float)) != 0;
  if (!differ) return testing::AssertionSuccess();
  return testing::AssertionFailure() << differ << " of " << a.pixels.size() << " values differ";
}

}  // namespace parian
