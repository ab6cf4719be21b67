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

/// Calls use(color, alpha) with the functions that decode colour and alpha element i of the image, so that
/// the choice of the type is made once for all texels of a lookup.
template <class Use>
Vec4f with_decoder(const Image& image, ColorSpace space, const Use& use) {
  static const SrgbTable table;
  const std::byte* data = image.pixels.data();
  switch (image.type) {
    case PixelType::u8: {
      const auto* p = reinterpret_cast<const std::uint8_t*>(data);
      const auto linear = [p](std::size_t i) { return float(p[i]) * (1.0f / 255); };
      if (space == ColorSpace::linear) return use(linear, linear);
      return use([p](std::size_t i) { return table.value[p[i]]; }, linear);
    }
    case PixelType::u16: {
      const auto* p = reinterpret_cast<const std::uint16_t*>(data);
      const auto linear = [p](std::size_t i) { return float(p[i]) * (1.0f / 65535); };
      if (space == ColorSpace::linear) return use(linear, linear);
      return use([linear](std::size_t i) { return srgb_to_linear(linear(i)); }, linear);
    }
    case PixelType::f16: {
      const auto* p = reinterpret_cast<const Imath::half*>(data);
      const auto value = [p](std::size_t i) { return float(p[i]); };
      return use(value, value);
    }
    case PixelType::f32: {
      const auto* p = reinterpret_cast<const float*>(data);
      const auto value = [p](std::size_t i) { return p[i]; };
      return use(value, value);
    }
  }
  return Vec4f(0);
}

template <class Color, class Alpha>
Vec4f decode(const Image& image, int x, int y, const Color& color, const Alpha& alpha) {
  const std::size_t i = (std::size_t(y) * image.width + x) * image.channels;
  if (image.channels <= 2) {
    const float grey = color(i);
    return {grey, grey, grey, image.channels == 2 ? alpha(i + 1) : 1};
  }
  return {color(i), color(i + 1), color(i + 2), image.channels == 4 ? alpha(i + 3) : 1};
}

int wrap_index(int i, int size, Wrap wrap) {
  if (unsigned(i) < unsigned(size)) return i;
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
  return with_decoder(
      image, space, [&](const auto& color, const auto& alpha) { return decode(image, x, y, color, alpha); });
}

Vec4f eval_texture(const Scene& scene, const Texture& texture, const Vec2f& uv, ColorSpace space) {
  const Image& image = scene.images[texture.image];
  float x = texel_coordinate(uv.x, image.width), y = texel_coordinate(uv.y, image.height);
  const auto column = [&](int i) { return wrap_index(i, image.width, texture.wrap_s); };
  const auto row = [&](int j) { return wrap_index(j, image.height, texture.wrap_t); };
  if (texture.filter == Filter::nearest)
    return texel(image, column(int(std::floor(x))), row(int(std::floor(y))), space);
  x -= 0.5f;
  y -= 0.5f;
  const float left = std::floor(x), top = std::floor(y), fx = x - left, fy = y - top;
  const int x0 = column(int(left)), x1 = column(int(left) + 1), y0 = row(int(top)), y1 = row(int(top) + 1);
  return with_decoder(image, space, [&](const auto& color, const auto& alpha) {
    const auto at = [&](int i, int j) { return decode(image, i, j, color, alpha); };
    return (at(x0, y0) * (1 - fx) + at(x1, y0) * fx) * (1 - fy) +
           (at(x0, y1) * (1 - fx) + at(x1, y1) * fx) * fy;
  });
}

Vec4f eval_texture(const Scene& scene, const TextureRef& ref, const std::array<Vec2f, 2>& uvs,
                   ColorSpace space) {
  const Vec2f& uv = uvs[ref.uv_set];
  const auto& m = ref.transform;
  return eval_texture(scene, scene.textures[ref.texture],
                      {m[0] * uv.x + m[1] * uv.y + m[2], m[3] * uv.x + m[4] * uv.y + m[5]}, space);
}

}  // namespace parian
