#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "graphs/document/scope.h"

/// `$name` and expressions in the nodes of a graph.
namespace terrazzo {

/// A `$name` or `${name}` in a text, which ends before `end`.
struct ParameterReference {
  std::string name;
  size_t end = 0;
};
/// Empty if no name follows the $ at `at`.
std::optional<ParameterReference> reference_at(const std::string& text, size_t at);

/// Puts values where a node says `$name` or "=expression".
class Substitution {
 public:
  explicit Substitution(GraphScope& scope) : scope_(scope) {}

  /// The value for a node's parameter, with every `$name` (or `${name}`) and expression replaced, `$$` and a leading
  /// `@@` or `==` made plain. A text that is nothing but a `$name` or an expression becomes the value, or the value as
  /// text if the parameter takes texts. A path that begins a longer text is absolute; further on it stands as it was
  /// written. Empty after a problem, or if something is lacking.
  std::optional<JsonValue> expand(const JsonValue& value, const Param& param, Diagnostics& diagnostics);

  /// The parameters of type path among those that a text refers to.
  std::set<std::string> paths_in(const JsonValue& value);

  /// The parameters without a value, and the nodes whose forecasts are asked for, that expand has met since this was
  /// last asked.
  Lacking take_lacking() { return std::exchange(lacking_, {}); }

  /// Parameters that neither a call of expand nor another parameter has met.
  std::vector<std::string> unused() const;

 private:
  std::optional<JsonValue> expand_part(const JsonValue& value, const Param& param, Diagnostics& diagnostics);
  std::optional<JsonValue> expand_text(const JsonValue& value, const Param& param, Diagnostics& diagnostics);
  std::optional<JsonValue> expand_expression(const JsonValue& value, const Param& param, Diagnostics& diagnostics);
  bool has_all(const Lacking& lacking);

  GraphScope& scope_;
  std::set<std::string> used_;
  Lacking lacking_;
};

}  // namespace terrazzo
