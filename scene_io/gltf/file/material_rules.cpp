/// check_materials(): the rules for materials that a schema cannot say.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include <cmath>
#include <initializer_list>
#include <string>
#include <utility>

#include "renderer/base/error.h"
#include "scene_io/gltf/file/schema.h"

namespace parian {
namespace {

/// The extensions of one material.
class MaterialRules {
 public:
  MaterialRules(const nlohmann::json& extensions, std::string where, const std::string& file)
      : extensions_(extensions), where_(std::move(where)), file_(file) {}

  void check() const {
    check_ior("KHR_materials_ior");
    check_scatter("KHR_materials_volume_scatter");
    check_named("PARIAN_materials_conductor", {"eta", "k"}, {});
    if (!check_colored("PARIAN_materials_subsurface"))
      check_named("PARIAN_materials_subsurface", {"sigmaA", "sigmaSPrime"}, {"eta"});
    refuse_beside("PARIAN_materials_phong", {"PARIAN_materials_conductor"});
    refuse_beside("PARIAN_materials_subsurface",
                  {"PARIAN_materials_phong", "PARIAN_materials_conductor", "KHR_materials_volume_scatter"});
  }

 private:
  using Keys = std::initializer_list<const char*>;

  [[noreturn]] void fail(const std::string& place, const std::string& expected) const {
    throw InputError(file_, where_ + place, "expected " + expected);
  }

  bool has(const char* name) const { return extensions_.contains(name); }

  void check_ior(const char* name) const {
    if (!has(name)) return;
    const double ior = extensions_[name].value("ior", 1.5);
    if (ior != 0 && ior < 1) fail(fmt::format("/{}/ior", name), "0 or a number of at least 1");
  }

  void check_scatter(const char* name) const {
    if (!has(name)) return;
    if (!has("KHR_materials_volume"))
      fail(fmt::format("/{}", name), "no such member without KHR_materials_volume");
    // As a float, which is what the renderer has of it.
    const float anisotropy = extensions_[name].value("scatterAnisotropy", 0.0f);
    if (!(std::abs(anisotropy) < 1))
      fail(fmt::format("/{}/scatterAnisotropy", name), "a number between -1 and 1");
  }

  /// A material whose numbers are known by its name, or else are given: all that are needed, and maybe more.
  void check_named(const char* name, Keys needed, Keys more) const {
    if (!has(name)) return;
    const nlohmann::json& extension = extensions_[name];
    const bool is_named = extension.contains("name");
    const auto refuse = [&](const char* key) {
      if (is_named && extension.contains(key))
        fail(fmt::format("/{}/{}", name, key), "no such member, since name says what it is");
    };
    for (const char* key : needed) {
      refuse(key);
      if (!is_named && !extension.contains(key))
        fail(fmt::format("/{}/{}", name, key), "3 numbers, each of at least 0, since there is no name");
    }
    for (const char* key : more) refuse(key);
  }

  /// A body by the colour that it has; false where there is none.
  bool check_colored(const char* name) const {
    if (!has(name) || !(extensions_[name].contains("color") || extensions_[name].contains("meanFreePath")))
      return false;
    for (const char* key : {"color", "meanFreePath"})
      if (!extensions_[name].contains(key))
        fail(fmt::format("/{}/{}", name, key), "3 numbers, since color and meanFreePath need each other");
    for (const char* key : {"name", "sigmaA", "sigmaSPrime"})
      if (extensions_[name].contains(key))
        fail(fmt::format("/{}/{}", name, key), "no such member beside color");
    return true;
  }

  void refuse_beside(const char* name, Keys others) const {
    for (const char* other : others)
      if (has(name) && has(other))
        fail(fmt::format("/{}", name), fmt::format("no such member beside {}", other));
  }

  const nlohmann::json& extensions_;
  std::string where_;
  const std::string& file_;
};

}  // namespace

void check_materials(const nlohmann::json& document, const std::string& file) {
  if (!document.contains("materials")) return;
  const nlohmann::json& materials = document["materials"];
  for (std::size_t i = 0; i < materials.size(); ++i)
    if (materials[i].contains("extensions"))
      MaterialRules(materials[i]["extensions"], fmt::format("/materials/{}/extensions", i), file).check();
}

}  // namespace parian
