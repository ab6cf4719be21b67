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

void write_file(const std::string& path, std::string_view bytes) {
  static std::atomic<int> serial{0};
  std::error_code error;
  if (fs::exists(path, error) && !fs::is_regular_file(path, error))
    throw InputError(path, "", "cannot be written: it is not a file");
  const std::string temporary = fmt::format("{}.{}-{}.tmp", path, ::getpid(), serial++);
  errno = 0;
  std::ofstream file(temporary, std::ios::binary);
  file.write(bytes.data(), std::streamsize(bytes.size()));
  file.close();
  std::string reason = file ? "" : std::strerror(errno);
  if (reason.empty()) {
    fs::rename(temporary, path, error);
    if (error) reason = error.message();
  }
  if (!reason.empty()) {
    fs::remove(temporary, error);
    throw InputError(path, "", fmt::format("cannot be written: {}", reason));
  }
}

std::string find_own_file(const std::string& installed, const std::string& built) {
  const std::filesystem::path folder = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  const auto place = [&](const std::string& path) { return (folder / path).lexically_normal().string(); };
  for (const std::string& path : {place(installed), place(built)})
    if (std::filesystem::exists(path)) return path;
  throw std::runtime_error(fmt::format("{} is missing, which belongs to this program", place(installed)));
}

}  // namespace parian
