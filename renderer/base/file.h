/// Whole files: read at once, and written so that they appear whole or not at all.
#pragma once

#include <cstddef>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace parian {

/// The bytes of a file. Throws InputError.
std::vector<char> read_file(const std::string& path);

/// A file that is written piece by piece and appears at once: until commit() the bytes go to a temporary file
/// beside it, which is gone with the writer. Members throw InputError naming `path`, also where `path` is
/// there and is no regular file.
class FileWriter {
 public:
  explicit FileWriter(const std::string& path);
  ~FileWriter();
  FileWriter(const FileWriter&) = delete;
  FileWriter& operator=(const FileWriter&) = delete;

  void write(const void* bytes, std::size_t size);
  void write(std::string_view bytes) { write(bytes.data(), bytes.size()); }
  /// All bytes are with the system, or it throws: what may fail for want of space is over.
  void finish();
  /// finish(), and the file at `path` is this one.
  void commit();

 private:
  [[noreturn]] void fail(const std::string& reason) const;

  std::string path_, temporary_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream_;
};

/// The bytes become the file at `path`, or `path` stays as it was: they go to a temporary file beside it,
/// which is then renamed. Throws InputError, also where `path` is there and is no regular file.
void write_file(const std::string& path, std::string_view bytes);

/// A file that belongs to this program: at `installed` or `built`, relative to the folder of the executable;
/// in this order, normalised. Throws std::runtime_error where it is at neither.
std::string find_own_file(const std::string& installed, const std::string& built);

}  // namespace parian
