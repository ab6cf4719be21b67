/// Draco streams made with the library's own encoder, for the tests of the reader.
#pragma once

#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

namespace parian {

struct DracoBuilder {
  std::unique_ptr<draco::Mesh> mesh = std::make_unique<draco::Mesh>();  // which does not move

  explicit DracoBuilder(const std::vector<std::uint32_t>& corners) {
    mesh->SetNumFaces(corners.size() / 3);
    for (std::uint32_t f = 0; f < mesh->num_faces(); ++f) {
      mesh->SetFace(draco::FaceIndex(f),
                    {draco::PointIndex(corners[3 * f]), draco::PointIndex(corners[3 * f + 1]),
                     draco::PointIndex(corners[3 * f + 2])});
    }
  }

  template <class T>
  static draco::DataType type() {
    if (std::is_same_v<T, std::int8_t>) return draco::DT_INT8;
    if (std::is_same_v<T, std::uint8_t>) return draco::DT_UINT8;
    if (std::is_same_v<T, std::int16_t>) return draco::DT_INT16;
    if (std::is_same_v<T, std::uint16_t>) return draco::DT_UINT16;
    return std::is_same_v<T, float> ? draco::DT_FLOAT32 : draco::DT_UINT32;
  }

  /// An attribute with a value for each vertex and the unique id `id`.
  template <class T>
  void add(draco::GeometryAttribute::Type kind, std::uint32_t id, const std::vector<T>& values,
           int components) {
    const auto count = std::uint32_t(values.size() / std::size_t(components));
    draco::GeometryAttribute attribute;
    attribute.Init(kind, nullptr, std::int8_t(components), type<T>(), false,
                   std::int64_t(sizeof(T)) * components, 0);
    mesh->set_num_points(count);
    const int number = mesh->AddAttribute(attribute, true, count);
    for (std::uint32_t i = 0; i < count; ++i) {
      mesh->attribute(number)->SetAttributeValue(draco::AttributeValueIndex(i),
                                                 values.data() + std::size_t(i) * std::size_t(components));
    }
    mesh->attribute(number)->set_unique_id(id);
  }

  static std::string bytes(const draco::EncoderBuffer& buffer) { return {buffer.data(), buffer.size()}; }

  /// In the order of the mesh, and exact.
  std::string sequential() const {
    draco::Encoder encoder;
    encoder.SetEncodingMethod(draco::MESH_SEQUENTIAL_ENCODING);
    draco::EncoderBuffer buffer;
    EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
    return bytes(buffer);
  }

  /// In an order of the encoder's, floats to so many bits. `speed`: 0, the smallest, to 10.
  std::string edgebreaker(int bits, int speed) const {
    draco::Encoder encoder;
    encoder.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
    encoder.SetSpeedOptions(speed, speed);
    for (int kind = 0; kind < draco::GeometryAttribute::NAMED_ATTRIBUTES_COUNT; ++kind) {
      encoder.SetAttributeQuantization(draco::GeometryAttribute::Type(kind), bits);
    }
    draco::EncoderBuffer buffer;
    EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
    return bytes(buffer);
  }
};

}  // namespace parian
