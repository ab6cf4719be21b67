/// decode_draco(): the accessors of primitives with KHR_draco_mesh_compression get the elements of its
/// streams.
#include <limits>
#include <map>
#include <utility>

#include "renderer/base/parallel.h"
#include "scene_io/gltf/geometry/draco.h"

namespace parian {
namespace {

// A plane of 8 million equal triangles, the best that Draco's own encoder does, has 13 triangles a byte; for
// a byte that is 1700 bytes of what the decoder takes.
constexpr std::size_t kMaxGrowth = 4096;

constexpr std::uint32_t kIndices = std::numeric_limits<std::uint32_t>::max();  // no attribute has this id

/// One stream with the accessors that want something of it, in the order of DracoStream's lists.
struct Job {
  DracoStream stream;
  std::vector<int> attributes, indices;
  std::vector<tinygltf::Primitive*> unindexed;
  DracoMesh mesh = {};
};

class Jobs {
 public:
  explicit Jobs(GltfDocument& document) : document_(document) {}

  void add(tinygltf::Primitive& primitive, const tinygltf::Value& extension, const std::string& where) {
    const int view = index_or_none(extension, "bufferView");
    Job& job = jobs_[view];
    if (job.stream.where.empty()) {
      job.stream.where = where + "/extensions/KHR_draco_mesh_compression";
      job.stream.bytes = document_.view(view);
    }
    for (const auto& [name, id] : extension.Get("attributes").Get<tinygltf::Value::Object>()) {
      add_attribute(job, {primitive.attributes.at(name), view, std::uint32_t(id.GetNumberAsInt())},
                    where + "/attributes/" + name);
    }
    if (primitive.indices >= 0) add_indices(job, primitive, view, where + "/indices");
    if (primitive.indices < 0) job.unindexed.push_back(&primitive);
    primitive.mode = TINYGLTF_MODE_TRIANGLES;  // what a stream has, whatever it stands for
  }

  std::vector<Job*> list() {
    std::vector<Job*> list;
    for (auto& [view, job] : jobs_) list.push_back(&job);
    return list;
  }

 private:
  /// What an accessor gets: the attribute `id` of the stream in bufferView `view`.
  struct Source {
    int accessor, view;
    std::uint32_t id;
  };

  /// False where the accessor is known already. One stands for one thing alone.
  bool is_new(const Source& source, const std::string& where) {
    const auto [known, is_first] = sources_.emplace(source.accessor, std::pair(source.view, source.id));
    if (known->second != std::pair(source.view, source.id)) {
      document_.fail(where, "expected an accessor that no other compressed data is decoded into");
    }
    return is_first;
  }

  void add_attribute(Job& job, const Source& source, const std::string& where) {
    if (!is_new(source, where)) return;
    const auto& accessor = document_.model.accessors[std::size_t(source.accessor)];
    job.attributes.push_back(source.accessor);
    job.stream.attributes.push_back(
        {.id = source.id,
         .component_type = accessor.componentType,
         .components = tinygltf::GetNumComponentsInType(std::uint32_t(accessor.type)),
         .count = accessor.count,
         .where = where});
  }

  void add_indices(Job& job, const tinygltf::Primitive& primitive, int view, const std::string& where) {
    const auto& accessor = document_.model.accessors[std::size_t(primitive.indices)];
    const bool is_unsigned = accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                             accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                             accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    if (accessor.type != TINYGLTF_TYPE_SCALAR || !is_unsigned) {
      document_.fail(where, "expected an accessor of SCALAR, unsigned integers");
    }
    if (!is_new({primitive.indices, view, kIndices}, where)) return;
    job.indices.push_back(primitive.indices);
    job.stream.indices.push_back({.count = accessor.count,
                                  .limit = 0xFFFFFFFFu >> (32 - 8 * element_bytes(accessor)),
                                  .is_strip = primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP,
                                  .where = where});
  }

  GltfDocument& document_;
  std::map<int, Job> jobs_;
  std::map<int, std::pair<int, std::uint32_t>> sources_;
};

/// A bufferView of decoded elements, one behind the other.
int add_view(GltfDocument& document, SharedArray<std::byte> bytes) {
  tinygltf::BufferView view;
  view.byteLength = bytes.size();
  view.buffer = add_buffer(document, std::move(bytes));
  document.model.bufferViews.push_back(std::move(view));
  return int(document.model.bufferViews.size()) - 1;
}

void attach(GltfDocument& document, Job& job) {
  auto& accessors = document.model.accessors;
  for (std::size_t i = 0; i < job.attributes.size(); ++i) {
    accessors[std::size_t(job.attributes[i])].bufferView =
        add_view(document, std::move(job.mesh.attributes[i]));
  }
  if (!job.unindexed.empty()) {
    accessors.emplace_back().type = TINYGLTF_TYPE_SCALAR;
    job.indices.push_back(int(accessors.size()) - 1);
    for (tinygltf::Primitive* primitive : job.unindexed) primitive->indices = job.indices.back();
  }
  if (job.indices.empty()) return;
  const int corners = add_view(document, std::move(job.mesh.corners));
  for (const int number : job.indices) {
    tinygltf::Accessor& accessor = accessors[std::size_t(number)];
    accessor.bufferView = corners;
    accessor.componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    accessor.count = 3 * job.mesh.triangles;
  }
}

}  // namespace

void decode_draco(GltfDocument& document) {
  Jobs jobs(document);
  for (std::size_t m = 0; m < document.model.meshes.size(); ++m) {
    auto& primitives = document.model.meshes[m].primitives;
    for (std::size_t p = 0; p < primitives.size(); ++p) {
      const auto* const extension = find_extension(primitives[p].extensions, "KHR_draco_mesh_compression");
      if (extension) jobs.add(primitives[p], *extension, fmt::format("/meshes/{}/primitives/{}", m, p));
    }
  }
  const std::vector<Job*> list = jobs.list();
  DecodingBudget budget(document, kMaxGrowth);
  parallel_for(list.size(), 1,
               [&](std::size_t i) { list[i]->mesh = decode_stream(document, list[i]->stream, budget); });
  for (Job* job : list) attach(document, *job);
}

}  // namespace parian
