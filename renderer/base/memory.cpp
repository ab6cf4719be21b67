#include "renderer/base/memory.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <limits>
#include <new>
#include <stdexcept>
#include <string>

namespace parian {
namespace {

const std::size_t kPage = std::size_t(sysconf(_SC_PAGESIZE));

// A number of bytes in a file of its own; the largest number where there is none ("max", or no such file).
std::size_t read_bytes(const std::string& path) {
  std::size_t value;
  return std::ifstream(path) >> value ? value : std::numeric_limits<std::size_t>::max();
}

// A line of /proc/meminfo, in bytes.
std::size_t read_meminfo(std::string_view key) {
  std::ifstream file("/proc/meminfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with(key)) return std::stoull(line.substr(key.size() + 1)) * 1024;
  return std::numeric_limits<std::size_t>::max();
}

// Where the control groups of memory are, and what the two versions call their files (Linux,
// admin-guide/cgroup-v2 and cgroup-v1/memory). "inactive" is what files were read into and nobody reads now,
// which is given back before anything fails.
struct GroupFiles {
  std::string root, most, now, inactive;
};
const GroupFiles kVersion2{"/sys/fs/cgroup", "memory.max", "memory.current", "inactive_file"};
const GroupFiles kVersion1{"/sys/fs/cgroup/memory", "memory.limit_in_bytes", "memory.usage_in_bytes",
                           "total_inactive_file"};

std::size_t free_in_group(const std::string& folder, const GroupFiles& files) {
  constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  const std::size_t most = read_bytes(folder + files.most), now = read_bytes(folder + files.now);
  if (most == kNone || now == kNone) return kNone;
  std::size_t inactive = 0;
  std::ifstream file(folder + "memory.stat");
  std::string key;
  for (std::size_t value; file >> key >> value;)
    if (key == files.inactive) inactive = value;
  return most - std::min(most, now - std::min(now, inactive));
}

// What the control group of the process, and those around it, leave free. A line of /proc/self/cgroup is
// number:controllers:/path, the number 0 and no controllers in version 2.
std::size_t free_in_groups() {
  std::size_t least = std::numeric_limits<std::size_t>::max();
  std::ifstream file("/proc/self/cgroup");
  for (std::string line; std::getline(file, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = fmt::format(",{},", line.substr(first + 1, second - first - 1));
    const bool is_version2 = line.starts_with("0::");
    if (!is_version2 && controllers.find(",memory,") == std::string::npos) continue;
    const GroupFiles& files = is_version2 ? kVersion2 : kVersion1;
    for (std::string path = line.substr(second + 1); path.starts_with('/'); path.erase(path.rfind('/')))
      least = std::min(least, free_in_group(files.root + path + "/", files));
    least =
        std::min(least, free_in_group(files.root + "/", files));  // in a container the path may lead astray
  }
  return least;
}

std::atomic<std::size_t> limit{0};  // 0: not yet known

// Asking the system takes some microseconds; below this size nobody needs to.
constexpr std::size_t kSmall = std::size_t(1) << 20;

}  // namespace

std::size_t resident_memory() {
  std::ifstream file("/proc/self/statm");
  std::size_t total = 0, resident = 0;
  file >> total >> resident;
  return resident * kPage;
}

std::size_t peak_memory() {
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return std::size_t(usage.ru_maxrss) * 1024;
}

std::size_t available_memory() {
  const std::size_t free = std::min(read_meminfo("MemAvailable:"), free_in_groups());
  const std::size_t resident = resident_memory();
  return free > std::numeric_limits<std::size_t>::max() - resident ? free : free + resident;
}

void set_memory_limit(std::size_t bytes) { limit = bytes; }

std::size_t memory_limit() {
  if (limit == 0) limit = available_memory();
  return limit;
}

void require_memory(std::size_t bytes, std::string_view what) {
  if (bytes < kSmall) return;
  const std::size_t resident = resident_memory(), most = memory_limit();
  if (resident < most && bytes <= most - resident) return;
  throw std::runtime_error(fmt::format("not enough memory: {} needs {}, {} of {} are in use", what,
                                       format_bytes(double(bytes)), format_bytes(double(resident)),
                                       format_bytes(double(most))));
}

std::string format_bytes(double bytes) {
  const char* units[] = {"B", "kB", "MB", "GB", "TB"};
  int unit = 0;
  for (; bytes >= 1000 && unit < 4; ++unit) bytes /= 1000;
  return fmt::format("{:.{}f} {}", bytes, unit == 0 || bytes >= 100 ? 0 : 1, units[unit]);
}

PageBuffer::PageBuffer(std::size_t size)
    : data_(nullptr), size_(size), mapped_((size + kArrayPadding + kPage - 1) / kPage * kPage) {
  if (mapped_ < size) throw std::bad_alloc();
  void* const pages =
      mmap(nullptr, mapped_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (pages == MAP_FAILED) throw std::bad_alloc();
  data_ = static_cast<std::byte*>(pages);
  madvise(data_, mapped_, MADV_HUGEPAGE);  // as few page faults as can be; where it is refused, more
}

PageBuffer::~PageBuffer() { munmap(data_, mapped_); }

void PageBuffer::release_all_but(std::vector<std::span<const std::byte>> parts) {
  std::ranges::sort(parts, {}, [](const auto& part) { return part.data(); });
  std::size_t from = 0;  // whole pages before this are dealt with
  const auto release_up_to = [&](std::size_t end) {
    if (end > from) madvise(data_ + from, end - from, MADV_DONTNEED);
  };
  for (const auto& part : parts) {
    const auto begin = std::size_t(part.data() - data_), end = begin + part.size() + kArrayPadding;
    release_up_to(begin / kPage * kPage);
    from = std::max(from, std::min(mapped_, (end + kPage - 1) / kPage * kPage));
  }
  release_up_to(mapped_);
}

}  // namespace parian
