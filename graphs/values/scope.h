#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "graphs/expression/expression.h"
#include "graphs/text/diagnostics.h"
#include "graphs/values/parameters.h"

namespace terrazzo {

/// The scope of a graph's expressions: its parameters. Parameters that are expressions themselves are evaluated on
/// first use; their problems are reported once. Not thread-safe.
class GraphScope : public ExpressionScope {
 public:
  /// Returns a node's forecast, given its path; throws Error if there is none.
  using Forecasts = std::function<const Forecast&(const std::string& node)>;

  /// Parameters and problems must outlive the scope. `path`: prefix of its nodes' names ("walls/").
  GraphScope(std::vector<GraphParameter>& parameters, const NodeTypes& nodes, const std::string& path,
             std::vector<Problem>& problems);

  /// The scope of a loop's iteration: its variables, which have values, hide names of the enclosing scope, which must
  /// outlive it.
  GraphScope(std::vector<GraphParameter>& variables, GraphScope& around);

  /// Allows queries of nodes until set to null.
  void set_forecasts(Forecasts forecasts) { forecasts_ = std::move(forecasts); }

  /// Null if there is none of that name. Evaluates its value if everything it depends on is known.
  const GraphParameter* find(const std::string& name);
  /// The same without evaluating it.
  const GraphParameter* look_up(const std::string& name) const { return position(name); }
  bool is_path(const std::string& name) const {
    const GraphParameter* p = look_up(name);
    return p && p->param.type == ParamType::path;
  }
  /// What is missing to evaluate the parameter or expression.
  Lacking lacking(const std::string& parameter) const;
  Lacking lacking(const Expression& expression) const;

  /// Evaluates an expression from the text `value`, for a value with this unit (empty: any). Nullopt after a problem.
  /// Nothing may be lacking.
  std::optional<ParamValue> evaluate(const Expression& expression, const JsonValue& value, const std::string& unit,
                                     Diagnostics& diagnostics);
  /// Checks that all names in an expression exist; reports those that do not.
  bool check_names(const Expression& expression, const JsonValue& text, Diagnostics& diagnostics) const;

  /// Evaluates every parameter that queries no node.
  void evaluate_parameters();

  /// The parameters' names, in the document's order.
  std::vector<std::string> names() const;
  /// Adds the parameters that the expressions of these parameters name.
  void add_what_they_use(std::set<std::string>& parameters) const;

  ExpressionValue parameter(const std::string& name) override;
  const Forecast& forecast(const std::string& node) override;

 private:
  std::string where(const GraphParameter& parameter) const;  ///< for messages
  GraphParameter* position(const std::string& name) const;
  void collect(const std::string& parameter, std::set<std::string>& seen, Lacking& out) const;
  void collect(const Expression& expression, std::set<std::string>& seen, Lacking& out) const;
  void evaluate(GraphParameter& parameter);
  void check_formulas();
  void check_condition(GraphParameter& parameter);
  void report_cycles();

  std::vector<GraphParameter>& parameters_;
  std::vector<Problem>& problems_;
  std::vector<std::string> names_;           ///< of the parameters, in the document's order
  std::map<std::string, size_t> positions_;  ///< in parameters_
  GraphScope* around_ = nullptr;
  std::set<std::string> node_names_;  ///< in an iteration: names of the enclosing scope's nodes
  std::string path_;
  Forecasts forecasts_;
  mutable size_t hints_ = 0;  ///< suggestions made for unknown nodes
};

}  // namespace terrazzo
