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

  /// The parameters that a value's texts refer to.
  std::set<std::string> names_in(const JsonValue& value) const;
  bool is_path(const std::string& parameter) const { return scope_.is_path(parameter); }

  /// The parameters without a value, and the nodes whose forecasts are asked for, that expand has met since this was
  /// last asked.
  Lacking take_lacking() { return std::exchange(lacking_, {}); }

  /// Parameters that calls of expand have met.
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
  size_t put_in_ = 0;  ///< bytes, in the value that is being expanded
  size_t hints_ = 0;   ///< given on parameters that are not there
};

}  // namespace terrazzo
