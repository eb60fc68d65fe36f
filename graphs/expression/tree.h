#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/node/node.h"
#include "graphs/expression/expression_error.h"

namespace terrazzo::expression {

/// A node of the parsed expression.
struct Node {
  enum class Kind : uint8_t {
    constant,   ///< `value`
    parameter,  ///< `name`
    fact,  ///< a forecast of the graph's node `name`: `member` is "size", "count" or "maps"; of the map `detail` if not
           ///< empty
    member,  ///< `member` of the first part: x, y, or a name in a map
    list,    ///< of all parts
    call,    ///< of the function `name` with all parts
    unary,   ///< `name` is - or !
    binary,  ///< `name` is the operator
    choice,  ///< condition ? second : third
  };
  Kind kind = Kind::constant;
  size_t offset = 0;  ///< in the text
  ParamValue value = false;
  std::string name{}, member{}, detail{};
  std::vector<std::unique_ptr<const Node>> parts{};
};
using NodePtr = std::unique_ptr<const Node>;

/// Throws ExpressionError. Adds the parameters and nodes that the expression refers to, with their first offsets.
NodePtr parse(std::string_view text, std::map<std::string, size_t>& parameters, std::map<std::string, size_t>& nodes);

}  // namespace terrazzo::expression
