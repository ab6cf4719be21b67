/// Whole files: read at once, and written so that they appear whole or not at all.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace parian {

/// The bytes of a file. Throws InputError.
std::vector<char> read_file(const std::string& path);

/// Calls write(temporary) with a path beside `path`, then renames it to `path`. Where write throws, the temporary is
/// removed and `path` stays as it was. Throws InputError where the rename fails.
void write_whole(const std::string& path, const std::function<void(const std::string&)>& write);

/// Writes bytes as a whole file. Throws InputError.
void write_file(const std::string& path, std::string_view bytes);

}  // namespace parian
