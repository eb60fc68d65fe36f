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

/// Where a value stands in a document.
struct ValueSite {
  int of_graph = 0;      ///< 0 is a graph, 1 its sections, 2 their entries; -1 the section `graphs`
  std::string indent{};  ///< of the line it begins on
  std::string unit = "  ";
  size_t used = 0;    ///< characters before it on its line
  size_t behind = 1;  ///< and after it
};

/// The depth of a member's or an item's value; `name` is empty for an item.
int depth_inside(int of_graph, std::string_view name);

/// The canonical form of a value within a document.
std::string formatted_at(const JsonValue& value, const ValueSite& site);

}  // namespace terrazzo
