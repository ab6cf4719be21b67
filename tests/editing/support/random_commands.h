/// Commands by chance, on whatever a scene has.
#pragma once

#include <functional>
#include <random>
#include <string>
#include <vector>

#include "editing/add.h"
#include "editing/environment.h"
#include "editing/materials.h"
#include "editing/nodes.h"
#include "editing/properties.h"
#include "editing/textures.h"
#include "tests/support/scenes.h"

namespace parian {

/// An image of two by one texels that says which it is.
inline Image small_image(std::uint8_t shade) {
  return make_image(2, 1, 3, PixelType::u8,
                    std::vector<std::uint8_t>{shade, 40, 200, 90, shade, std::uint8_t(255 - shade)});
}

class RandomCommands {
 public:
  /// `make_image`: an image for each of six shades; where these are to be saved, from files.
  explicit RandomCommands(unsigned seed, std::function<Image(std::uint8_t)> make_image = small_image)
      : random_(seed), make_image_(std::move(make_image)) {}

  /// Runs one command; what it asks for may be refused (UsageError). Scenes of more than about 40 nodes
  /// shrink.
  void run(Scene& scene) {
    if (scene.nodes.size() > 40 && below(2)) return shrink(scene);
    switch (below(9)) {
      case 0:
        return add(scene);
      case 1:
        return move(scene);
      case 2:
        return shrink(scene);
      case 3:
        return change_tree(scene);
      case 4:
        return change_materials(scene);
      case 5:
        return change_textures(scene);
      case 6:
        return change_environment(scene);
      default:
        return change_property(scene);
    }
  }

 private:
  int below(int count) { return count > 0 ? int(random_() % unsigned(count)) : 0; }
  float real(float low, float high) { return std::uniform_real_distribution<float>(low, high)(random_); }
  template <class T>
  int index(const std::vector<T>& items) {
    return below(int(items.size()));
  }
  int parent(const Scene& scene) { return below(3) ? index(scene.nodes) : kNone; }
  std::string text() { return "name " + std::to_string(below(5)); }
  Vec3f vector(float size) { return {real(-size, size), real(-size, size), real(-size, size)}; }
  Quatf rotation() { return Quatf(real(.1f, 1), real(-1, 1), real(-1, 1), real(-1, 1)).normalized(); }
  edit::Place place(const Scene& scene) {
    Transform t = translate(vector(1));
    if (below(2)) t.rotation = rotation();
    if (below(2)) t.scale = Vec3f(.3f) + abs(vector(1));
    return {parent(scene), t};
  }

  void add(Scene& scene) {
    const edit::Place at = place(scene);
    switch (below(8)) {
      case 0:
        edit::add_shape(scene, edit::sphere(real(.05f, .3f)), at);
        return;
      case 1:
        edit::add_shape(scene, edit::box(Vec3f(.1f) + abs(vector(.2f))), at, index(scene.materials));
        return;
      case 2:
        edit::add_shape(scene, edit::cone(real(.05f, .3f), real(.1f, .4f)), at, index(scene.materials));
        return;
      case 3:
        edit::add_shape(scene, edit::plane(.3f, .2f), at);
        return;
      case 4:
        edit::add_light(scene, edit::default_light(LightKind(below(5))), at);
        return;
      case 5:
        edit::add_camera_from_view(scene, Camera{}, vector(3), vector(1));
        return;
      case 6:
        edit::add_group(scene, text(), at);
        return;
      default:
        edit::add_scene(scene, small_scene(), text(), at);
    }
  }

  /// A mesh with a texture, and a lamp.
  Scene small_scene() {
    Scene scene;
    Material m = make_lambert({.5f, .4f, .3f});
    m.base_color_texture = add_texture(scene, make_image_(std::uint8_t(below(3))));
    parian::add_mesh(scene, make_box(Vec3f(-.1f), Vec3f(.1f)), parian::add_material(scene, m));
    parian::add_light(scene, edit::default_light(LightKind::point));
    return scene;
  }

  void move(Scene& scene) {
    const int node = index(scene.nodes);
    switch (below(5)) {
      case 0:
        return edit::rename_node(scene, node, text());
      case 1:
        return edit::set_transform(scene, node, {vector(1), {}, {}});
      case 2:
        return edit::set_transform(scene, node, {{}, rotation(), below(2) ? Vec3f(1, .5f, .8f) : Vec3f(.7f)});
      case 3: {
        Mat4d m = translate(vector(1)).to_matrix();
        m[0][1] = real(-.5f, .5f);  // shears
        return edit::set_matrix(scene, node, m);
      }
      default:
        return edit::set_visible(scene, node, below(2));
    }
  }

