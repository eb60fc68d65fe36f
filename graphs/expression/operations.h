#pragma once

#include <functional>
#include <string>
#include <vector>

#include "graphs/expression/expression_value.h"

/// Operators and functions on values. All throw Error without a position; callers add it.
///
/// Numbers are integers (64 bits, exact) or floating point; division gives an integer if the result is one. Operators
/// apply to sizes and lists of numbers element by element; a single number is combined with each element. Units must
/// agree in sums and comparisons; a number without a unit agrees with any.
namespace terrazzo::expression {

ExpressionValue negated(const ExpressionValue& v);
ExpressionValue operated(const std::string& op, const ExpressionValue& a, const ExpressionValue& b);
ExpressionValue listed_values(const std::vector<ExpressionValue>& parts);
ExpressionValue member_of(const ExpressionValue& v, const std::string& name);
bool truth(const ExpressionValue& v, const std::string& of_what);

ExpressionValue called(const std::string& function, const std::vector<ExpressionValue>& arguments);
/// An error message with a suggestion; empty if the function exists.
std::string unknown_function(const std::string& name);

/// The longest text or list: a few that are built from one another can grow beyond any memory.
inline constexpr size_t most_text_bytes = size_t{1} << 20;
/// The approximate size of a value in memory.
size_t bytes_of(const ParamValue& value);

/// Describes a value for messages: "the number 3", "a size".
std::string described(const ExpressionValue& v);

/// The unit that expressions compare: the first word of a parameter's unit; empty if it names several.
std::string plain_unit(const std::string& unit);

}  // namespace terrazzo::expression
