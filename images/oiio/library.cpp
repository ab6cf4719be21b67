#include "images/oiio/library.h"

#include "images/oiio/reader.h"

namespace parian::oiio {
namespace {

int threads_of_program = 1;

}  // namespace

int library_threads() { return threads_of_program; }

}  // namespace parian::oiio

extern "C" __attribute__((visibility("default"))) const parian::ImageLibrary* parian_open_image_library(
    int threads) {
  using namespace parian::oiio;
  threads_of_program = threads;
  configure_oiio(threads);
  static const parian::ImageLibrary library{read_image,          decoded_bytes,  read_picture,
                                            read_color_encoding, write_exr,      write_display_image,
                                            channel_differences, write_heat_map, make_tile_cache};
  return &library;
}
