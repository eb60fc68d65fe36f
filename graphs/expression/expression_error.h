#pragma once

#include <cstddef>
#include <string>

#include "core/base/error.h"

namespace terrazzo {

/// An error in an expression, with its position.
class ExpressionError : public Error {
 public:
  ExpressionError(size_t offset, const std::string& message) : Error(message), offset_(offset) {}
  /// In bytes, from the beginning of the text passed to Expression.
  size_t offset() const { return offset_; }

 private:
  size_t offset_;
};

}  // namespace terrazzo
