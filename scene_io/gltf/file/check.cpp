/// check_buffer_views() and check_document(): what a schema cannot say, the relations between the parts of a
/// document.
#include <cstdint>
#include <set>

#include "scene_io/gltf/geometry/decompress.h"

namespace parian {
namespace {

// An accessor without bytes is all zeros: a few characters can claim any count. This many elements together
// are enough for any mesh that is worth writing down as sparse.
constexpr std::size_t kMaxZeroElements = std::size_t(1) << 24;

std::size_t component_bytes(int component_type) {
  return std::size_t(tinygltf::GetComponentSizeInBytes(std::uint32_t(component_type)));
}

// Whether `count` elements fit, without a product that could overflow.
bool fits(std::size_t view_bytes, std::size_t offset, std::size_t count, std::size_t stride,
          std::size_t element) {
  return offset <= view_bytes && element <= view_bytes - offset &&
         (count - 1) <= (view_bytes - offset - element) / stride;
}

void check_sparse(const GltfDocument& document, const tinygltf::Accessor& accessor,
                  const std::string& where) {
  const auto& sparse = accessor.sparse;
  const auto check_part = [&](int view, std::size_t offset, std::size_t element, const char* name) {
    const std::size_t bytes = document.model.bufferViews[std::size_t(view)].byteLength;
    if (!fits(bytes, offset, std::size_t(sparse.count), element, element)) {
      document.fail(fmt::format("{}/sparse/{}", where, name),
                    fmt::format("expected {} elements inside the {} bytes of bufferView {}", sparse.count,
                                bytes, view));
    }
  };
  if (std::size_t(sparse.count) > accessor.count) {
    document.fail(where + "/sparse/count",
                  fmt::format("expected at most {}, the accessor's count", accessor.count));
  }
  check_part(sparse.indices.bufferView, sparse.indices.byteOffset,
             component_bytes(sparse.indices.componentType), "indices");
  check_part(sparse.values.bufferView, sparse.values.byteOffset, element_bytes(accessor), "values");
}

void check_accessors(const GltfDocument& document) {
  std::size_t zeros = 0;
  for (std::size_t i = 0; i < document.model.accessors.size(); ++i) {
    const auto& accessor = document.model.accessors[i];
    const std::string where = fmt::format("/accessors/{}", i);
    if (accessor.bufferView < 0) {
      if (accessor.count > kMaxZeroElements - zeros) {
        document.fail(
            where + "/count",
            fmt::format("expected at most {} elements in accessors without a bufferView", kMaxZeroElements));
      }
      zeros += accessor.count;
    } else {
      const auto& view = document.model.bufferViews[std::size_t(accessor.bufferView)];
      const std::size_t element = element_bytes(accessor);
      const std::size_t stride = view.byteStride ? view.byteStride : element;
      if (stride < element) {
        document.fail(fmt::format("/bufferViews/{}/byteStride", accessor.bufferView),
                      fmt::format("expected at least {}, the element size of accessor {}", element, i));
      }
      if (!fits(view.byteLength, accessor.byteOffset, accessor.count, stride, element)) {
        document.fail(
            where + "/count",
            fmt::format("expected elements inside the {} bytes of bufferView {}, not {} of "
                        "stride {} from byte {}",
                        view.byteLength, accessor.bufferView, accessor.count, stride, accessor.byteOffset));
      }
    }
    if (accessor.sparse.isSparse) check_sparse(document, accessor, where);
  }
}

// That the nodes form a forest is for validate() to see, which speaks of the same /nodes. The roots it sees
// are no longer those of a scene in the file.
void check_scenes(const GltfDocument& document) {
  std::vector<bool> has_parent(document.model.nodes.size(), false);
  for (const auto& node : document.model.nodes) {
    for (const int child : node.children) has_parent[std::size_t(child)] = true;
  }
  for (std::size_t s = 0; s < document.model.scenes.size(); ++s) {
    std::set<int> listed;
    for (std::size_t i = 0; i < document.model.scenes[s].nodes.size(); ++i) {
      const int node = document.model.scenes[s].nodes[i];
      if (has_parent[std::size_t(node)] || !listed.insert(node).second) {
        document.fail(fmt::format("/scenes/{}/nodes/{}", s, i),
                      "expected a node without a parent, listed once");
      }
    }
  }
}

void check_cameras(const GltfDocument& document) {
  for (std::size_t i = 0; i < document.model.cameras.size(); ++i) {
    const auto& camera = document.model.cameras[i];
    const bool perspective = camera.type == "perspective";
    const double znear = perspective ? camera.perspective.znear : camera.orthographic.znear;
    const double zfar = perspective ? camera.perspective.zfar : camera.orthographic.zfar;
    if (zfar != 0 && zfar <= znear) {  // 0: a perspective camera without zfar
      document.fail(fmt::format("/cameras/{}/{}/zfar", i, camera.type), "expected a number above znear");
    }
  }
}

}  // namespace

std::size_t element_bytes(const tinygltf::Accessor& accessor) {
  return component_bytes(accessor.componentType) *
         std::size_t(tinygltf::GetNumComponentsInType(std::uint32_t(accessor.type)));
}

void check_buffer_views(const GltfDocument& document) {
  const auto& views = document.model.bufferViews;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (meshopt_extension(views[i])) continue;  // decode_meshopt() looks where its bytes are
    const std::size_t size = document.buffers[std::size_t(views[i].buffer)].size();
    if (views[i].byteOffset > size || views[i].byteLength > size - views[i].byteOffset) {
      document.fail(fmt::format("/bufferViews/{}/byteLength", i),
                    fmt::format("expected byteOffset + byteLength of at most {}, the length of buffer {}",
                                size, views[i].buffer));
    }
  }
}

void check_document(const GltfDocument& document) {
  check_accessors(document);
  check_scenes(document);
  check_cameras(document);
}

}  // namespace parian
