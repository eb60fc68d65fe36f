#pragma once

#include <string>

#include "graphs/text/json.h"

namespace terrazzo {

/// The canonical form of a graph document: indented by two spaces, keys in a fixed order, one entry of `parameters` and
/// `nodes` per line where it fits, comments and single blank lines kept. Columns are not aligned, so that a change of
/// an entry changes only its own line.
std::string formatted(const JsonValue& document);

/// The value on one line, without comments.
std::string compact(const JsonValue& value);

}  // namespace terrazzo
