/// An open image, its header checked.
#pragma once

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <cstddef>
#include <memory>
#include <span>
#include <string>

namespace parian::oiio {

/// Sets OpenImageIO up for the process: images are decoded in parallel, each on one thread; only OpenEXR
/// decodes one image on several, from one pool of the process that has as many as Parian's own.
void configure_oiio(int threads);

std::string first_line(const std::string& text);

/// An open image and the memory it is read from, which has to stay.
struct Reader {
  std::string name;
  std::size_t file_size;
  std::size_t plain_bytes;  // what a header may claim whatever the size of the file
  OIIO::Filesystem::IOMemReader memory;
  std::unique_ptr<OIIO::ImageInput> input;
  OIIO::ImageSpec spec;
  bool is_exr = false, is_webp = false, is_scene_referred = false;

  /// Throws InputError, which calls the image `file`: no image, broken, cut, absurd.
  Reader(std::span<const std::byte> bytes, std::string file);

  /// Throws InputError with the library's own words, in one line.
  [[noreturn]] void fail(const std::string& text) const;

  /// The size of the picture with so many channels. Throws InputError where the file cannot hold it.
  std::size_t checked_bytes(int channels, std::size_t sample_bytes) const;

  /// Rows [begin, end) of the channels [first, last); tiled files can only be asked for the whole. Throws
  /// InputError.
  void read_rows(int begin, int end, int first, int last, OIIO::TypeDesc type, void* out);

 private:
  std::size_t check_claim(std::size_t width, std::size_t height, std::size_t channels,
                          std::size_t sample_bytes) const;
};

}  // namespace parian::oiio
