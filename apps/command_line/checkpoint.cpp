#include "apps/command_line/checkpoint.h"

#include <cstdint>
#include <cstring>
#include <stdexcept>

#include "renderer/base/error.h"
#include "renderer/base/file.h"

namespace parian {
namespace {

// Layout: the mark, the length of the key, the key, a checksum of the state, the state.
constexpr char kMark[] = "parian checkpoint 2\n";
constexpr std::size_t kMarkSize = sizeof(kMark) - 1;

/// FNV-1a over 64 bits.
std::uint64_t checksum(std::string_view bytes) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : bytes) hash = (hash ^ std::uint8_t(c)) * 0x100000001b3u;
  return hash;
}

void put(std::string& out, std::uint64_t value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

}  // namespace

void write_checkpoint(const std::string& path, const std::string& key, const Film& film) {
  const std::vector<char> state = film.save();
  std::string bytes(kMark);
  put(bytes, key.size());
  bytes += key;
  put(bytes, checksum({state.data(), state.size()}));
  bytes.append(state.data(), state.size());
  write_file(path, bytes);
}

void read_checkpoint(const std::string& path, const std::string& key, Film& film) {
  const std::vector<char> bytes = read_file(path);
  std::string_view rest(bytes.data(), bytes.size());
  const auto take = [&](std::size_t size) {
    if (rest.size() < size) throw InputError(path, "", "expected a whole checkpoint, the file is cut short");
    const std::string_view head = rest.substr(0, size);
    rest.remove_prefix(size);
    return head;
  };
  const auto take_number = [&] {
    std::uint64_t value;
    std::memcpy(&value, take(sizeof(value)).data(), sizeof(value));
    return value;
  };
  if (rest.substr(0, kMarkSize) != kMark)
    throw InputError(path, "", "expected a checkpoint written by parian");
  take(kMarkSize);
  const std::string_view saved_key = take(take_number());
  if (saved_key != key)
    throw InputError(path, "",
                     fmt::format("is a checkpoint of another render: expected {}, found {}", key, saved_key));
  if (const std::uint64_t expected = take_number(); checksum(rest) != expected)
    throw InputError(path, "", "expected a whole checkpoint, its checksum is wrong");
  try {
    film.restore({rest.begin(), rest.end()});
  } catch (const std::runtime_error& error) {
    throw InputError(path, "", error.what());
  }
}

}  // namespace parian
