#include "images/image_difference.h"

#include <fmt/ranges.h>

#include "images/image_library.h"
#include "renderer/base/error.h"

namespace parian {

std::vector<ChannelDifference> channel_differences(const Picture& test, const Picture& reference) {
  return image_library().channel_differences(test, reference);
}

ColorEncoding shared_color_encoding(const std::string& test_file, const std::string& reference_file) {
  const ColorEncoding test = read_color_encoding(test_file), reference = read_color_encoding(reference_file);
  if (test.transfer != reference.transfer)
    throw InputError(test_file, "",
                     fmt::format("the values are {}; expected {} as in {}", test.transfer, reference.transfer,
                                 reference_file));
  if (!same_chromaticities(test, reference))
    throw InputError(
        test_file, "",
        fmt::format("chromaticities {}; expected {} as in {}", fmt::join(test.chromaticities, " "),
                    fmt::join(reference.chromaticities, " "), reference_file));
  return test;
}

void write_heat_map(std::span<const float> values, int width, int height, const std::string& path) {
  image_library().write_heat_map(values, width, height, path);
}

}  // namespace parian
