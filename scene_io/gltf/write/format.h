/// JSON as people read it.
#pragma once

#include <nlohmann/json.hpp>

#include <string>

namespace parian {

/// Indented, with arrays of numbers and texts on one line, and a line's end behind it. Throws
/// nlohmann::json::type_error where a text is no UTF-8.
std::string format_json(const nlohmann::json& value);

}  // namespace parian
