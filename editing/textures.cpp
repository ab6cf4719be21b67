#include "editing/textures.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "editing/arguments.h"
#include "editing/images.h"
#include "images/image_io.h"

namespace parian::edit {
namespace {

/// Calls visit(name, texture) for every slot that the material (const or not) has.
template <class AnyMaterial, class Visit>
void for_each_slot(AnyMaterial& m, const Visit& visit) {
  visit("base_color", m.base_color_texture);
  visit("metallic_roughness", m.metallic_roughness_texture);
  visit("normal", m.normal_texture);
  visit("emission", m.emission_texture);
  visit("specular", m.specular_texture);
  visit("specular_color", m.specular_color_texture);
  if (m.transmission) visit("transmission", m.transmission->texture);
  if (m.diffuse_transmission) {
    visit("diffuse_transmission", m.diffuse_transmission->texture);
    visit("diffuse_transmission.color", m.diffuse_transmission->color_texture);
  }
  if (m.clearcoat) {
    visit("clearcoat", m.clearcoat->texture);
    visit("clearcoat.roughness", m.clearcoat->roughness_texture);
    visit("clearcoat.normal", m.clearcoat->normal_texture);
  }
  if (m.sheen) {
    visit("sheen.color", m.sheen->color_texture);
    visit("sheen.roughness", m.sheen->roughness_texture);
  }
  if (m.anisotropy) visit("anisotropy", m.anisotropy->texture);
  if (m.iridescence) {
    visit("iridescence", m.iridescence->texture);
    visit("iridescence.thickness", m.iridescence->thickness_texture);
  }
}

/// The slot of a material (const or not).
template <class AnyMaterial>
auto& find_slot(AnyMaterial& material, std::string_view slot) {
  decltype(&material.base_color_texture) found = nullptr;
  for_each_slot(material, [&](std::string_view name, auto& texture) {
    if (name == slot) found = &texture;
  });
  if (!found)
    refuse(
        fmt::format("texture: expected one of {}, not {}", fmt::join(texture_slots(material), ", "), slot));
  return *found;
}

TextureRef& slot_of(Scene& scene, int material, std::string_view slot) {
  check_index(material, scene.materials.size(), "material");
  return find_slot(scene.materials[std::size_t(material)], slot);
}

TextureRef& filled_slot_of(Scene& scene, int material, std::string_view slot) {
  TextureRef& use = slot_of(scene, material, slot);
  if (!use) refuse(fmt::format("texture: expected a slot that has one, which {} has not", slot));
  return use;
}

std::size_t count_uses(const Scene& scene, int texture) {
  std::size_t uses = 0;
  for (const Material& material : scene.materials)
    for_each_texture(material, [&](const TextureRef& use) { uses += use.texture == texture; });
  return uses;
}

}  // namespace

std::vector<std::string_view> texture_slots(const Material& material) {
  std::vector<std::string_view> names;
  for_each_slot(material, [&](std::string_view name, const TextureRef&) { names.push_back(name); });
  return names;
}

const TextureRef& texture_at(const Material& material, std::string_view slot) {
  return find_slot(material, slot);
}

void assign_texture(Scene& scene, int material, std::string_view slot, const std::string& path) {
  slot_of(scene, material, slot);  // before the file is read
  assign_texture(scene, material, slot, read_image(path));
}

void assign_texture(Scene& scene, int material, std::string_view slot, const Image& image) {
  TextureRef& use = slot_of(scene, material, slot);
  check_element(image);
  Texture texture = use ? scene.textures[std::size_t(use.texture)] : Texture{};
  texture.image = find_or_add_image(scene, image);
  use.texture = int(scene.textures.size());
  scene.textures.push_back(texture);
}

void remove_texture(Scene& scene, int material, std::string_view slot) {
  filled_slot_of(scene, material, slot) = {};
}

void set_sampling(Scene& scene, int material, std::string_view slot, const Sampling& sampling) {
  TextureRef& use = filled_slot_of(scene, material, slot);
  Texture texture = scene.textures[std::size_t(use.texture)];
  texture.wrap_s = sampling.wrap_s;
  texture.wrap_t = sampling.wrap_t;
  texture.filter = sampling.filter;
  if (count_uses(scene, use.texture) == 1) {
    scene.textures[std::size_t(use.texture)] = texture;
    return;
  }
  use.texture = int(scene.textures.size());
  scene.textures.push_back(texture);
}

void set_uv_set(Scene& scene, int material, std::string_view slot, int uv_set) {
  TextureRef& use = filled_slot_of(scene, material, slot);
  if (uv_set != 0 && uv_set != 1) refuse(fmt::format("UV set: expected 0 or 1, not {}", uv_set));
  use.uv_set = uv_set;
}

}  // namespace parian::edit
