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

/// A graph's parameters, declared in the document's section `parameters`.
namespace terrazzo {

/// An expression as the value of a graph's parameter.
struct Formula {
  std::shared_ptr<const Expression> expression;
  JsonValue text;                ///< as in the document or on the command line
  std::filesystem::path base;    ///< relative paths start here
  std::optional<Override> by{};  ///< empty if it is from the document

  /// `where` and `parameter` are for formulas of the document.
  Diagnostics diagnostics(std::vector<Problem>& problems, const std::string& where, const std::string& parameter) const;
};

/// What is missing to compute a value: unset parameters of the graph, and nodes whose forecasts it queries.
struct Lacking {
  std::set<std::string> unset;
  std::set<std::string> nodes;  ///< with their paths: "walls/exemplar"
  bool wrong = false;           ///< a problem with something it depends on has been reported
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
  std::optional<JsonValue> visible_if{};  ///< an expression: whether to show it; always if empty
  std::optional<ParamValue> value;        ///< paths absolute; empty if unset, invalid, or not known yet
  std::optional<Formula> formula{};       ///< the value's expression, if it is one
  std::optional<Lacking> pending{};       ///< for a subgraph's parameter: what the value from its node still lacks
  bool overridden = false;
  bool is_wrong = false;   ///< a problem with its declaration or value has been reported
  std::string as_written;  ///< for a path, the text in the document or override
};

/// The place of a part of the expression in `text`; the offset counts from after the "=".
Place place_in(const JsonValue& text, size_t offset);
/// Parses the expression in a text that begins with "=". Nullopt after a problem. Does not check names; GraphScope
/// does.
std::optional<Expression> parse_expression(const JsonValue& text, Diagnostics& diagnostics);
std::optional<Formula> formula_of(const JsonValue& text, const std::filesystem::path& base, std::optional<Override> by,
                                  Diagnostics& diagnostics);

/// The names of parameter types in documents, in the order of ParamType.
const std::vector<std::string>& parameter_type_names();

/// Parameter names begin with a letter and consist of letters, digits and "_". Node names may also contain "-" and may
/// begin with any of these.
bool is_parameter_name(const std::string& name);
bool is_node_name(const std::string& name);

/// Reads the section `parameters`. Relative paths in defaults start at `folder`, which is absolute.
std::vector<GraphParameter> read_parameters(const JsonValue& section, const std::filesystem::path& folder,
                                            std::vector<Problem>& problems);

/// The nodes of a graph by name, in the document's order; the type is null if unknown.
using NodeTypes = std::vector<std::pair<std::string, const NodeType*>>;

/// Applies overrides of graph parameters; the last one for a parameter wins. `nodes`: for suggestions.
void set_parameters(std::vector<GraphParameter>& parameters, const std::vector<Override>& overrides,
                    const NodeTypes& nodes, std::vector<Problem>& problems);

/// The values of all parameters that have one.
std::vector<GraphSetting> settings_of(const std::vector<GraphParameter>& parameters);

}  // namespace terrazzo
