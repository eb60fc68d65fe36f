#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "core/node/node.h"
#include "graphs/expression/expression_error.h"
#include "graphs/expression/expression_value.h"

/// Expressions in the parameters of graphs: "=size.x / 2". The language has no loops, definitions or side effects; see
/// examples/guide/graph-files.md. Thread-safe.
namespace terrazzo {

/// Resolves the names in an expression. An Error thrown by a member becomes an ExpressionError at the name.
class ExpressionScope {
 public:
  virtual ~ExpressionScope() = default;
  /// A parameter of the graph.
  virtual ExpressionValue parameter(const std::string& name) = 0;
  /// The forecast of a node's results.
  virtual const Forecast& forecast(const std::string& node) = 0;
};

namespace expression {
struct Node;
}

/// A parsed expression.
class Expression {
 public:
  /// `text` without the leading "=". Throws ExpressionError.
  explicit Expression(std::string_view text);
  ~Expression();
  Expression(Expression&&) noexcept;
  Expression& operator=(Expression&&) noexcept;

  /// The parameters that it names and the nodes whose forecasts it queries, each with its first offset.
  const std::map<std::string, size_t>& parameters() const { return parameters_; }
  const std::map<std::string, size_t>& nodes() const { return nodes_; }

  /// Throws ExpressionError. Integer arithmetic is exact; overflow of 64 bits is an error.
  ExpressionValue evaluate(ExpressionScope& scope) const;

 private:
  std::map<std::string, size_t> parameters_, nodes_;
  std::unique_ptr<const expression::Node> root_;  // parsed into the names above
};

/// Whether a text in a document is an expression: it begins with a single "=". "==" escapes a text that begins with
/// "=".
bool is_expression(std::string_view text);

}  // namespace terrazzo
