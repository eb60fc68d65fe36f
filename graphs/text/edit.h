#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "graphs/text/json.h"

namespace terrazzo {

/// Sets the value at `path` in the text of a document. `path` lists member names from the outside in. All other bytes,
/// including comments, stay. New members are appended to their object, in the style of its other members. Throws Error
/// if the text is no JSON, or if a parent on the path is no object.
std::string with_value(const std::string& text, const std::vector<std::string>& path, const JsonValue& value);

}  // namespace terrazzo
