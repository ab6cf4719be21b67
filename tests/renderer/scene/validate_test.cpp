#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "renderer/base/error.h"
#include "renderer/scene/scene.h"
#include "tests/support/scenes.h"

namespace parian {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

Scene good_scene() {
  Scene scene;
  scene.images.resize(1);
  scene.images[0] = {.name = "i",
                     .width = 2,
                     .height = 1,
                     .channels = 3,
                     .type = PixelType::f16,
                     .pixels = std::vector<std::byte>(12)};
  scene.textures.emplace_back().image = 0;
  scene.materials.emplace_back().normal_texture.texture = 0;
  Primitive p;
  p.positions = std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  p.normals = std::vector<Vec3f>(3, Vec3f(0, 0, 1));
  p.tangents = std::vector<Vec4f>(3, Vec4f(1, 0, 0, -1));
  p.uvs[1] = std::vector<Vec2f>(3, Vec2f(0));
  p.colors = std::vector<Vec4f>(3, Vec4f(1));
  p.triangles = std::vector<Triangle>{{0, 1, 2}, {2, 1, 0}};
  p.material = 0;
  scene.meshes.resize(1);
  scene.meshes[0].primitives = {p};
  scene.cameras.resize(2);
  scene.cameras[0].lens = Lens();
  scene.cameras[1].projection = Projection::orthographic;
  scene.lights.resize(3);
  scene.lights[1].kind = LightKind::spot;
  scene.lights[2].kind = LightKind::rectangle;
  scene.shapes.resize(4);
  scene.shapes[1].kind = ShapeKind::cylinder;
  scene.shapes[2].kind = ShapeKind::box;
  scene.shapes[3].kind = ShapeKind::plane;
  scene.nodes.resize(3);
  scene.nodes[2].shape = scene.nodes[2].shape_material = 0;
  scene.nodes[0].children = {1};
  scene.nodes[1].mesh = scene.nodes[1].camera = scene.nodes[1].light = 0;
  scene.nodes[1].instances = instances({Transform(), Transform()});
  scene.nodes[2].transform.matrix = Imath::M44f();
  scene.roots = {0, 2};
  return scene;
}

std::string refusal(const Scene& scene) {
  try {
    validate(scene, "s");
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

Primitive& primitive(Scene& scene) { return scene.meshes[0].primitives[0]; }

TEST(Validate, AcceptsGoodScenes) {
  EXPECT_EQ(refusal(good_scene()), "");
  EXPECT_EQ(refusal(Scene()), "");
}

using Change = std::pair<std::function<void(Scene&)>, std::string>;

void expect_refused(const std::vector<Change>& changes) {
  for (const auto& [change, place] : changes) {
    Scene scene = good_scene();
    change(scene);
    const std::string expected = "s: " + place + ": expected", message = refusal(scene);
    EXPECT_EQ(message.substr(0, expected.size()), expected) << message;
  }
}

TEST(Validate, RefusesBadTables) {
  expect_refused({
      {[](Scene& s) { s.images[0].width = 0; }, "/images/0"},
      {[](Scene& s) { s.images[0].channels = 5; }, "/images/0"},
      {[](Scene& s) { s.images[0].type = PixelType::f32; }, "/images/0/pixels"},
      {[](Scene& s) { s.textures[0].image = 1; }, "/textures/0/image"},
      {[](Scene& s) { s.textures[0].image = kNone; }, "/textures/0/image"},
      {[](Scene& s) { s.materials[0].base_color.y = 1.5f; }, "/materials/0/base_color"},
      {[](Scene& s) { s.materials[0].alpha = -1; }, "/materials/0/alpha"},
      {[](Scene& s) { s.materials[0].metallic = kNan; }, "/materials/0/metallic"},
      {[](Scene& s) { s.materials[0].roughness = 2; }, "/materials/0/roughness"},
      {[](Scene& s) { s.materials[0].normal_scale = kInfinity; }, "/materials/0/normal_scale"},
      {[](Scene& s) { s.materials[0].emission.z = kInfinity; }, "/materials/0/emission"},
      {[](Scene& s) { s.materials[0].ior = 0.5f; }, "/materials/0/ior"},
      {[](Scene& s) { s.materials[0].specular = 2; }, "/materials/0/specular"},
      {[](Scene& s) { s.materials[0].specular_color.x = -1; }, "/materials/0/specular_color"},
      {[](Scene& s) { s.materials[0].alpha_cutoff = kNan; }, "/materials/0/alpha_cutoff"},
      {[](Scene& s) { s.materials[0].base_color_texture.texture = 1; },
       "/materials/0/base_color_texture/texture"},
      {[](Scene& s) { s.materials[0].metallic_roughness_texture.texture = -2; },
       "/materials/0/metallic_roughness_texture/texture"},
      {[](Scene& s) { s.materials[0].normal_texture.uv_set = 2; }, "/materials/0/normal_texture/uv_set"},
      {[](Scene& s) { s.materials[0].emission_texture.transform[3] = kNan; },
       "/materials/0/emission_texture/transform"},
      {[](Scene& s) { s.materials[0].specular_texture.texture = 9; },
       "/materials/0/specular_texture/texture"},
      {[](Scene& s) { s.materials[0].specular_color_texture.texture = 9; },
       "/materials/0/specular_color_texture/texture"},
      {[](Scene& s) { s.environment.radiance.x = kNan; }, "/environment/radiance"},
      {[](Scene& s) { s.environment.image = 1; }, "/environment/image"},
      {[](Scene& s) { s.environment.rotation = Quatf(0, 0, 0, 0); }, "/environment/rotation"},
  });
}

// With every group that a material may have.
Material& full_material(Scene& scene) {
  Material& m = scene.materials[0];
  m.transmission.emplace();
  m.volume.emplace();
  m.scatter.emplace();
  m.diffuse_transmission.emplace();
  m.clearcoat.emplace();
  m.sheen.emplace();
  m.anisotropy.emplace();
  m.iridescence.emplace().thickness_minimum = 1000;  // may be above the maximum
  m.phong.emplace();
  m.dispersion = 5;
  m.priority = -1;
  return m;
}

TEST(Validate, RefusesBadMaterialGroups) {
  Scene good = good_scene();
  full_material(good);
  EXPECT_EQ(refusal(good), "");
  const std::vector<std::pair<std::function<void(Material&)>, std::string>> changes = {
      {[](Material& m) { m.transmission->factor = 1.5f; }, "transmission/factor"},
      {[](Material& m) { m.transmission->texture.texture = 1; }, "transmission/texture/texture"},
      {[](Material& m) { m.volume->thickness = -1; }, "volume/thickness"},
      {[](Material& m) { m.volume->attenuation_color.y = 2; }, "volume/attenuation_color"},
      {[](Material& m) { m.volume->attenuation_distance = kInfinity; }, "volume/attenuation_distance"},
      {[](Material& m) { m.scatter->multiscatter_color.y = 1.5f; }, "scatter/multiscatter_color"},
      {[](Material& m) { m.scatter->anisotropy = 1; }, "scatter/anisotropy"},
      {[](Material& m) { m.scatter->anisotropy = -1; }, "scatter/anisotropy"},
      {[](Material& m) { m.scatter->anisotropy = kNan; }, "scatter/anisotropy"},
      {[](Material& m) { m.volume.reset(); }, "scatter"},
      {[](Material& m) { m.diffuse_transmission->factor = kNan; }, "diffuse_transmission/factor"},
      {[](Material& m) { m.diffuse_transmission->color.z = -1; }, "diffuse_transmission/color"},
      {[](Material& m) { m.diffuse_transmission->texture.texture = 1; },
       "diffuse_transmission/texture/texture"},
      {[](Material& m) { m.diffuse_transmission->color_texture.texture = 1; },
       "diffuse_transmission/color_texture/texture"},
      {[](Material& m) { m.clearcoat->factor = 2; }, "clearcoat/factor"},
      {[](Material& m) { m.clearcoat->roughness = -1; }, "clearcoat/roughness"},
      {[](Material& m) { m.clearcoat->texture.texture = 1; }, "clearcoat/texture/texture"},
      {[](Material& m) { m.clearcoat->roughness_texture.uv_set = 2; }, "clearcoat/roughness_texture/uv_set"},
      {[](Material& m) { m.clearcoat->normal_texture.texture = 1; }, "clearcoat/normal_texture/texture"},
      {[](Material& m) { m.clearcoat->normal_scale = kNan; }, "clearcoat/normal_scale"},
      {[](Material& m) { m.sheen->color.x = 1.5f; }, "sheen/color"},
      {[](Material& m) { m.sheen->roughness = 2; }, "sheen/roughness"},
      {[](Material& m) { m.sheen->color_texture.texture = 1; }, "sheen/color_texture/texture"},
      {[](Material& m) { m.sheen->roughness_texture.texture = 1; }, "sheen/roughness_texture/texture"},
      {[](Material& m) { m.anisotropy->strength = -1; }, "anisotropy/strength"},
      {[](Material& m) { m.anisotropy->rotation = kInfinity; }, "anisotropy/rotation"},
      {[](Material& m) { m.anisotropy->texture.transform[0] = kNan; }, "anisotropy/texture/transform"},
      {[](Material& m) { m.iridescence->factor = 2; }, "iridescence/factor"},
      {[](Material& m) { m.iridescence->ior = 0; }, "iridescence/ior"},
      {[](Material& m) { m.iridescence->thickness_minimum = -1; }, "iridescence/thickness_minimum"},
      {[](Material& m) { m.iridescence->thickness_maximum = kNan; }, "iridescence/thickness_maximum"},
      {[](Material& m) { m.iridescence->texture.texture = 1; }, "iridescence/texture/texture"},
      {[](Material& m) { m.iridescence->thickness_texture.texture = 1; },
       "iridescence/thickness_texture/texture"},
      {[](Material& m) { m.phong->diffuse.x = 2; }, "phong/diffuse"},
      {[](Material& m) { m.phong->specular.x = kNan; }, "phong/specular"},
      {[](Material& m) { m.phong->exponent = -1; }, "phong/exponent"},
      {[](Material& m) { m.conductor.emplace(); }, "phong"},
      {[](Material& m) {
         m.phong.reset();
         m.conductor.emplace().eta.y = -1;
       },
       "conductor/eta"},
      {[](Material& m) {
         m.phong.reset();
         m.conductor.emplace().k.z = kInfinity;
       },
       "conductor/k"},
      {[](Material& m) { m.subsurface.emplace(); }, "subsurface"},
      {[](Material& m) {
         m.phong.reset();
         m.conductor.emplace();
         m.subsurface.emplace();
       },
       "subsurface"},
      {[](Material& m) {
         m.phong.reset();
         m.subsurface.emplace().absorption.y = -1;
       },
       "subsurface/absorption"},
      {[](Material& m) {
         m.phong.reset();
         m.subsurface.emplace().reduced_scattering.z = kInfinity;
       },
       "subsurface/reduced_scattering"},
      {[](Material& m) { m.dispersion = -1; }, "dispersion"},
      {[](Material& m) { m.ior = kInfinity; }, "ior"},
  };
  for (const auto& [change, place] : changes) {
    expect_refused({{[&](Scene& s) { change(full_material(s)); }, "/materials/0/" + place}});
  }
}

TEST(Validate, RefusesBadMeshes) {
  const std::string place = "/meshes/0/primitives/0";
  expect_refused({
      {[](Scene& s) { primitive(s).material = kNone; }, place + "/material"},
      {[](Scene& s) { primitive(s).material = 1; }, place + "/material"},
      {[](Scene& s) {
         primitive(s).positions = std::vector<Vec3f>{Vec3f(0), Vec3f(0, kNan, 0), Vec3f(0)};
       },
       place + "/positions/1"},
      {[](Scene& s) {
         primitive(s).positions = std::vector<Vec3f>{Vec3f(0), Vec3f(0), Vec3f(0), Vec3f(0)};
       },
       place + "/normals"},
      {[](Scene& s) { primitive(s).normals = std::vector<Vec3f>(3, Vec3f(0, 0, 1.1f)); },
       place + "/normals/0"},
      {[](Scene& s) { primitive(s).tangents = std::vector<Vec4f>(2, Vec4f(1, 0, 0, 1)); },
       place + "/tangents"},
      {[](Scene& s) { primitive(s).tangents = std::vector<Vec4f>(3, Vec4f(1, 0, 0, 0)); },
       place + "/tangents/0"},
      {[](Scene& s) { primitive(s).uvs[0] = std::vector<Vec2f>(1); }, place + "/uvs/0"},
      {[](Scene& s) { primitive(s).uvs[1] = std::vector<Vec2f>(3, Vec2f(0, kInfinity)); },
       place + "/uvs/1/0"},
      {[](Scene& s) { primitive(s).colors = std::vector<Vec4f>(4, Vec4f(1)); }, place + "/colors"},
      {[](Scene& s) { primitive(s).colors = std::vector<Vec4f>(3, Vec4f(1, 1, 1, -1)); },
       place + "/colors/0"},
      {[](Scene& s) {
         primitive(s).triangles = std::vector<Triangle>{{0, 1, 2}, {0, 3, 1}};
       },
       place + "/triangles/1"},
  });
}

TEST(Validate, ChecksSharedTrianglesAgainstEachPrimitive) {
  Scene scene = good_scene();
  Primitive smaller = primitive(scene);
  smaller.positions = std::vector<Vec3f>(2);
  smaller.normals = {};
  smaller.tangents = {};
  smaller.colors = {};
  smaller.uvs = {};
  scene.meshes[0].primitives.push_back(smaller);
  EXPECT_EQ(refusal(scene).substr(0, 40), "s: /meshes/0/primitives/1/triangles/0: e");
}

TEST(Validate, ChecksOneArrayInEachOfItsUses) {
  Scene scene = good_scene();
  primitive(scene).normals = primitive(scene).positions;  // fine as positions, not as normals
  EXPECT_EQ(refusal(scene), "s: /meshes/0/primitives/0/normals/0: expected a unit vector");
}

// Beyond the first chunk of the parallel loop.
TEST(Validate, FindsOneBadVertexAmongMany) {
  Scene scene = good_scene();
  std::vector<Vec3f> positions(300'000, Vec3f(0));
  positions[234'567].z = kNan;
  Primitive p;
  p.positions = std::move(positions);
  p.material = 0;
  scene.meshes[0].primitives = {p};
  EXPECT_EQ(refusal(scene), "s: /meshes/0/primitives/0/positions/234567: expected finite numbers");
}

TEST(Validate, RefusesBadCamerasAndLights) {
  expect_refused({
      {[](Scene& s) { s.cameras[0].yfov = 0; }, "/cameras/0/yfov"},
      {[](Scene& s) { s.cameras[0].yfov = kPi; }, "/cameras/0/yfov"},
      {[](Scene& s) { s.cameras[0].aspect = -1; }, "/cameras/0/aspect"},
      {[](Scene& s) { s.cameras[0].znear = kNan; }, "/cameras/0/znear"},
      {[](Scene& s) { s.cameras[0].lens->focal_length = 0; }, "/cameras/0/lens/focal_length"},
      {[](Scene& s) { s.cameras[0].lens->f_stop = 0; }, "/cameras/0/lens/f_stop"},
      {[](Scene& s) { s.cameras[0].lens->focus_distance = -1; }, "/cameras/0/lens/focus_distance"},
      {[](Scene& s) { s.cameras[0].lens->sensor_size[1] = kNan; }, "/cameras/0/lens/sensor_size"},
      {[](Scene& s) { s.cameras[1].xmag = 0; }, "/cameras/1/xmag"},
      {[](Scene& s) { s.cameras[1].ymag = kInfinity; }, "/cameras/1/ymag"},
      {[](Scene& s) { s.lights[0].color.x = -1; }, "/lights/0/color"},
      {[](Scene& s) { s.lights[0].intensity = kInfinity; }, "/lights/0/intensity"},
      {[](Scene& s) { s.lights[0].range = -1; }, "/lights/0/range"},
      {[](Scene& s) { s.lights[1].outer_angle = 1.6f; }, "/lights/1/outer_angle"},
      {[](Scene& s) { s.lights[1].outer_angle = 0; }, "/lights/1/outer_angle"},
      {[](Scene& s) { s.lights[1].inner_angle = s.lights[1].outer_angle; }, "/lights/1/inner_angle"},
      {[](Scene& s) { s.lights[2].width = 0; }, "/lights/2/width"},
      {[](Scene& s) { s.lights[2].height = kNan; }, "/lights/2/height"},
  });
}

TEST(Validate, RefusesBadShapes) {
  expect_refused({
      {[](Scene& s) { s.shapes[0].radius = 0; }, "/shapes/0/radius"},
      {[](Scene& s) { s.shapes[0].radius = -1; }, "/shapes/0/radius"},
      {[](Scene& s) { s.shapes[0].radius = kNan; }, "/shapes/0/radius"},
      {[](Scene& s) { s.shapes[0].radius = 1e-39f; }, "/shapes/0/radius"},  // no normal float
      {[](Scene& s) { s.shapes[1].radius_top = -1; }, "/shapes/1/radius_top"},
      {[](Scene& s) { s.shapes[1].radius_bottom = kNan; }, "/shapes/1/radius_bottom"},
      {[](Scene& s) { s.shapes[1].radius_bottom = s.shapes[1].radius_top = 0; }, "/shapes/1/radius_top"},
      {[](Scene& s) { s.shapes[1].height = 0; }, "/shapes/1/height"},
      {[](Scene& s) { s.shapes[2].size.y = 0; }, "/shapes/2/size"},
      {[](Scene& s) { s.shapes[3].size.z = kInfinity; }, "/shapes/3/size"},
  });
  Scene scene = good_scene();
  scene.shapes[3].size.y = 0;  // a plane has no height
  scene.shapes[1].radius_top = 0;
  EXPECT_EQ(refusal(scene), "");
}

TEST(Validate, RefusesBadNodes) {
  expect_refused({
      {[](Scene& s) { s.nodes[2].shape = 4; }, "/nodes/2/shape"},
      {[](Scene& s) { s.nodes[2].shape_material = kNone; }, "/nodes/2/shape_material"},
      {[](Scene& s) { s.nodes[2].shape_material = 1; }, "/nodes/2/shape_material"},
      {[](Scene& s) { s.nodes[0].transform.translation.x = kNan; }, "/nodes/0/transform/translation"},
      {[](Scene& s) { s.nodes[0].transform.rotation = Quatf(2, 0, 0, 0); }, "/nodes/0/transform/rotation"},
      {[](Scene& s) { s.nodes[0].transform.scale.y = kInfinity; }, "/nodes/0/transform/scale"},
      {[](Scene& s) { (*s.nodes[2].transform.matrix)[3][0] = kNan; }, "/nodes/2/transform/matrix"},
      {[](Scene& s) { (*s.nodes[2].transform.matrix)[0][3] = 1; }, "/nodes/2/transform/matrix"},
      {[](Scene& s) {
         s.nodes[1].instances = instances({Transform(), scale({kNan, 1, 1})});
       },
       "/nodes/1/instances/1/scale"},
      {[](Scene& s) { s.nodes[1].mesh = 1; }, "/nodes/1/mesh"},
      {[](Scene& s) { s.nodes[1].camera = -5; }, "/nodes/1/camera"},
      {[](Scene& s) { s.nodes[1].light = 3; }, "/nodes/1/light"},
      {[](Scene& s) { s.nodes[1].children = {3}; }, "/nodes/1/children/0"},
      {[](Scene& s) { s.nodes[1].children = {0}; }, "/nodes/0/children"},  // a cycle
      {[](Scene& s) { s.nodes[2].children = {1}; }, "/nodes/2/children/0"},
      {[](Scene& s) { s.roots = {3}; }, "/roots/0"},
      {[](Scene& s) { s.roots = {1}; }, "/roots/0"},
      {[](Scene& s) {
         s.roots = {2, 2};
       },
       "/roots/1"},
  });
}

TEST(Validate, WalksVeryDeepTrees) {
  Scene scene;
  scene.nodes.resize(200'000);
  for (std::size_t i = 0; i + 1 < scene.nodes.size(); ++i) scene.nodes[i].children = {int(i) + 1};
  scene.roots = {0};
  EXPECT_EQ(refusal(scene), "");
}

}  // namespace
}  // namespace parian
