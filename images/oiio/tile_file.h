/// A file without a name, for what does not fit into memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace parian::oiio {

/// A temporary file that no other program sees and that is gone with this one, however it ends: its name is
/// taken away as soon as it is open. For any threads.
class TileFile {
 public:
  /// In $TMPDIR, or /tmp. Throws InputError.
  TileFile();
  ~TileFile();
  TileFile(const TileFile&) = delete;
  TileFile& operator=(const TileFile&) = delete;

  /// Throws InputError: no room on the disk, for the most part.
  void write(std::span<const std::byte> bytes, std::uint64_t offset);

  /// Fills `bytes`. What was wrong, or "".
  std::string read(std::span<std::byte> bytes, std::uint64_t offset) const;

 private:
  std::string folder_;
  int descriptor_ = -1;
};

}  // namespace parian::oiio
