#include "graphs/expression/expression.h"

#include <fmt/format.h>

#include "core/base/suggest.h"
#include "graphs/expression/operations.h"
#include "graphs/expression/tree.h"

namespace terrazzo {

namespace expression {

namespace {

/// The size of one map, or of the largest map of a material.
ExpressionValue size_in(const Forecast& forecast, const Node& fact) {
  std::map<std::string, Size> sizes;
  for (const auto& [map, facts] : forecast.images)
    if (facts.size) sizes[map] = *facts.size;
  if (sizes.empty() && forecast.size) sizes[""] = *forecast.size;
  if (sizes.empty())
    throw Error(fmt::format("the size of the result of \"{}\" is not known before it runs", fact.name));
  if (!fact.detail.empty()) {
    const auto at = sizes.find(fact.detail);
    std::vector<std::string> maps;
    for (const auto& [map, size] : sizes) maps.push_back(map);
    if (at == sizes.end())
      throw Error(fmt::format("\"{}\" gives no map \"{}\" whose size is known{}", fact.name, fact.detail,
                              suggestion(fact.detail, maps)));
    return {at->second, "pixels"};
  }
  Size largest = sizes.begin()->second;
  for (const auto& [map, size] : sizes)
    if (size.area() > largest.area()) largest = size;
  return {largest, "pixels"};
}

ExpressionValue fact_of(const Forecast& forecast, const Node& fact) {
  if (fact.member == "size") return size_in(forecast, fact);
  if (forecast.maps.empty() || (forecast.possible_maps && !forecast.possible_maps->empty()))
    throw Error(fmt::format("the maps of \"{}\" are not known before it runs", fact.name));
  if (fact.member == "count") return {int64_t(forecast.maps.size())};
  return {Texts(forecast.maps)};
}

class Evaluation {
 public:
  explicit Evaluation(ExpressionScope& scope) : scope_(scope) {}

  ExpressionValue of(const Node& node) {
    try {
      return value_of(node);
    } catch (const ExpressionError&) {
      throw;
    } catch (const Error& e) {
      throw ExpressionError(node.offset, e.what());
    }
  }

 private:
  ExpressionValue value_of(const Node& node) {
    switch (node.kind) {
      case Node::Kind::constant:
        return {node.value};
      case Node::Kind::parameter:
        return scope_.parameter(node.name);
      case Node::Kind::fact:
        return fact_of(scope_.forecast(node.name), node);
      case Node::Kind::member:
        return member_of(of(*node.parts[0]), node.member);
      case Node::Kind::list:
        return listed_values(all(node));
      case Node::Kind::call:
        return called(node.name, all(node));
      case Node::Kind::unary:
        return node.name == "!" ? ExpressionValue{!truth(of(*node.parts[0]), "!")} : negated(of(*node.parts[0]));
      case Node::Kind::binary:
        return binary(node);
      case Node::Kind::choice:
        return of(*node.parts[truth(of(*node.parts[0]), "the condition before ?") ? 1 : 2]);
    }
    throw Error("this cannot be evaluated");
  }

  std::vector<ExpressionValue> all(const Node& node) {
    std::vector<ExpressionValue> out;
    for (const NodePtr& part : node.parts) out.push_back(of(*part));
    return out;
  }

  ExpressionValue binary(const Node& node) {
    ExpressionValue left = of(*node.parts[0]);
    if (node.name == "&&" || node.name == "||") {
      if (truth(left, node.name) == (node.name == "||")) return left;
      const ExpressionValue right = of(*node.parts[1]);
      return {truth(right, node.name)};
    }
    return operated(node.name, left, of(*node.parts[1]));
  }

  ExpressionScope& scope_;
};

}  // namespace

}  // namespace expression

Expression::Expression(std::string_view text) : root_(expression::parse(text, parameters_, nodes_)) {}
Expression::~Expression() = default;
Expression::Expression(Expression&&) noexcept = default;
Expression& Expression::operator=(Expression&&) noexcept = default;

ExpressionValue Expression::evaluate(ExpressionScope& scope) const {
  return expression::Evaluation(scope).of(*root_);
}

bool is_expression(std::string_view text) {
  return text.starts_with('=') && !text.starts_with("==");
}

}  // namespace terrazzo
