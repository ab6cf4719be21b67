#include "images/image_io.h"

#include <Imath/half.h>
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "renderer/base/error.h"
#include "renderer/base/parallel.h"

namespace parian {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<unsigned char>;

// An empty folder of the test's own, gone with it.
class ImageIo : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) / (std::string("parian_image_io_") + test->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string write(const std::string& name, const Bytes& bytes) const {
    std::ofstream(path(name), std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    return path(name);
  }
  std::size_t files() const {
    return std::size_t(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

 private:
  fs::path folder_;
};

// A file in memory, by OpenImageIO itself.
template <class T>
Bytes encode(const char* format, int width, int height, int channels, OIIO::TypeDesc type, const T* pixels,
             const std::function<void(OIIO::ImageSpec&)>& change = {}) {
  OIIO::ImageSpec spec(width, height, channels, type);
  if (change) change(spec);
  Bytes bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  const auto output = OIIO::ImageOutput::create(format, &memory);
  EXPECT_TRUE(output && output->open(std::string("memory.") + format, spec) &&
              output->write_image(OIIO::BaseTypeFromC<T>::value, pixels) && output->close());
  return bytes;
}

Image read(const Bytes& bytes) { return read_image(std::as_bytes(std::span(bytes)), "picture"); }

// The message of the InputError that `call` throws, or "".
template <class Call>
std::string error_of(Call call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

template <class T>
std::vector<T> texels(const Image& image) {
  std::vector<T> values(image.pixels.size() / sizeof(T));
  std::memcpy(values.data(), image.pixels.data(), image.pixels.size());
  return values;
}

Bytes read_bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// 5 x 3 texels, every value different.
template <class T>
std::vector<T> ramp(int channels, double scale) {
  std::vector<T> values(std::size_t(15) * channels);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = T(scale * double(i + 1));
  return values;
}

TEST_F(ImageIo, KeepsTheBitDepthAndChannelsOfPng) {
  for (int channels = 1; channels <= 4; ++channels) {
    const auto bytes8 = ramp<std::uint8_t>(channels, 4);
    const Image image8 = read(encode("png", 5, 3, channels, OIIO::TypeDesc::UINT8, bytes8.data(),
                                     [](auto& spec) { spec.attribute("oiio:UnassociatedAlpha", 1); }));
    EXPECT_EQ(image8.width, 5);
    EXPECT_EQ(image8.height, 3);
    EXPECT_EQ(image8.channels, channels);
    EXPECT_EQ(image8.type, PixelType::u8);
    EXPECT_EQ(texels<std::uint8_t>(image8), bytes8) << channels << " channels";

    const auto words = ramp<std::uint16_t>(channels, 1091);
    const Image image16 = read(encode("png", 5, 3, channels, OIIO::TypeDesc::UINT16, words.data(),
                                      [](auto& spec) { spec.attribute("oiio:UnassociatedAlpha", 1); }));
    EXPECT_EQ(image16.type, PixelType::u16);
    EXPECT_EQ(texels<std::uint16_t>(image16), words) << channels << " channels";
  }
}

// A 2 x 2 PNG of one bit per pixel, palette {(10, 20, 30), (200, 100, 50)} with alpha {255, 64}, made by
// hand: no writer here makes palettes.
const Bytes kPalettePng = {
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52, 0x00,
    0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x02, 0x01, 0x03, 0x00, 0x00, 0x00, 0x48, 0x78, 0x9f, 0x67, 0x00,
    0x00, 0x00, 0x06, 0x50, 0x4c, 0x54, 0x45, 0x0a, 0x14, 0x1e, 0xc8, 0x64, 0x32, 0x77, 0xa0, 0xb3, 0x9c,
    0x00, 0x00, 0x00, 0x02, 0x74, 0x52, 0x4e, 0x53, 0xff, 0x40, 0x93, 0x6b, 0x71, 0xda, 0x00, 0x00, 0x00,
    0x0c, 0x49, 0x44, 0x41, 0x54, 0x78, 0xda, 0x63, 0x70, 0x60, 0x68, 0x00, 0x00, 0x01, 0x44, 0x00, 0xc1,
    0x04, 0x87, 0xcf, 0xfa, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

TEST_F(ImageIo, ExpandsPalettes) {
  const Image image = read(kPalettePng);
  EXPECT_EQ(image.channels, 4);
  const std::vector<std::uint8_t> first{10, 20, 30, 255}, second{200, 100, 50, 64};
  std::vector<std::uint8_t> expected;
  for (const auto* color : {&first, &second, &second, &first})
    expected.insert(expected.end(), color->begin(), color->end());
  EXPECT_EQ(texels<std::uint8_t>(image), expected);
}

// An 8 x 8 JPEG with the four components of CMYK all constant, stored inverted as Adobe does: 220, 200, 195,
// 255; also made by hand.
const Bytes kCmykJpeg = {
    0xff, 0xd8, 0xff, 0xee, 0x00, 0x0e, 0x41, 0x64, 0x6f, 0x62, 0x65, 0x00, 0x64, 0x00, 0x00, 0x00,
    0x00, 0x00, 0xff, 0xdb, 0x00, 0x43, 0x00, 0x08, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01,
    0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01,
    0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01,
    0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01,
    0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0xff, 0xc0, 0x00, 0x14, 0x08, 0x00, 0x08, 0x00, 0x08,
    0x04, 0x01, 0x11, 0x00, 0x02, 0x11, 0x00, 0x03, 0x11, 0x00, 0x04, 0x11, 0x00, 0xff, 0xc4, 0x00,
    0x14, 0x00, 0x01, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,
    0x00, 0x00, 0x07, 0xff, 0xc4, 0x00, 0x14, 0x10, 0x01, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xff, 0xda, 0x00, 0x0e, 0x04, 0x01, 0x00,
    0x02, 0x00, 0x03, 0x00, 0x04, 0x00, 0x00, 0x3f, 0x00, 0x5c, 0x24, 0x10, 0xcf, 0xef, 0xff, 0xd9};

TEST_F(ImageIo, ReadsJpegGreyAndColourAndConvertsCmyk) {
  const std::vector<std::uint8_t> grey(64, 137);
  const Image grey_image = read(encode("jpeg", 8, 8, 1, OIIO::TypeDesc::UINT8, grey.data()));
  EXPECT_EQ(grey_image.channels, 1);
  for (const int value : texels<std::uint8_t>(grey_image)) EXPECT_NEAR(value, 137, 1);

  std::vector<std::uint8_t> color(192);
  for (std::size_t i = 0; i < 64; ++i) color[3 * i] = 200, color[3 * i + 1] = 100, color[3 * i + 2] = 50;
  const auto values =
      texels<std::uint8_t>(read(encode("jpeg", 8, 8, 3, OIIO::TypeDesc::UINT8, color.data())));
  ASSERT_EQ(values.size(), 192u);
  for (std::size_t i = 0; i < 192; ++i) EXPECT_NEAR(values[i], color[i], 3);

  const Image converted = read(kCmykJpeg);
  ASSERT_EQ(converted.channels, 3);
  const int inverted[3] = {220, 200, 195};
  const auto rgb = texels<std::uint8_t>(converted);
  for (std::size_t i = 0; i < 192; ++i) EXPECT_NEAR(rgb[i], inverted[i % 3], 1);
}

TEST_F(ImageIo, ReadsRadianceHdrAsFloat) {
  const auto radiance = ramp<float>(3, 0.37);
  const Image image = read(encode("hdr", 5, 3, 3, OIIO::TypeDesc::FLOAT, radiance.data()));
  EXPECT_EQ(image.type, PixelType::f32);
  EXPECT_EQ(image.channels, 3);
  const auto values = texels<float>(image);
  // A mantissa of 8 bits shared by three channels.
  for (std::size_t i = 0; i < values.size(); ++i)
    EXPECT_NEAR(values[i], radiance[i], radiance[i / 3 * 3 + 2] / 128) << i;
}

TEST_F(ImageIo, KeepsHalfAndFloatOfExrAndDropsItsAlpha) {
  std::vector<Imath::half> halves(60);
  std::vector<float> floats(60);
  for (int i = 0; i < 60; ++i)
    halves[std::size_t(i)] = Imath::half(floats[std::size_t(i)] = 0.25f * float(i));
  const Image half_image = read(encode("openexr", 5, 3, 4, OIIO::TypeDesc::HALF, floats.data()));
  EXPECT_EQ(half_image.type, PixelType::f16);
  ASSERT_EQ(half_image.channels, 3);
  const auto half_values = texels<std::uint16_t>(half_image);
  for (std::size_t i = 0; i < 45; ++i) EXPECT_EQ(half_values[i], halves[i / 3 * 4 + i % 3].bits());

  const Image float_image = read(encode("openexr", 5, 3, 4, OIIO::TypeDesc::FLOAT, floats.data()));
  EXPECT_EQ(float_image.type, PixelType::f32);
  const auto float_values = texels<float>(float_image);
  ASSERT_EQ(float_values.size(), 45u);
  for (std::size_t i = 0; i < 45; ++i) EXPECT_EQ(float_values[i], floats[i / 3 * 4 + i % 3]);
}

TEST_F(ImageIo, ReadsTiledExr) {
  const std::vector<float> pixels(100 * 70 * 3, 0.5f);
  const Image image = read(encode("openexr", 100, 70, 3, OIIO::TypeDesc::FLOAT, pixels.data(),
                                  [](auto& spec) { spec.tile_width = spec.tile_height = 32; }));
  EXPECT_EQ(texels<float>(image), pixels);
}

TEST_F(ImageIo, TakesColourFromAmongTheLayersOfAnExr) {
  const auto pixels = ramp<float>(6, 0.1);
  const Image image = read(encode("openexr", 5, 3, 6, OIIO::TypeDesc::FLOAT, pixels.data(), [](auto& spec) {
    spec.channelnames = {"albedo.R", "albedo.G", "albedo.B", "R", "G", "B"};
  }));
  ASSERT_EQ(image.channels, 3);
  const auto values = texels<float>(image);
  for (std::size_t i = 0; i < 45; ++i) EXPECT_EQ(values[i], pixels[i / 3 * 6 + 3 + i % 3]);
}

TEST_F(ImageIo, KeepsWebpAlphaUnassociated) {
  // The writer below takes associated alpha and divides it out under a gamma of 2.2; the reader of the
  // library multiplies without one. `stored` is what is in the file.
  const std::uint8_t stored[4] = {200, 100, 60, 128};
  std::vector<std::uint8_t> pixels;
  for (int i = 0; i < 64; ++i)
    for (int c = 0; c < 4; ++c)
      pixels.push_back(c < 3 ? std::uint8_t(stored[c] * std::pow(128.0 / 255, 1 / 2.2) + 0.5) : stored[3]);
  const Image image = read(encode("webp", 8, 8, 4, OIIO::TypeDesc::UINT8, pixels.data(),
                                  [](auto& spec) { spec.attribute("compression", "lossless"); }));
  ASSERT_EQ(image.channels, 4);
  const auto values = texels<std::uint8_t>(image);
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_NEAR(values[i], stored[i % 4], 2) << i;
}

TEST_F(ImageIo, RefusesWhatIsNoImage) {
  EXPECT_NE(error_of([&] { read({}); }).find("picture: expected a PNG"), std::string::npos);
  EXPECT_NE(error_of([&] { read({'G', 'I', 'F', '8'}); }).find("expected a PNG"), std::string::npos);
  EXPECT_NE(error_of([&] {
              read({0xab, 'K', 'T', 'X', ' ', '2', '0', 0xbb});
            }).find("KTX 2"),
            std::string::npos);
  EXPECT_EQ(error_of([&] { read_image(path("none.png")); }), path("none.png") + ": no such file");
  EXPECT_NE(error_of([&] { read_image(path("")); }).find("expected a file"), std::string::npos);
  EXPECT_NE(error_of([&] {
              read_picture(write("text.exr", {'h', 'i'}));
            }).find("text.exr: expected"),
            std::string::npos);
}

// Every format, cut anywhere: an error, never a picture with its end made up.
TEST_F(ImageIo, RefusesTruncatedFiles) {
  const int width = 64, height = 40;
  std::vector<std::uint8_t> bytes(std::size_t(width * height * 3));
  std::vector<float> floats(bytes.size());
  std::uint32_t noise = 1;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    noise = noise * 1664525u + 1013904223u;
    bytes[i] = std::uint8_t(noise >> 24);
    floats[i] = float(noise >> 8) * 0x1p-24f;
  }
  const auto progressive = [](OIIO::ImageSpec& spec) { spec.attribute("jpeg:progressive", 1); };
  const auto tiled = [](OIIO::ImageSpec& spec) { spec.tile_width = spec.tile_height = 32; };
  const std::pair<const char*, Bytes> files[] = {
      {"png", encode("png", width, height, 3, OIIO::TypeDesc::UINT8, bytes.data())},
      {"jpeg", encode("jpeg", width, height, 3, OIIO::TypeDesc::UINT8, bytes.data())},
      {"progressive jpeg",
       encode("jpeg", width, height, 3, OIIO::TypeDesc::UINT8, bytes.data(), progressive)},
      {"webp", encode("webp", width, height, 3, OIIO::TypeDesc::UINT8, bytes.data())},
      {"hdr", encode("hdr", width, height, 3, OIIO::TypeDesc::FLOAT, floats.data())},
      {"exr", encode("openexr", width, height, 3, OIIO::TypeDesc::FLOAT, floats.data())},
      {"tiled exr", encode("openexr", width, height, 3, OIIO::TypeDesc::FLOAT, floats.data(), tiled)}};
  for (const auto& [name, whole] : files) {
    EXPECT_EQ(error_of([&] { read(whole); }), "") << name;
    for (const double part : {0.999, 0.95, 0.7, 0.5, 0.2, 0.05, 0.01}) {
      const Bytes cut(whole.begin(), whole.begin() + std::ptrdiff_t(double(whole.size()) * part));
      EXPECT_NE(error_of([&] { read(cut); }), "") << name << " cut to " << part;
    }
  }
}

// Stray bytes before a marker are common and harmless; but libjpeg warns of them and then of nothing else, so
// that a file that has them and is cut must be found out otherwise.
TEST_F(ImageIo, AcceptsStrayBytesInJpegButNoMissingEnd) {
  std::vector<std::uint8_t> pixels(64 * 64 * 3);
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = std::uint8_t(i * i >> 4);
  const Bytes clean = encode("jpeg", 64, 64, 3, OIIO::TypeDesc::UINT8, pixels.data());
  // Before the quantization tables.
  std::size_t marker = 0;
  while (clean[marker] != 0xff || clean[marker + 1] != 0xdb) ++marker;
  Bytes stray = clean;
  stray.insert(stray.begin() + std::ptrdiff_t(marker), {0x12, 0x34});
  EXPECT_EQ(error_of([&] { read(stray); }), "");
  EXPECT_EQ(texels<std::uint8_t>(read(stray)), texels<std::uint8_t>(read(clean)));
  stray.resize(stray.size() * 9 / 10);
  EXPECT_NE(error_of([&] { read(stray); }).find("the JPEG has no end"), std::string::npos);
}

// Flipped bytes may decode to other pixels or be refused; nothing else may happen.
TEST_F(ImageIo, SurvivesDamagedFiles) {
  const auto bytes = ramp<std::uint8_t>(3, 4);
  const auto floats = ramp<float>(3, 0.1);
  const Bytes files[] = {encode("png", 5, 3, 3, OIIO::TypeDesc::UINT8, bytes.data()),
                         encode("jpeg", 5, 3, 3, OIIO::TypeDesc::UINT8, bytes.data()),
                         encode("webp", 5, 3, 3, OIIO::TypeDesc::UINT8, bytes.data()),
                         encode("hdr", 5, 3, 3, OIIO::TypeDesc::FLOAT, floats.data()),
                         encode("openexr", 5, 3, 3, OIIO::TypeDesc::FLOAT, floats.data())};
  int read_anyway = 0, refused = 0;
  std::uint32_t noise = 7;
  for (const Bytes& whole : files)
    for (int round = 0; round < 300; ++round) {
      Bytes damaged = whole;
      for (int i = 0; i < 3; ++i) {
        noise = noise * 1664525u + 1013904223u;
        damaged[(noise >> 8) % damaged.size()] = std::uint8_t(noise >> 24);
      }
      ++(error_of([&] { read(damaged); }).empty() ? read_anyway : refused);
    }
  EXPECT_GT(read_anyway, 0);
  EXPECT_GT(refused, 100);
}

TEST_F(ImageIo, RefusesSizesThatTheFileOnlyClaims) {
  const auto bytes = ramp<std::uint8_t>(3, 4);
  // Width and height of a PNG are the 8 bytes from 16 on; its checksum is then wrong too, which only proves
  // the header was not believed. The HDR's are text, and stand alone.
  const auto hdr = [](const std::string& size) {
    const std::string text = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + size + "\n\2\2\2\2";
    return Bytes(text.begin(), text.end());
  };
  EXPECT_NE(error_of([&] { read(hdr("-Y 60000 +X 60000")); }).find("more than it can hold"),
            std::string::npos);
  EXPECT_NE(error_of([&] { read(hdr("-Y 70000 +X 70000")); }).find("expected 1 to 65536"), std::string::npos);
  EXPECT_NE(error_of([&] { read(hdr("-Y 0 +X 5")); }), "");
  EXPECT_NE(error_of([&] { read(hdr("-Y -3 +X 5")); }), "");
}

TEST_F(ImageIo, RefusesNanAndInfWithTheirPlace) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()})
    for (const auto type : {OIIO::TypeDesc::HALF, OIIO::TypeDesc::FLOAT}) {
      auto floats = ramp<float>(3, 0.1);
      EXPECT_EQ(error_of([&] { read(encode("openexr", 5, 3, 3, type, floats.data())); }), "");
      floats[3 * (2 * 5 + 4) + 1] = bad;
      EXPECT_EQ(error_of([&] { read(encode("openexr", 5, 3, 3, type, floats.data())); }),
                "picture: pixel (4, 2): NaN or Inf; expected finite values");
    }
}

TEST_F(ImageIo, ReadsInParallel) {
  const auto words = ramp<std::uint16_t>(3, 1000);
  const auto floats = ramp<float>(3, 0.1);
  const Bytes png = encode("png", 5, 3, 3, OIIO::TypeDesc::UINT16, words.data());
  const Bytes exr = encode("openexr", 5, 3, 3, OIIO::TypeDesc::FLOAT, floats.data());
  const Image png_image = read(png), exr_image = read(exr);
  std::atomic<int> wrong{0};
  parallel_for(200, 1,
               [&](std::size_t i) { wrong += !(i % 2 ? read(png) == png_image : read(exr) == exr_image); });
  EXPECT_EQ(wrong, 0);
}

Picture layered() {
  Picture picture;
  picture.width = 37;
  picture.height = 23;
  picture.channels = {"R", "G", "B", "albedo.R", "albedo.G", "albedo.B", "samples", "variance.R"};
  picture.metadata = {{"parian:spp", "64"}, {"version", "0.1"}, {"parian:scene", "a \"quoted\" scene.gltf"}};
  for (std::size_t i = 0; i < std::size_t(37 * 23 * 8); ++i)
    picture.pixels.push_back(i % 3 ? float(i) * 1.37e-3f : -1e30f / float(i + 1));
  return picture;
}

TEST_F(ImageIo, ExrKeepsLayersAndMetadataExactly) {
  const Picture written = layered();
  write_exr(written, path("a.exr"));
  const Picture back = read_picture(path("a.exr"));
  EXPECT_EQ(back.width, 37);
  EXPECT_EQ(back.height, 23);
  ASSERT_EQ(back.channels.size(), 8u);
  for (std::size_t c = 0; c < 8; ++c) {
    const auto found = std::find(back.channels.begin(), back.channels.end(), written.channels[c]);
    ASSERT_NE(found, back.channels.end()) << written.channels[c];
    const std::size_t d = std::size_t(found - back.channels.begin());
    for (std::size_t i = 0; i < std::size_t(37 * 23); ++i)
      ASSERT_EQ(back.pixels[8 * i + d], written.pixels[8 * i + c])
          << written.channels[c] << " of pixel " << i;
  }
  for (const auto& [key, value] : written.metadata) {
    const auto found = back.metadata.find(key);
    ASSERT_NE(found, back.metadata.end()) << key;
    EXPECT_EQ(found->second, value);
  }
  EXPECT_EQ(back.metadata.at("Software"), "Parian");
  for (const auto& [key, value] : back.metadata)
    EXPECT_TRUE(key.find("oiio:") != 0 && key.find("openexr:") != 0 && key != "compression") << key;
  // A second trip changes nothing.
  write_exr(back, path("b.exr"));
  EXPECT_EQ(read_bytes(path("a.exr")), read_bytes(path("b.exr")));
}

TEST_F(ImageIo, ExrIsTheSameBytesEachTimeAndSaysItsPrimaries) {
  write_exr(layered(), path("a.exr"));
  const Bytes bytes = read_bytes(path("a.exr"));
  const std::string text(bytes.begin(), bytes.end());
  EXPECT_NE(text.find("chromaticities"), std::string::npos);
  // The name under which the library writes the time of day.
  EXPECT_EQ(text.find("capDate"), std::string::npos);
  EXPECT_EQ(files(), 1u);
}

TEST_F(ImageIo, FailedWritesLeaveNothingBehind) {
  const Picture picture = layered();
  EXPECT_NE(
      error_of([&] { write_exr(picture, path("no-such-folder/a.exr")); }).find("a.exr: cannot be written"),
      std::string::npos);
  fs::create_directory(path("folder.exr"));
  EXPECT_NE(error_of([&] { write_exr(picture, path("folder.exr")); }).find("not a file"), std::string::npos);
  EXPECT_NE(error_of([&] { write_exr(picture, "/dev/full"); }).find("not a file"), std::string::npos);
  EXPECT_EQ(files(), 1u);
  // A disk that fills up while the file is written: the picture that was there stays, and no temporary file
  // does.
  write_exr(picture, path("a.exr"));
  const Bytes before = read_bytes(path("a.exr"));
  rlimit limit{};
  getrlimit(RLIMIT_FSIZE, &limit);
  const rlimit small{1000, limit.rlim_max};
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);
  const std::string message = error_of([&] { write_exr(picture, path("a.exr")); });
  setrlimit(RLIMIT_FSIZE, &limit);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_NE(message.find("a.exr: cannot be written"), std::string::npos) << message;
  EXPECT_EQ(read_bytes(path("a.exr")), before);
  EXPECT_EQ(files(), 2u);
  // What was there stays where the new file cannot be made.
  const std::string kept = write("kept.gif", {1, 2, 3});
  EXPECT_NE(error_of([&] { write_display_image(picture, kept); }).find(".png, .jpg or .jpeg"),
            std::string::npos);
  EXPECT_EQ(read_bytes(kept), (Bytes{1, 2, 3}));
}

