#include "renderer/color/display.h"

#include <OpenColorIO/OpenColorIO.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "renderer/base/error.h"
#include "renderer/base/file.h"
#include "renderer/base/parallel.h"

namespace parian {
namespace {

namespace OCIO = OCIO_NAMESPACE;

// Beyond the largest half there is nothing to see but white, and configs are not made for it.
constexpr float kLargest = 65504;

struct Config {
  std::string path;
  OCIO::ConstConfigRcPtr ocio;
  std::string display;
  std::vector<std::string> views;  // of the display, in the config's order: the first is its default
};

// What OpenColorIO says, in one line.
[[noreturn]] void fail(const std::string& config, const OCIO::Exception& error) {
  std::string text = error.what();
  std::replace(text.begin(), text.end(), '\n', ' ');
  throw InputError(config, "", text);
}

Config load_config() {
  Config config;
  const char* variable = std::getenv("OCIO");
  config.path = variable && *variable
                    ? variable
                    : find_own_file("../share/parian/ocio/config.ocio", "share/parian/ocio/config.ocio");
  try {
    config.ocio = OCIO::Config::CreateFromFile(config.path.c_str());
  } catch (const OCIO::Exception& error) {
    fail(config.path, error);
  }
  config.display = config.ocio->getDefaultDisplay();
  const char* display = config.display.c_str();
  for (int i = 0; i < config.ocio->getNumViews(display); ++i)
    config.views.emplace_back(config.ocio->getView(display, i));
  if (config.views.empty()) throw InputError(config.path, "", "has no display with a view");
  return config;
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

OCIO::BuiltinTransformRcPtr builtin(const char* style, OCIO::TransformDirection direction) {
  const OCIO::BuiltinTransformRcPtr transform = OCIO::BuiltinTransform::Create();
  transform->setStyle(style);
  transform->setDirection(direction);
  return transform;
}

// Linear Rec.709 to what the view shows. The config says what linear Rec.709 is, under one of the names in
// use, or where ACES2065-1 is, from which it can be told.
OCIO::GroupTransformRcPtr view_transform(const Config& config, const std::string& view) {
  const OCIO::GroupTransformRcPtr group = OCIO::GroupTransform::Create();
  std::string source;
  for (const char* name :
       {"Linear Rec.709 (sRGB)", "lin_rec709", "lin_rec709_srgb", "lin_srgb", "Linear Rec.709",
        "Linear BT.709", "Utility - Linear - Rec.709", "Utility - Linear - sRGB"})
    if (source.empty() && config.ocio->getColorSpace(name)) source = name;
  if (source.empty() && config.ocio->hasRole(OCIO::ROLE_INTERCHANGE_SCENE)) {
    group->appendTransform(builtin("UTILITY - ACES-AP1_to_LINEAR-REC709_BFD", OCIO::TRANSFORM_DIR_INVERSE));
    group->appendTransform(builtin("ACEScg_to_ACES2065-1", OCIO::TRANSFORM_DIR_FORWARD));
    source = OCIO::ROLE_INTERCHANGE_SCENE;
  }
  if (source.empty())
    throw InputError(
        config.path, "",
        "expected a colour space \"Linear Rec.709 (sRGB)\" (or lin_rec709, Utility - Linear - sRGB and "
        "the like), or a role aces_interchange");
  const OCIO::DisplayViewTransformRcPtr transform = OCIO::DisplayViewTransform::Create();
  transform->setSrc(source.c_str());
  transform->setDisplay(config.display.c_str());
  transform->setView(view.c_str());
  group->appendTransform(transform);
  return group;
}

// A comparison with NaN is false, so that NaN becomes 0.
float finite(float value, float low, float high) {
  return value > low ? std::min(value, high) : value <= low ? low : 0;
}

}  // namespace

std::vector<std::string> display_views() { return load_config().views; }

struct DisplayProcessor {
  OCIO::ConstCPUProcessorRcPtr ocio;
};

Display::Display(const std::string& view, bool fast) {
  const Config config = load_config();
  if (!view.empty() && std::find(config.views.begin(), config.views.end(), view) == config.views.end())
    throw UsageError(
        fmt::format("no view \"{}\" in {}; there are: {}", view, config.path, joined(config.views)));
  try {
    const auto transform = view_transform(config, view.empty() ? config.views.front() : view);
    // Without the library's approximations of log and pow: the same picture looks the same on every machine.
    const auto optimization = fast ? OCIO::OPTIMIZATION_DEFAULT : OCIO::OPTIMIZATION_LOSSLESS;
    processor_ = std::make_shared<DisplayProcessor>(
        config.ocio->getProcessor(transform)->getOptimizedCPUProcessor(optimization));
  } catch (const OCIO::Exception& error) {
    fail(config.path, error);
  }
}

Picture Display::apply(const Picture& linear, float exposure) const {
  std::size_t index[3];
  const std::string names[3] = {"R", "G", "B"};
  for (int c = 0; c < 3; ++c) {
    const auto found = std::find(linear.channels.begin(), linear.channels.end(), names[c]);
    if (found == linear.channels.end())
      throw InputError("picture", "", fmt::format("has no channel {}; expected R, G and B", names[c]));
    index[c] = std::size_t(found - linear.channels.begin());
  }

  Picture shown;
  shown.width = linear.width;
  shown.height = linear.height;
  shown.channels = {names[0], names[1], names[2]};
  shown.pixels.resize(std::size_t(linear.width) * linear.height * 3);
  const float scale = std::exp2(exposure);
  parallel_for(std::size_t(linear.height), 8, [&](std::size_t y) {
    float* row = shown.at(0, int(y));
    for (int x = 0; x < linear.width; ++x)
      for (int c = 0; c < 3; ++c)
        row[3 * x + c] = finite(linear.at(x, int(y))[index[c]] * scale, -kLargest, kLargest);
    OCIO::PackedImageDesc pixels(row, linear.width, 1, 3);
    processor_->ocio->apply(pixels);
    for (int i = 0; i < 3 * linear.width; ++i) row[i] = finite(row[i], 0, 1);
  });
  return shown;
}

Picture apply_display(const Picture& linear, const std::string& view, float exposure) {
  return Display(view).apply(linear, exposure);
}

}  // namespace parian
