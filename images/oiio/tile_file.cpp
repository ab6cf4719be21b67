#include "images/oiio/tile_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "renderer/base/error.h"

namespace parian::oiio {

TileFile::TileFile() {
  const char* folder = std::getenv("TMPDIR");
  folder_ = folder && *folder ? folder : "/tmp";
  std::string path = folder_ + "/parian-XXXXXX";  // mkostemp() writes over the last six letters
  descriptor_ = ::mkostemp(path.data(), O_CLOEXEC);
  if (descriptor_ < 0)
    throw InputError(folder_, "",
                     fmt::format("no temporary file for images can be made: {}", std::strerror(errno)));
  ::unlink(path.c_str());
}

TileFile::~TileFile() { ::close(descriptor_); }

void TileFile::write(std::span<const std::byte> bytes, std::uint64_t offset) {
  while (!bytes.empty()) {
    const ssize_t written = ::pwrite(descriptor_, bytes.data(), bytes.size(), off_t(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0)
      throw InputError(folder_, "",
                       fmt::format("the temporary file for images cannot be written: {}",
                                   std::strerror(written < 0 ? errno : ENOSPC)));
    bytes = bytes.subspan(std::size_t(written));
    offset += std::uint64_t(written);
  }
}

std::string TileFile::read(std::span<std::byte> bytes, std::uint64_t offset) const {
  while (!bytes.empty()) {
    const ssize_t got = ::pread(descriptor_, bytes.data(), bytes.size(), off_t(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0)
      return fmt::format("{}: the temporary file for images cannot be read: {}", folder_,
                         got < 0 ? std::strerror(errno) : "it has become shorter");
    bytes = bytes.subspan(std::size_t(got));
    offset += std::uint64_t(got);
  }
  return "";
}

}  // namespace parian::oiio
