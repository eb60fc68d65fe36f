#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "graphs/values/scope.h"

/// `$name` and expressions in the nodes of a graph.
namespace terrazzo {

/// A `$name` or `${name}` in a text; it ends before offset `end`.
struct ParameterReference {
  std::string name;
  size_t end = 0;
};
/// Empty if no name follows the $ at `at`.
std::optional<ParameterReference> reference_at(const std::string& text, size_t at);

/// The parameters that a value's texts and expressions name.
std::set<std::string> parameters_in(const JsonValue& value);

/// Replaces `$name` and "=expression" in a node's values. Not thread-safe.
class Substitution {
 public:
  explicit Substitution(GraphScope& scope) : scope_(scope) {}

  /// Expands the value of a node's parameter: replaces every `$name` (or `${name}`) and expression, and unescapes `$$`
  /// and a leading `@@` or `==`. A text that is only a `$name` or an expression becomes the value itself, formatted as
  /// text if the parameter takes texts. A path at the beginning of a longer text is made absolute; elsewhere it stays
  /// as written. Nullopt after a problem, or if a value is missing.
  std::optional<JsonValue> expand(const JsonValue& value, const Param& param, Diagnostics& diagnostics);

  bool is_path(const std::string& parameter) const { return scope_.is_path(parameter); }

  /// The unset parameters and queried nodes that expand has met since the last call.
  Lacking take_lacking() { return std::exchange(lacking_, {}); }

  /// All parameters that expand has met.
  const std::set<std::string>& used() const { return used_; }

 private:
  std::optional<JsonValue> expand_part(const JsonValue& value, const Param& param, Diagnostics& diagnostics);
  std::optional<JsonValue> expand_text(const JsonValue& value, const Param& param, Diagnostics& diagnostics);
  std::optional<JsonValue> expand_expression(const JsonValue& value, const Param& param, Diagnostics& diagnostics);
  bool has_all(const Lacking& lacking);
  bool has_room(const ParamValue& value, Place place, Diagnostics& diagnostics);

  GraphScope& scope_;
  std::set<std::string> used_;
  Lacking lacking_;
  size_t put_in_ = 0;  ///< bytes inserted into the current value
  size_t hints_ = 0;   ///< suggestions made for unknown parameters
};

}  // namespace terrazzo
