#pragma once

#include <string>

#include "core/node/node.h"

namespace terrazzo {

/// A value and its unit ("pixels", "degrees"; empty: none, or unknown).
struct ExpressionValue {
  ParamValue value;
  std::string unit{};
};

}  // namespace terrazzo
