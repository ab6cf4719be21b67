/// arrange().
#include <algorithm>
#include <optional>
#include <utility>

#include "scene_io/gltf/write/draft.h"
#include "scene_io/gltf/write/member.h"

namespace parian {
namespace {

using nlohmann::json;

bool is_area(const Light& light) {
  return light.kind == LightKind::rectangle || light.kind == LightKind::disk;
}

/// Where an element of the scene stood in the array of its source; nothing where it was made here.
using Place = std::optional<std::size_t>;

/// Makes the array anew: one element for each of `places`, in their order, with what stood there. Returns the
/// new numbers of the old elements; of several copies the first counts.
std::vector<int> take(json& root, const std::string& pointer, const std::vector<Place>& places) {
  std::vector<int> numbers(array_size(root, pointer), kNone);
  json taken = json::array();
  for (std::size_t i = 0; i < places.size(); ++i) {
    json element = json::object();
    if (places[i] && *places[i] < numbers.size()) {
      int& number = numbers[*places[i]];
      if (number == kNone) number = int(i);
      element = (*find_array(root, pointer))[*places[i]];
    }
    taken.push_back(std::move(element));
  }
  if (!numbers.empty() || !taken.empty()) need_array(root, pointer) = std::move(taken);
  return numbers;
}

class Arranger {
 public:
  explicit Arranger(Draft& draft) : draft_(draft) {}

  void run() {
    const Scene& scene = draft_.scene;
    Numbers numbers;
    const auto all = [&](const std::string& pointer, const auto& items, const auto& number) {
      std::vector<Place> places;
      for (const auto& item : items) places.push_back(place(item.origin, pointer, number));
      numbers[pointer] = take(draft_.root, pointer, places);
    };
    const auto same = [](const GltfSource&, std::size_t index) { return Place(index); };
    all(array::kMaterials, scene.materials, same);
    all(array::kCameras, scene.cameras, same);
    all(array::kShapes, scene.shapes, same);
    all(array::kMeshes, scene.meshes, [](const GltfSource& source, std::size_t index) {
      return index < source.meshes.size() ? Place(source.meshes[index]) : Place();
    });
    all(array::kNodes, scene.nodes, [](const GltfSource& source, std::size_t index) {
      return index < source.nodes ? Place(index) : Place();
    });
    take_lights(numbers);
    renumber(draft_.root, numbers);
    drop_broken_skins();
  }

 private:
  template <class Number>
  Place place(const Origin& origin, const std::string& pointer, const Number& number) const {
    const GltfSource* const source = draft_.source_of(origin);
    if (!source || origin.index < 0) return {};
    const Place in_document = number(*source, std::size_t(origin.index));
    // What the reader appended is no element of the file.
    const bool is_there = in_document && *in_document < draft_.count[std::size_t(origin.file)].at(pointer);
    if (!is_there) return {};
    return std::size_t(draft_.merged(origin, pointer, *in_document));
  }

  /// Two arrays, of which the scene has one.
  void take_lights(Numbers& numbers) {
    std::vector<Place> punctual, area;
    for (const Light& light : draft_.scene.lights) {
      const bool to_area = is_area(light);
      std::vector<Place>& places = to_area ? area : punctual;
      draft_.lights.push_back(int(places.size()));
      // A light that became one of the other kind starts anew.
      places.push_back(place(light.origin, to_area ? array::kAreaLights : array::kLights,
                             [&](const GltfSource& source, std::size_t index) {
                               const bool was_area = index >= source.punctual_lights;
                               if (was_area != to_area) return Place();
                               return Place(was_area ? index - source.punctual_lights : index);
                             }));
    }
    numbers[array::kLights] = take(draft_.root, array::kLights, punctual);
    numbers[array::kAreaLights] = take(draft_.root, array::kAreaLights, area);
  }

  void drop_broken_skins() {
    const json* const skins = find_array(draft_.root, array::kSkins);
    if (!skins) return;
    std::vector<bool> keep;
    for (const json& skin : *skins) keep.push_back(!skin.is_null());
    keep_only(draft_.root, array::kSkins, keep);
  }

  Draft& draft_;
};

}  // namespace

void arrange(Draft& draft) { Arranger(draft).run(); }

}  // namespace parian
