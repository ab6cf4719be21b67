#include "renderer/base/file.h"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "renderer/base/error.h"

namespace parian {
namespace fs = std::filesystem;

std::vector<char> read_file(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) throw InputError(path, "", "no such file");
  if (!fs::is_regular_file(status)) throw InputError(path, "", "expected a file, found a folder or device");
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  const std::uintmax_t size = fs::file_size(path, error);
  if (!file || error) throw InputError(path, "", fmt::format("cannot be read: {}", std::strerror(errno)));
  std::vector<char> bytes(size);
  if (!file.read(bytes.data(), std::streamsize(size)))
    throw InputError(path, "", "cannot be read to its end");
  return bytes;
}

FileWriter::FileWriter(const std::string& path) : path_(path), stream_(nullptr, std::fclose) {
  static std::atomic<int> serial{0};
  std::error_code error;
  if (fs::exists(path, error) && !fs::is_regular_file(path, error)) fail("it is not a file");
  temporary_ = fmt::format("{}.{}-{}.tmp", path, ::getpid(), serial++);
  stream_.reset(std::fopen(temporary_.c_str(), "wb"));
  if (!stream_) {
    const std::string reason = std::strerror(errno);
    temporary_.clear();
    fail(reason);
  }
}

FileWriter::~FileWriter() {
  stream_.reset();
  std::error_code error;
  if (!temporary_.empty()) fs::remove(temporary_, error);
}

void FileWriter::fail(const std::string& reason) const {
  throw InputError(path_, "", fmt::format("cannot be written: {}", reason));
}

void FileWriter::write(const void* bytes, std::size_t size) {
  if (size > 0 && std::fwrite(bytes, 1, size, stream_.get()) != size) fail(std::strerror(errno));
}

void FileWriter::finish() {
  if (stream_ && std::fclose(stream_.release()) != 0) fail(std::strerror(errno));
}

void FileWriter::commit() {
  finish();
  std::error_code error;
  fs::rename(temporary_, path_, error);
  if (error) fail(error.message());
  temporary_.clear();
}

void write_file(const std::string& path, std::string_view bytes) {
  FileWriter file(path);
  file.write(bytes);
  file.commit();
}

std::string find_own_file(const std::string& installed, const std::string& built) {
  const std::filesystem::path folder = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  const auto place = [&](const std::string& path) { return (folder / path).lexically_normal().string(); };
  for (const std::string& path : {place(installed), place(built)})
    if (std::filesystem::exists(path)) return path;
  throw std::runtime_error(fmt::format("{} is missing, which belongs to this program", place(installed)));
}

}  // namespace parian
