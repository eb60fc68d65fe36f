#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/node/node.h"
#include "graphs/document/diagnostics.h"
#include "graphs/document/json.h"
#include "graphs/document/override.h"

/// A graph's parameters: the section of the document that declares them, and `$name` in its nodes.
namespace terrazzo {

/// A parameter of a graph: declared like a node's.
struct GraphParameter {
  Param param;
  Place place;
  std::optional<ParamValue> value;  ///< paths absolute; empty if not set, or invalid
  bool overridden = false;
  bool is_wrong = false;   ///< a problem with its declaration or value has been reported
  std::string as_written;  ///< of a path, what the document or the override said
};

/// The names that a document gives the types of parameters, in the order of ParamType.
const std::vector<std::string>& parameter_type_names();

/// Parameters begin with a letter and consist of letters, digits and _; nodes may have - as well and begin with any.
bool is_parameter_name(const std::string& name);
bool is_node_name(const std::string& name);

/// Reads the section `parameters`. Relative paths in defaults lie in `folder`, which is absolute.
std::vector<GraphParameter> read_parameters(const JsonValue& section, const std::filesystem::path& folder,
                                            std::vector<Problem>& problems);

/// The nodes of a graph by name, in its order; the type is null if it is unknown.
using NodeTypes = std::vector<std::pair<std::string, const NodeType*>>;

/// Sets what the overrides without a node say. Relative paths lie in `folder`, which is absolute. `nodes` are for
/// hints.
void set_parameters(std::vector<GraphParameter>& parameters, const std::vector<Override>& overrides,
                    const std::filesystem::path& folder, const NodeTypes& nodes, std::vector<Problem>& problems);

/// Puts the parameters' values where a node says `$name`.
class Substitution {
 public:
  explicit Substitution(const std::vector<GraphParameter>& parameters);

  /// The value with every `$name` (or `${name}`) replaced, `$$` and a leading `@@` made plain. A text that is nothing
  /// but a `$name` becomes the parameter's value, or that value as text if `wants_text`. A path that begins a longer
  /// text is absolute; further on it stands as it was written. Empty after a problem, or if a parameter has no value.
  std::optional<JsonValue> expand(const JsonValue& value, bool wants_text, Diagnostics& diagnostics);

  /// The parameters of type path among those that a text refers to.
  std::set<std::string> paths_in(const JsonValue& value) const;

  /// The parameters without a value that expand has met since the last call.
  std::set<std::string> take_unset() { return std::exchange(unset_, {}); }

  /// Parameters that expand has never met.
  std::vector<const GraphParameter*> unused() const;

 private:
  struct Use {
    const GraphParameter* parameter;
    bool used = false;
  };
  std::optional<JsonValue> expand_part(const JsonValue& value, bool wants_text, Diagnostics& diagnostics);
  std::optional<JsonValue> expand_text(const JsonValue& value, bool wants_text, Diagnostics& diagnostics);
  const GraphParameter* find(const std::string& name, Place place, Diagnostics& diagnostics);
  std::map<std::string, Use> uses_;
  std::vector<std::string> names_;
  std::set<std::string> unset_;
};

}  // namespace terrazzo
