/// URIs of a glTF document and the paths that they name.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace parian {

/// The relative URI by which a file in `folder` names `path`; an absolute one where there is no way.
std::string make_uri(const std::filesystem::path& path, const std::filesystem::path& folder);

/// The URI that names from a file in `to` what `uri` named from one in `from`. Data URIs, and what is no
/// path, stay as they are, as does the text where both folders are one.
std::string move_uri(const std::string& uri, const std::filesystem::path& from,
                     const std::filesystem::path& to);

}  // namespace parian
