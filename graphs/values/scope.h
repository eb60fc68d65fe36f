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

/// The graph's parameters as expressions see them. Parameters that are expressions themselves are evaluated when they
/// are first asked for; the problems of each are reported once.
class GraphScope : public ExpressionScope {
 public:
  /// Gets the path of a node; throws Error if nothing is known of it.
  using Forecasts = std::function<const Forecast&(const std::string& node)>;

  /// Parameters and problems must outlive the scope. `path` begins the names of its nodes ("walls/").
  GraphScope(std::vector<GraphParameter>& parameters, const NodeTypes& nodes, const std::string& path,
             std::vector<Problem>& problems);

  /// The names of a round of a loop: its variables, which have values, before what is around it, which must outlive it.
  GraphScope(std::vector<GraphParameter>& variables, GraphScope& around);

  /// From now on nodes can be asked, until this is set to nothing.
  void set_forecasts(Forecasts forecasts) { forecasts_ = std::move(forecasts); }

  /// Null if there is none of that name. With its value, if all that it is made from is known by now.
  const GraphParameter* find(const std::string& name);
  /// The same, as far as it is known.
  const GraphParameter* look_up(const std::string& name) const { return position(name); }
  bool is_path(const std::string& name) const {
    const GraphParameter* p = look_up(name);
    return p && p->param.type == ParamType::path;
  }
  /// What this parameter, or the expression, lacks before it can be evaluated.
  Lacking lacking(const std::string& parameter) const;
  Lacking lacking(const Expression& expression) const;

  /// Evaluates an expression that stands in `value`, a text, for a value with this unit (empty: any). Empty after a
  /// problem; nothing may be lacking.
  std::optional<ParamValue> evaluate(const Expression& expression, const JsonValue& value, const std::string& unit,
                                     Diagnostics& diagnostics);
  /// Whether all that an expression names is there; what is not is a problem.
  bool check_names(const Expression& expression, const JsonValue& text, Diagnostics& diagnostics) const;

  /// Evaluates every parameter that asks for no node.
  void evaluate_parameters();

  /// Of the parameters, in the document's order.
  std::vector<std::string> names() const;
  /// Adds to some parameters those that their expressions name.
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
  std::set<std::string> node_names_;  ///< of a round: those around it
  std::string path_;
  Forecasts forecasts_;
  mutable size_t hints_ = 0;  ///< given on nodes that are not there
};

}  // namespace terrazzo
