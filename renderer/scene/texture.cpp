#include "renderer/scene/texture.h"

#include <Imath/half.h>

#include "renderer/scene/texel_source.h"

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

const SrgbTable kSrgb;

/// Calls use(color, alpha) with the functions that decode colour and alpha element i of `data`, so that the
/// choice of the type is made once for all texels of a lookup.
template <class Use>
Vec4f with_decoder(PixelType type, const std::byte* data, ColorSpace space, const Use& use) {
  switch (type) {
    case PixelType::u8: {
      const auto* p = reinterpret_cast<const std::uint8_t*>(data);
      const auto linear = [p](std::size_t i) { return float(p[i]) * (1.0f / 255); };
      if (space == ColorSpace::linear) return use(linear, linear);
      return use([p](std::size_t i) { return kSrgb.value[p[i]]; }, linear);
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

/// The pixel whose first element has index i.
template <class Color, class Alpha>
Vec4f decode(const Image& image, std::size_t i, const Color& color, const Alpha& alpha) {
  if (image.channels <= 2) {
    const float grey = color(i);
    return {grey, grey, grey, image.channels == 2 ? alpha(i + 1) : 1};
  }
  return {color(i), color(i + 1), color(i + 2), image.channels == 4 ? alpha(i + 3) : 1};
}

std::size_t element_index(const Image& image, int x, int y) {
  return (std::size_t(y) * image.width + x) * image.channels;
}

/// The mean of the pixels whose first elements have the indices i, by weights w that sum to 1.
template <class Color, class Alpha>
Vec4f decode_mean(const Image& image, const std::array<std::size_t, 4>& i, const Vec4f& w, const Color& color,
                  const Alpha& alpha) {
  const auto mean = [&](const auto& decoder, int c) {
    return decoder(i[0] + c) * w.x + decoder(i[1] + c) * w.y + decoder(i[2] + c) * w.z +
           decoder(i[3] + c) * w.w;
  };
  if (image.channels <= 2) {
    const float grey = mean(color, 0);
    return {grey, grey, grey, image.channels == 2 ? mean(alpha, 1) : 1};
  }
  return {mean(color, 0), mean(color, 1), mean(color, 2), image.channels == 4 ? mean(alpha, 3) : 1};
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

int floor_to_int(float x) {
  const int i = int(x);
  return i - (float(i) > x);
}

/// Two neighbouring texels, of which the second counts `share`.
struct Between {
  int first, second;
  float share;
};

Between between_texels(float x, int size, Wrap wrap) {
  const int i = floor_to_int(x - 0.5f);
  return {wrap_index(i, size, wrap), wrap_index(i + 1, size, wrap), x - 0.5f - float(i)};
}

constexpr std::size_t kLargestPixel = 4 * sizeof(float);

/// The four pixels of a linear lookup, one after the other, of an image that is not in memory.
const std::byte* fetch_corners(const Image& image, const Between& s, const Between& t, std::byte* out) {
  const std::array<Vec2i, 4> places{Vec2i(s.first, t.first), Vec2i(s.second, t.first),
                                    Vec2i(s.first, t.second), Vec2i(s.second, t.second)};
  image.source->fetch(places, out);
  return out;
}

}  // namespace

Vec4f texel(const Image& image, int x, int y, ColorSpace space) {
  const std::byte* data = image.pixels.data();
  std::size_t element = element_index(image, x, y);
  alignas(float) std::byte fetched[kLargestPixel];
  if (!data) [[unlikely]] {
    const Vec2i place(x, y);
    image.source->fetch({&place, 1}, fetched);
    data = fetched;
    element = 0;
  }
  return with_decoder(image.type, data, space, [&](const auto& color, const auto& alpha) {
    return decode(image, element, color, alpha);
  });
}

Vec4f eval_texture(const Scene& scene, const Texture& texture, const Vec2f& uv, ColorSpace space) {
  const Image& image = scene.images[texture.image];
  const float x = texel_coordinate(uv.x, image.width), y = texel_coordinate(uv.y, image.height);
  if (texture.filter == Filter::nearest)
    return texel(image, wrap_index(floor_to_int(x), image.width, texture.wrap_s),
                 wrap_index(floor_to_int(y), image.height, texture.wrap_t), space);
  const Between s = between_texels(x, image.width, texture.wrap_s),
                t = between_texels(y, image.height, texture.wrap_t);
  std::array<std::size_t, 4> corners{
      element_index(image, s.first, t.first), element_index(image, s.second, t.first),
      element_index(image, s.first, t.second), element_index(image, s.second, t.second)};
  const Vec4f weights((1 - s.share) * (1 - t.share), s.share * (1 - t.share), (1 - s.share) * t.share,
                      s.share * t.share);
  const std::byte* data = image.pixels.data();
  alignas(float) std::byte fetched[4 * kLargestPixel];
  if (!data) [[unlikely]] {
    data = fetch_corners(image, s, t, fetched);
    for (std::size_t i = 0; i < 4; ++i) corners[i] = i * image.channels;
  }
  return with_decoder(image.type, data, space, [&](const auto& color, const auto& alpha) {
    return decode_mean(image, corners, weights, color, alpha);
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
