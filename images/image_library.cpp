#include "images/image_library.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <atomic>
#include <stdexcept>
#include <string>

#include "renderer/base/file.h"
#include "renderer/base/parallel.h"

namespace parian {
namespace {

std::string find_library() { return find_own_file("../lib/parian/libparian_oiio.so", "libparian_oiio.so"); }

std::atomic<bool> is_open{false};

const ImageLibrary* open_library() {
  // Never closed: what it made may be there until the end.
  void* const library = dlopen(find_library().c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!library) throw std::runtime_error(fmt::format("images cannot be read or written: {}", dlerror()));
  auto* const open = reinterpret_cast<OpenImageLibrary*>(dlsym(library, kOpenImageLibrary));
  if (!open) throw std::runtime_error(fmt::format("images cannot be read or written: {}", dlerror()));
  is_open = true;
  return open(thread_count());
}

}  // namespace

void require_image_library() { find_library(); }

std::size_t image_library_bytes() { return is_open ? 0 : 126'000'000; }

const ImageLibrary& image_library() {
  static const ImageLibrary* const library = open_library();
  return *library;
}

}  // namespace parian
