/// A finished picture in memory: named float channels.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace parian {

/// Row-major from the top left, channels interleaved, linear unless said otherwise. Channel names are those
/// of OpenEXR: R, G, B for the beauty, LAYER.R and so on for the rest.
struct Picture {
  int width = 0, height = 0;
  std::vector<std::string> channels;
  std::vector<float> pixels;                    // width * height * channels.size()
  std::map<std::string, std::string> metadata;  // written to the file's header

  float* at(int x, int y) { return pixels.data() + (std::size_t(y) * width + x) * channels.size(); }
  const float* at(int x, int y) const {
    return pixels.data() + (std::size_t(y) * width + x) * channels.size();
  }
};

}  // namespace parian
