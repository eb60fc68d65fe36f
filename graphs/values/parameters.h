#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/node/node.h"
#include "graphs/expression/expression.h"
#include "graphs/text/diagnostics.h"
#include "graphs/text/graph.h"
#include "graphs/text/json.h"
#include "graphs/values/override.h"

/// A graph's parameters: the section of the document that declares them.
namespace terrazzo {

/// An expression that a parameter of a graph is given as its value.
struct Formula {
  std::shared_ptr<const Expression> expression;
  JsonValue text;                ///< as it stands in the document, or on the command line
  std::filesystem::path base;    ///< where relative paths lie
  std::optional<Override> by{};  ///< empty if the document says it

  Diagnostics diagnostics(std::vector<Problem>& problems, const std::string& where) const;
};

/// What a value still lacks: parameters of the graph that must be set, and nodes whose forecasts it asks for.
struct Lacking {
  std::set<std::string> unset;
  std::set<std::string> nodes;  ///< with their paths: "walls/exemplar"
  bool wrong = false;           ///< something that it is made from has a problem, which has been reported
  bool nothing() const { return unset.empty() && nodes.empty() && !wrong; }
  void add(const Lacking& other) {
    unset.insert(other.unset.begin(), other.unset.end());
    nodes.insert(other.nodes.begin(), other.nodes.end());
    wrong |= other.wrong;
  }
};

/// A parameter of a graph: declared like a node's.
struct GraphParameter {
  Param param;
  Place place;
  std::string group{};                    ///< the heading it is listed under; empty: none
  std::optional<JsonValue> visible_if{};  ///< an expression, true if it matters; always if there is none
  std::optional<ParamValue> value;        ///< paths absolute; empty if not set, invalid, or not known yet
  std::optional<Formula> formula{};       ///< what the value is made from, if it is an expression
  std::optional<Lacking> pending{};       ///< of a subgraph's: what the value that its node gives still lacks
  bool overridden = false;
  bool is_wrong = false;   ///< a problem with its declaration or value has been reported
  std::string as_written;  ///< of a path, what the document or the override said
};

/// Where a part of the expression in `text` stands; the offset counts from behind the =.
Place place_in(const JsonValue& text, size_t offset);
/// The expression in a text that begins with =. Empty after a problem. Whether its names exist is for GraphScope.
std::optional<Expression> parse_expression(const JsonValue& text, Diagnostics& diagnostics);
std::optional<Formula> formula_of(const JsonValue& text, const std::filesystem::path& base, std::optional<Override> by,
                                  Diagnostics& diagnostics);

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

/// Sets what the overrides without a node say, the last of several for one parameter. `nodes` are for hints.
void set_parameters(std::vector<GraphParameter>& parameters, const std::vector<Override>& overrides,
                    const NodeTypes& nodes, std::vector<Problem>& problems);

/// The values of those that have one.
std::vector<GraphSetting> settings_of(const std::vector<GraphParameter>& parameters);

}  // namespace terrazzo
