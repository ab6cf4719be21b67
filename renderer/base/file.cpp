#include "renderer/base/file.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "renderer/base/error.h"

namespace parian {

std::vector<char> read_file(const std::string& path) {
  std::error_code code;
  if (std::filesystem::is_directory(path, code)) throw InputError(path, "", "expected a file, found a folder");
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) throw InputError(path, "", "cannot be read: no such file, or no permission");
  std::vector<char> bytes(std::size_t(std::max<std::streamoff>(0, file.tellg())));
  file.seekg(0);
  if (!file.read(bytes.data(), std::streamsize(bytes.size()))) throw InputError(path, "", "cannot be read");
  return bytes;
}

void write_whole(const std::string& path, const std::function<void(const std::string&)>& write) {
  const std::filesystem::path target(path);
  // The extension stays last: image writers choose the format by it.
  std::filesystem::path temporary = target;
  temporary.replace_filename(fmt::format(".{}.{}.tmp{}", target.stem().string(), getpid(), target.extension().string()));
  std::error_code code;
  try {
    write(temporary.string());
  } catch (...) {
    std::filesystem::remove(temporary, code);
    throw;
  }
  std::filesystem::rename(temporary, target, code);
  if (code) {
    const std::string reason = code.message();
    std::filesystem::remove(temporary, code);
    throw InputError(path, "", fmt::format("cannot be written: {}", reason));
  }
}

void write_file(const std::string& path, std::string_view bytes) {
  write_whole(path, [&](const std::string& temporary) {
    std::ofstream file(temporary, std::ios::binary);
    file.write(bytes.data(), std::streamsize(bytes.size()));
    file.close();
    if (!file) throw InputError(path, "", "cannot be written");
  });
}

}  // namespace parian
