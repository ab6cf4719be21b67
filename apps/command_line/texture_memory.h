/// --texture-memory.
#pragma once

#include <CLI/CLI.hpp>

#include <memory>
#include <string>

#include "images/image_memory.h"

namespace parian {

/// Adds the option; `text` is what it is given, or stays empty.
void add_texture_memory(CLI::App& app, std::string& text);

/// The cap that the option's text sets, or none. Throws UsageError.
std::unique_ptr<ImageMemory> make_image_memory(const std::string& text);

}  // namespace parian
