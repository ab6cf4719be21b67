/// Whole files: read at once, and written so that they appear whole or not at all.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace parian {

/// The bytes of a file. Throws InputError.
std::vector<char> read_file(const std::string& path);

/// The bytes become the file at `path`, or `path` stays as it was: they go to a temporary file beside it,
/// which is then renamed. Throws InputError, also where `path` is there and is no regular file.
void write_file(const std::string& path, std::string_view bytes);

/// A file that belongs to this program: at `installed` or `built`, relative to the folder of the executable;
/// in this order, normalised. Throws std::runtime_error where it is at neither.
std::string find_own_file(const std::string& installed, const std::string& built);

}  // namespace parian
