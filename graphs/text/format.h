#pragma once

#include <string>

#include "graphs/text/json.h"

namespace terrazzo {

/// The canonical form of a graph document: two spaces, keys in their order, `parameters` and `nodes` with one entry per
/// line where it fits, comments and single blank lines kept. Nothing is aligned, so that a changed line is a changed
/// entry.
std::string formatted(const JsonValue& document);

/// One line, without comments.
std::string compact(const JsonValue& value);

}  // namespace terrazzo
