/// Render state on disk, to go on after an interruption with a bit-identical result.
#pragma once

#include <string>

#include "renderer/film/film.h"

namespace parian {

/// Writes the film and `key`, which says what it is a render of. Whole or not at all. Throws InputError.
void write_checkpoint(const std::string& path, const std::string& key, const Film& film);

/// Restores the film. Throws InputError where the file is broken, or of another render than `key` says.
void read_checkpoint(const std::string& path, const std::string& key, Film& film);

}  // namespace parian