TEST_F(ImageIo, DisplayImageRoundsToNearest) {
  Picture picture;
  picture.width = 8;
  picture.height = 1;
  picture.channels = {"samples", "B", "G", "R"};
  const float values[] = {0,
                          0.4999f / 255,
                          0.5001f / 255,
                          100.4999f / 255,
                          100.5001f / 255,
                          1,
                          7,
                          std::numeric_limits<float>::quiet_NaN()};
  const int expected[] = {0, 0, 1, 100, 101, 255, 255, 0};
  for (const float value : values) picture.pixels.insert(picture.pixels.end(), {9, -1, 0.5f, value});
  write_display_image(picture, path("a.PNG"));
  const Image image = read_image(path("a.PNG"));
  ASSERT_EQ(image.channels, 3);
  const auto texel = texels<std::uint8_t>(image);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(texel[3 * i], expected[i]) << i;
    EXPECT_EQ(texel[3 * i + 1], 128);
    EXPECT_EQ(texel[3 * i + 2], 0);
  }
  write_display_image(picture, path("a.jpeg"));
  EXPECT_EQ(read_image(path("a.jpeg")).width, 8);
  picture.channels[3] = "X";
  EXPECT_NE(error_of([&] { write_display_image(picture, path("b.png")); }).find("no channel R"),
            std::string::npos);
  EXPECT_EQ(files(), 2u);
}

}  // namespace
}  // namespace parian
