#include "apps/command_line/texture_memory.h"

#include "apps/command_line/sizes.h"
#include "renderer/base/error.h"

namespace parian {

void add_texture_memory(CLI::App& app, std::string& text) {
  app.add_option(
         "--texture-memory", text,
         "Memory that decoded images may take, as 800M or 4GiB; those beyond it come from a temporary "
         "file through a cache [no limit]")
      ->type_name("SIZE");
}

std::unique_ptr<ImageMemory> make_image_memory(const std::string& text) {
  if (text.empty()) return nullptr;
  const std::size_t bytes = parse_bytes("--texture-memory", text);
  if (bytes < ImageMemory::kLeast)
    throw UsageError(fmt::format("--texture-memory {}: expected at least 16MiB", text));
  return std::make_unique<ImageMemory>(bytes);
}

}  // namespace parian
