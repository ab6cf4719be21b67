/// The only code that knows Draco.
#include "scene_io/gltf/geometry/draco.h"

#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>

#include <cstring>
#include <memory>
#include <new>
#include <stdexcept>
#include <utility>

namespace parian {
namespace {

int gltf_type(draco::DataType type) {
  switch (type) {
    case draco::DT_INT8:
      return TINYGLTF_COMPONENT_TYPE_BYTE;
    case draco::DT_UINT8:
      return TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE;
    case draco::DT_INT16:
      return TINYGLTF_COMPONENT_TYPE_SHORT;
    case draco::DT_UINT16:
      return TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
    case draco::DT_UINT32:
      return TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    case draco::DT_FLOAT32:
      return TINYGLTF_COMPONENT_TYPE_FLOAT;
    default:
      return -1;  // none that glTF has
  }
}

/// Looks at what a stream claims before the library allocates it, and keeps the first objection.
class Gate {
 public:
  Gate(const DracoStream& stream, DecodingBudget& budget) : stream_(stream), budget_(budget) {}

  /// `bytes`: what the library takes for a triangle while it decodes.
  bool admit_triangles(std::size_t triangles, std::size_t bytes) {
    if (triangles == 0) return refuse(stream_.where, "expected a Draco stream with triangles");
    for (const DracoIndices& indices : stream_.indices) {
      if (indices.is_strip ? triangles + 2 > indices.count : 3 * triangles != indices.count) {
        return refuse(indices.where,
                      fmt::format("expected an accessor of {} indices, since the stream has {} triangles",
                                  indices.is_strip ? triangles + 2 : 3 * triangles, triangles));
      }
    }
    return claim(triangles * (bytes + sizeof(draco::Mesh::Face)));
  }

  bool admit_attributes(const draco::PointCloud& points) {
    const std::size_t count = points.num_points();
    for (const DracoIndices& indices : stream_.indices) {
      if (count > indices.limit) {
        return refuse(indices.where,
                      fmt::format("expected indices of a type for the {} vertices of the stream", count));
      }
    }
    for (const DracoAttribute& expected : stream_.attributes) {
      const draco::PointAttribute* const attribute = points.GetAttributeByUniqueId(expected.id);
      if (!attribute)
        return refuse(expected.where,
                      fmt::format("expected the stream to have an attribute {}", expected.id));
      if (count != expected.count) {
        return refuse(expected.where,
                      fmt::format("expected an accessor of {} elements, as the stream has vertices, not {}",
                                  count, expected.count));
      }
      if (gltf_type(attribute->data_type()) != expected.component_type ||
          attribute->num_components() != expected.components) {
        return refuse(expected.where,
                      fmt::format("expected an accessor of {} components of type {}, as the stream has",
                                  int(attribute->num_components()), gltf_type(attribute->data_type())));
      }
      if (!claim(count * std::size_t(attribute->byte_stride()))) return false;  // for the result
    }
    // Also for those that nobody asks for: the element, what it was predicted from, and its place.
    for (int i = 0; i < points.num_attributes(); ++i) {
      const draco::PointAttribute& attribute = *points.attribute(i);
      const std::size_t components = std::size_t(attribute.num_components());
      if (!claim(count * (std::size_t(attribute.byte_stride()) + 4 * components + 8))) return false;
    }
    return true;
  }

  bool refuse(std::string where, std::string expected) {
    if (expected_.empty()) {
      where_ = std::move(where);
      expected_ = std::move(expected);
    }
    return false;
  }

  const std::string& where() const { return where_; }
  const std::string& expected() const { return expected_; }

 private:
  bool claim(std::size_t bytes) {
    return budget_.claim(bytes) ||
           refuse(stream_.where, "expected streams that hold no more than their bytes can honestly be");
  }

  const DracoStream& stream_;
  DecodingBudget& budget_;
  std::string where_, expected_;
};

/// A decoder of the library that asks the gate first.
template <class Decoder>
class GatedDecoder final : public Decoder {
 public:
  explicit GatedDecoder(Gate& gate) : gate_(gate) {}

 protected:
  bool DecodeConnectivity() override {
    draco::DecoderBuffer ahead = *this->buffer();
    return admit(ahead) && Decoder::DecodeConnectivity();
  }
  bool DecodeAllAttributes() override {
    return gate_.admit_attributes(*this->point_cloud()) && Decoder::DecodeAllAttributes();
  }

