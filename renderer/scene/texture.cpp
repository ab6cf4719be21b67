#include "renderer/scene/texture.h"

#include <Imath/half.h>

namespace parian {
namespace {

/// IEC 61966-2-1, decoding.
float srgb_to_linear(float c) { return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f); }

struct SrgbTable {
  float value[256];
  SrgbTable() {
    for (int i = 0; i < 256; ++i) value[i] = srgb_to_linear(float(i) / 255);
  }
};

float channel(const Image& image, std::size_t i, ColorSpace space) {
  static const SrgbTable table;
  const std::byte* data = image.pixels.data();
  switch (image.type) {
    case PixelType::u8: {
      const auto byte = std::uint8_t(data[i]);
      return space == ColorSpace::srgb ? table.value[byte] : float(byte) * (1.0f / 255);
    }
    case PixelType::u16: {
      const float value = float(reinterpret_cast<const std::uint16_t*>(data)[i]) * (1.0f / 65535);
      return space == ColorSpace::srgb ? srgb_to_linear(value) : value;
    }
    case PixelType::f16:
      return reinterpret_cast<const Imath::half*>(data)[i];
    case PixelType::f32:
      return reinterpret_cast<const float*>(data)[i];
  }
  return 0;
}

int wrap_index(int i, int size, Wrap wrap) {
  switch (wrap) {
    case Wrap::repeat:
      i %= size;
      return i < 0 ? i + size : i;
    case Wrap::mirrored_repeat:
      i %= 2 * size;
      if (i < 0) i += 2 * size;
      return i < size ? i : 2 * size - 1 - i;
    case Wrap::clamp_to_edge:
      return std::clamp(i, 0, size - 1);
  }
  return 0;
}

/// Texel coordinate u * size, bounded so that it fits an int whatever the mesh claims.
float texel_coordinate(float u, int size) { return std::clamp(u * float(size), -1e9f, 1e9f); }

}  // namespace

Vec4f texel(const Image& image, int x, int y, ColorSpace space) {
  const std::size_t first = (std::size_t(y) * image.width + x) * image.channels;
  if (image.channels <= 2) {
    const float grey = channel(image, first, space);
    return {grey, grey, grey, image.channels == 2 ? channel(image, first + 1, ColorSpace::linear) : 1};
  }
  return {channel(image, first, space), channel(image, first + 1, space), channel(image, first + 2, space),
          image.channels == 4 ? channel(image, first + 3, ColorSpace::linear) : 1};
}

Vec4f eval_texture(const Scene& scene, const Texture& texture, const Vec2f& uv, ColorSpace space) {
  const Image& image = scene.images[texture.image];
  float x = texel_coordinate(uv.x, image.width), y = texel_coordinate(uv.y, image.height);
  const auto at = [&](int i, int j) {
    return texel(image, wrap_index(i, image.width, texture.wrap_s), wrap_index(j, image.height, texture.wrap_t), space);
  };
  if (texture.filter == Filter::nearest) return at(int(std::floor(x)), int(std::floor(y)));
  x -= 0.5f;
  y -= 0.5f;
  const int i = int(std::floor(x)), j = int(std::floor(y));
  const float fx = x - float(i), fy = y - float(j);
  return (at(i, j) * (1 - fx) + at(i + 1, j) * fx) * (1 - fy) +
         (at(i, j + 1) * (1 - fx) + at(i + 1, j + 1) * fx) * fy;
}

Vec4f eval_texture(const Scene& scene, const TextureRef& ref, const std::array<Vec2f, 2>& uvs, ColorSpace space) {
  const Vec2f& uv = uvs[ref.uv_set];
  const auto& m = ref.transform;
  return eval_texture(scene, scene.textures[ref.texture],
                      {m[0] * uv.x + m[1] * uv.y + m[2], m[3] * uv.x + m[4] * uv.y + m[5]}, space);
}

}  // namespace parian
