#include <OpenImageIO/color.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <cmath>

#include "images/oiio/library.h"
#include "renderer/base/error.h"

namespace parian::oiio {
namespace {

// The picture's own memory as OpenImageIO sees it. It is not written to.
OIIO::ImageBuf wrap(const Picture& picture) {
  const OIIO::ImageSpec spec(picture.width, picture.height, int(picture.channels.size()),
                             OIIO::TypeDesc::FLOAT);
  return OIIO::ImageBuf(spec, const_cast<float*>(picture.pixels.data()));
}

}  // namespace

std::vector<ChannelDifference> channel_differences(const Picture& test, const Picture& reference) {
  const OIIO::ImageBuf difference = OIIO::ImageBufAlgo::sub(wrap(test), wrap(reference));
  const OIIO::ImageBufAlgo::PixelStats stats = OIIO::ImageBufAlgo::computePixelStats(difference),
                                       absolute = OIIO::ImageBufAlgo::computePixelStats(
                                           OIIO::ImageBufAlgo::abs(difference));
  std::vector<ChannelDifference> result;
  for (std::size_t c = 0; c < test.channels.size(); ++c) {
    const double count = double(stats.finitecount[c]);
    ChannelDifference d{test.channels[c],      stats.sum[c] / count, absolute.sum[c] / count,
                        stats.sum2[c] / count, stats.min[c],         stats.max[c]};
    if (stats.nancount[c] + stats.infcount[c] > 0)
      d.mean = d.mean_absolute = d.mean_square = d.lowest = d.highest = NAN;
    result.push_back(d);
  }
  return result;
}

void write_heat_map(std::span<const float> values, int width, int height, const std::string& path) {
  Picture map{width, height, {"value"}, {values.begin(), values.end()}, {}};
  // A comparison with NaN is false.
  for (float& value : map.pixels) value = value < 1 ? std::max(value, 0.0f) : 1;
  const OIIO::ImageBuf colors = OIIO::ImageBufAlgo::color_map(wrap(map), 0, "magma");
  map.channels = {"R", "G", "B"};
  map.pixels.resize(3 * map.pixels.size());
  if (!colors.get_pixels(OIIO::ROI(0, width, 0, height, 0, 1, 0, 3), OIIO::TypeDesc::FLOAT,
                         map.pixels.data()))
    throw InputError(path, "", fmt::format("the heat map cannot be made: {}", colors.geterror()));
  // The library gives the map's colours in linear light.
  for (float& value : map.pixels) value = OIIO::linear_to_sRGB(value);
  oiio::write_display_image(map, path);
}

}  // namespace parian::oiio