 private:
  // Measured: 45 bytes for a triangle of a scanned surface, and 33 more for each set of attributes with seams
  // of its own; more vertices for each triangle take more.
  static constexpr std::size_t kTriangle = 96, kSeams = 48;

  bool admit(draco::DecoderBuffer& ahead) {
    std::uint32_t vertices = 0, triangles = 0;
    if constexpr (std::is_same_v<Decoder, draco::MeshEdgebreakerDecoder>) {
      std::uint8_t seams = 0;
      return draco::DecodeVarint(&vertices, &ahead) && draco::DecodeVarint(&triangles, &ahead) &&
             ahead.Decode(&seams) && gate_.admit_triangles(triangles, kTriangle + kSeams * seams);
    } else {
      // Indices take at least a byte each; the library refuses more of them.
      return draco::DecodeVarint(&triangles, &ahead) &&
             gate_.admit_triangles(triangles, sizeof(draco::Mesh::Face));
    }
  }

  Gate& gate_;
};

SharedArray<std::byte> copy_corners(const draco::Mesh& mesh) {
  static_assert(sizeof(draco::Mesh::Face) == 3 * sizeof(std::uint32_t));
  const std::size_t bytes = mesh.num_faces() * sizeof(draco::Mesh::Face);
  auto [corners, out] = make_shared_array<std::byte>(bytes);
  if (bytes != 0) std::memcpy(out, &mesh.face(draco::FaceIndex(0)), bytes);
  return corners;
}

/// Empty where the stream has no value for some vertex.
SharedArray<std::byte> copy_attribute(const draco::PointAttribute& attribute, std::size_t count) {
  const std::size_t element = std::size_t(attribute.byte_stride());
  if (!attribute.is_mapping_identity() && attribute.indices_map_size() < count) return {};
  if (attribute.buffer()->data_size() < attribute.size() * element) return {};
  auto [elements, out] = make_shared_array<std::byte>(count * element);
  for (std::uint32_t i = 0; i < count; ++i) {
    const draco::AttributeValueIndex value = attribute.mapped_index(draco::PointIndex(i));
    if (value.value() >= attribute.size()) return {};
    std::memcpy(out + i * element, attribute.GetAddress(value), element);
  }
  return elements;
}

/// What the library makes of the stream. False where it does not decode; the gate may say why.
bool decode(const DracoStream& stream, Gate& gate, draco::Mesh& mesh) {
  const auto refuse = [&](std::string expected) { return gate.refuse(stream.where, std::move(expected)); };
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(stream.bytes.data()), stream.bytes.size());
  draco::DecoderBuffer ahead = buffer;
  draco::DracoHeader header = {};
  if (!draco::PointCloudDecoder::DecodeHeader(&ahead, &header).ok()) return refuse("expected a Draco stream");
  if (header.version_major != 2 || header.version_minor != 2) {
    return refuse(fmt::format("expected a Draco stream of version 2.2, not {}.{}", header.version_major,
                              header.version_minor));
  }
  if (header.encoder_type != draco::TRIANGULAR_MESH)
    return refuse("expected a Draco stream of a triangle mesh");
  const draco::DecoderOptions options;
  if (header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING) {
    return GatedDecoder<draco::MeshEdgebreakerDecoder>(gate).Decode(options, &buffer, &mesh).ok();
  }
  return GatedDecoder<draco::MeshSequentialDecoder>(gate).Decode(options, &buffer, &mesh).ok();
}

}  // namespace

DracoMesh decode_stream(const GltfDocument& document, const DracoStream& stream, DecodingBudget& budget) {
  Gate gate(stream, budget);
  draco::Mesh mesh;
  bool is_decoded = false;
  try {
    is_decoded = decode(stream, gate, mesh);
  } catch (const std::bad_alloc&) {  // as good as a refusal, as is what containers throw
  } catch (const std::logic_error&) {
  }
  DracoMesh result{.triangles = mesh.num_faces()};
  if (is_decoded) {
    result.corners = copy_corners(mesh);
    for (const DracoAttribute& expected : stream.attributes) {
      result.attributes.push_back(
          copy_attribute(*mesh.GetAttributeByUniqueId(expected.id), mesh.num_points()));
      is_decoded = is_decoded && result.attributes.back().size() != 0;
    }
  }
  if (!is_decoded) gate.refuse(stream.where, "expected a Draco stream that can be decoded; it is broken");
  if (!gate.expected().empty()) document.fail(gate.where(), gate.expected());
  return result;
}

}  // namespace parian