  void shrink(Scene& scene) {
    const auto how = below(2) ? edit::Removal::subtree : edit::Removal::node_alone;
    if (below(4)) edit::remove(scene, index(scene.nodes), how);
    if (!below(4)) edit::remove_unused(scene);
  }

  void change_tree(Scene& scene) {
    const int node = index(scene.nodes);
    switch (below(5)) {
      case 0:
        return edit::reparent(scene, node, parent(scene), {}, below(2));
      case 1:
        return edit::reorder(scene, node, below(4));
      case 2:
        edit::duplicate(scene, node);
        return;
      case 3: {
        const std::vector<int> nodes{node, index(scene.nodes)};
        edit::group(scene, nodes, text());
        return;
      }
      default:
        edit::ungroup(scene, node);
    }
  }

  void change_materials(Scene& scene) {
    const edit::MaterialSlot slot{index(scene.nodes), below(2) - 1};
    const int material = index(scene.materials);
    switch (below(6)) {
      case 0:
        return edit::assign_material(scene, slot, material);
      case 1:
        edit::make_single_user(scene, slot);
        return;
      case 2:
        edit::add_material(scene, make_lambert(Rgb(abs(vector(1)))));
        return;
      case 3:
        edit::duplicate_material(scene, material);
        return;
      case 4:
        return edit::remove_material(scene, material, index(scene.materials));
      default:
        return edit::rename_material(scene, material, text());
    }
  }

  void change_textures(Scene& scene) {
    const int material = index(scene.materials);
    if (scene.materials.empty()) return;
    const std::vector<std::string_view> slots = edit::texture_slots(scene.materials[std::size_t(material)]);
    const std::string_view slot = slots[std::size_t(index(slots))];
    switch (below(4)) {
      case 0:
        return edit::assign_texture(scene, material, slot, make_image_(std::uint8_t(below(6))));
      case 1:
        return edit::remove_texture(scene, material, slot);
      case 2:
        return edit::set_sampling(scene, material, slot, {Wrap(below(3)), Wrap(below(3)), Filter(below(2))});
      default:
        return edit::set_uv_set(scene, material, slot, below(3));
    }
  }

  void change_environment(Scene& scene) {
    if (below(2)) return edit::set_environment_image(scene, make_image_(std::uint8_t(below(6))));
    edit::remove_environment_image(scene);
  }

  void change_property(Scene& scene) {
    switch (below(8)) {
      case 0:
        return change_one(scene, scene.shapes, edit::shape_properties);
      case 1:
        return change_one(scene, scene.lights, edit::light_properties);
      case 2:
        return change_one(scene, scene.cameras, edit::camera_properties);
      case 3:
        return set_any(scene, 0, edit::environment_properties());
      default:
        return change_one(scene, scene.materials, edit::material_properties);
    }
  }

  template <class T, class List>
  void change_one(Scene& scene, const std::vector<T>& items, const List& list) {
    if (items.empty()) return;
    const int at = index(items);
    set_any(scene, at, list(items[std::size_t(at)]));
  }

  void set_any(Scene& scene, int at, const std::vector<edit::Property>& properties) {
    const edit::Property& p = properties[std::size_t(index(properties))];
    const double low = std::max(p.low, -2.0), high = std::min(p.high, low + (below(2) ? 1 : 60));
    const auto number = [&] { return low + (high - low) * double(real(0, 1)); };
    switch (p.kind) {
      case edit::PropertyKind::number:
      case edit::PropertyKind::angle:
        return p.set(scene, at, number());
      case edit::PropertyKind::integer:
        return p.set(scene, at, below(4));
      case edit::PropertyKind::color:
        return p.set(scene, at, Rgb(float(number()), float(number()), float(number())));
      case edit::PropertyKind::toggle:
        return p.set(scene, at, below(2) == 1);
      case edit::PropertyKind::choice:
        return p.set(scene, at, p.choices[std::size_t(index(p.choices))]);
      case edit::PropertyKind::text:
        return p.set(scene, at, text());
    }
  }

  std::mt19937 random_;
  std::function<Image(std::uint8_t)> make_image_;
};

}  // namespace parian
