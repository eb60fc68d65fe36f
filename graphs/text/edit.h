#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "graphs/text/json.h"

namespace terrazzo {

/// The text of a document with a value at `path`, the names of members from the outside in. All other bytes, comments
/// too, stay as they are; what is not there yet comes last in its object, in the style of its neighbours. Throws Error
/// if the text is no JSON or something on the path is no object.
std::string with_value(const std::string& text, const std::vector<std::string>& path, const JsonValue& value);

}  // namespace terrazzo
