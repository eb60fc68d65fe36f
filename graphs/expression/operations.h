#pragma once

#include <functional>
#include <string>
#include <vector>

#include "graphs/expression/expression_value.h"

/// What operators and functions do with values. All throw Error without a place; who calls them knows it.
///
/// Numbers are whole (64 bits, exact) or not; true division gives a whole number where it can. Sizes and lists of
/// numbers are worked on element by element, a single number with each. Units of sums and comparisons must agree; a
/// number without a unit goes with any.
namespace terrazzo::expression {

ExpressionValue negated(const ExpressionValue& v);
ExpressionValue operated(const std::string& op, const ExpressionValue& a, const ExpressionValue& b);
ExpressionValue listed_values(const std::vector<ExpressionValue>& parts);
ExpressionValue member_of(const ExpressionValue& v, const std::string& name);
bool truth(const ExpressionValue& v, const std::string& of_what);

ExpressionValue called(const std::string& function, const std::vector<ExpressionValue>& arguments);
/// What is wrong with the name, with a suggestion; empty if there is such a function.
std::string unknown_function(const std::string& name);

/// Texts and lists may become this long: a few that are made from one another can stand for more than any memory.
inline constexpr size_t most_text_bytes = size_t{1} << 20;
/// What a value takes in memory, roughly.
size_t bytes_of(const ParamValue& value);

/// What a value is, for messages: "the number 3", "a size".
std::string described(const ExpressionValue& v);

/// The unit of a parameter or value as expressions compare it: its first word; none where it names several.
std::string plain_unit(const std::string& unit);

}  // namespace terrazzo::expression
