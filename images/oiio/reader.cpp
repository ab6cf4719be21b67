#include "images/oiio/reader.h"

#include <utility>

#include "images/oiio/encoded.h"
#include "renderer/base/error.h"

namespace parian::oiio {
namespace {

// A side longer than this is a broken header, not a picture.
constexpr int kMaxSide = 65536;
// Nothing is allocated from a size that a header merely claims: beyond kPlainBytes the decoded picture may be
// at most kMaxExpansion times the file. Deflate, in PNG and EXR, expands at most 1032 times, JPEG less; and
// of both of these the libraries may hold the whole picture before they find that nothing is there
// (interlaced, progressive), so that little is plain for them.
constexpr std::size_t kPlainBytes = std::size_t(256) << 20;
constexpr std::size_t kPlainBytesOfWhole = std::size_t(16) << 20;
constexpr std::size_t kMaxExpansion = 1100;
}  // namespace

void configure_oiio(int threads) {
  OIIO::attribute("threads", 1);
  OIIO::attribute("debug", 0);  // Debian's build would print remarks of its own
  OIIO::attribute("exr_threads", threads);
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

Reader::Reader(std::span<const std::byte> bytes, std::string file)
    : name(std::move(file)),
      file_size(bytes.size()),
      plain_bytes(kPlainBytes),
      memory(bytes.data(), bytes.size()) {
  const std::string format = format_of(bytes, name);
  is_exr = format == "openexr";
  is_scene_referred = is_exr || format == "hdr";
  is_webp = format == "webp";
  if (format == "jpeg" || format == "png") plain_bytes = kPlainBytesOfWhole;
  if (format == "jpeg") {
    const JpegOutline outline = outline_of_jpeg(bytes);
    if (!outline.is_whole) throw InputError(name, "", "truncated: the JPEG has no end");
    // libjpeg decodes all of a progressive one when it is opened.
    check_claim(outline.width, outline.height, outline.channels, 1);
  }
  if (format == "png")
    if (const std::string problem = png_problem(bytes); !problem.empty()) throw InputError(name, "", problem);
  input = OIIO::ImageInput::create(format);
  if (!input)
    throw InputError(name, "", fmt::format("no reader for {}: {}", format, first_line(OIIO::geterror())));
  input->threads(1);
  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);
  OIIO::Filesystem::IOProxy* proxy = &memory;
  config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
  if (!input->open(name, spec, config)) fail(input->geterror());
  if (spec.width <= 0 || spec.height <= 0 || spec.width > kMaxSide || spec.height > kMaxSide ||
      spec.nchannels <= 0)
    throw InputError(
        name, "",
        fmt::format("{} x {} pixels; expected 1 to {} each way", spec.width, spec.height, kMaxSide));
  if (spec.deep || spec.depth > 1)
    throw InputError(name, "", "expected a flat image, not a deep one or a volume");
  if (is_exr && (spec.width != spec.full_width || spec.height != spec.full_height || spec.x != spec.full_x ||
                 spec.y != spec.full_y))
    throw InputError(name, "", "the data window is not the display window; expected a whole picture");
}

void Reader::fail(const std::string& text) const {
  throw InputError(
      name, "",
      fmt::format("broken or truncated: {}", text.empty() ? "cannot be decoded" : first_line(text)));
}

std::size_t Reader::check_claim(std::size_t width, std::size_t height, std::size_t channels,
                                std::size_t sample_bytes) const {
  const std::size_t bytes = width * height * channels * sample_bytes;
  if (bytes > plain_bytes && bytes / kMaxExpansion > file_size)
    throw InputError(name, "",
                     fmt::format("{} x {} x {} claimed by a file of {} bytes: more than it can hold", width,
                                 height, channels, file_size));
  return bytes;
}

std::size_t Reader::checked_bytes(int channels, std::size_t sample_bytes) const {
  return check_claim(std::size_t(spec.width), std::size_t(spec.height), std::size_t(channels), sample_bytes);
}

void Reader::read_rows(int begin, int end, int first, int last, OIIO::TypeDesc type, void* out) {
  const bool ok = spec.tile_width
                      ? input->read_image(0, 0, first, last, type, out)
                      : input->read_scanlines(0, 0, spec.y + begin, spec.y + end, 0, first, last, type, out);
  if (ok && !input->has_error()) return;
  const std::string text = input->geterror();
  // What many a JPEG in the world has, and what harms no pixel.
  if (ok && text.find("extraneous bytes before marker") != std::string::npos) return;
  fail(text);
}

}  // namespace parian::oiio
