#pragma once

#include <functional>
#include <string>

#include "graphs/text/json.h"

namespace terrazzo {

/// What becomes of the names in the texts of a document: see rewritten.
struct TextChange {
  /// A wire "@node.port", also in quotes in an expression; `port` may be empty. Gives the new text.
  std::function<JsonValue(const std::string& node, const std::string& port, const JsonValue& text)> wire;
  /// A node whose results an expression asks for: "@node.size". Gives the new name, without @.
  std::function<std::string(const std::string& node)> fact;
  /// A parameter of the graph, as `$name` or in an expression. Gives what stands there as a document would write it: a
  /// value, "$other" or "=expression".
  std::function<JsonValue(const std::string& name)> parameter;
};

/// A value of a node with all names in its texts changed. Throws Error where an expression has no way to write what a
/// parameter becomes.
JsonValue rewritten(const JsonValue& value, const TextChange& change);

/// The same for an entry of a section: a node, the declaration of a parameter, an output. What stands in it for people,
/// and its type, stay.
JsonValue rewritten_entry(const JsonValue& entry, const TextChange& change);

/// A value as it stands in an expression: 'text', other, (expression). Throws Error for a map.
std::string in_expression(const JsonValue& value);

}  // namespace terrazzo
