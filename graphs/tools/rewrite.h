#pragma once

#include <functional>
#include <string>

#include "graphs/text/json.h"

namespace terrazzo {

/// How to change the names in the texts of a document, see rewritten.
struct TextChange {
  /// A wire "@node.port", also in quotes in an expression; `port` may be empty. Returns the new text.
  std::function<JsonValue(const std::string& node, const std::string& port, const JsonValue& text)> wire;
  /// A node whose results an expression queries: "@node.size". Returns the new name, without @.
  std::function<std::string(const std::string& node)> fact;
  /// A parameter of the graph, as `$name` or in an expression. Returns its replacement as in a document: a value,
  /// "$other" or "=expression".
  std::function<JsonValue(const std::string& name)> parameter;
};

/// Nodes get other names: `now` returns them; parameters keep theirs.
TextChange renaming(std::function<std::string(const std::string& node)> now);

/// Changes all names in the texts of a node's value. Throws Error if an expression cannot contain a parameter's
/// replacement.
JsonValue rewritten(const JsonValue& value, const TextChange& change);

/// The same for an entry of a section: a node, the declaration of a parameter, an output. Leaves its type and its
/// human-readable texts unchanged.
JsonValue rewritten_entry(const JsonValue& entry, const TextChange& change);

/// Formats a value for use in an expression: 'text', other, (expression). Throws Error for a map.
std::string in_expression(const JsonValue& value);

}  // namespace terrazzo
