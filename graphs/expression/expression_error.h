#pragma once

#include <cstddef>
#include <string>

#include "core/base/error.h"

namespace terrazzo {

/// What is wrong with an expression, and where.
class ExpressionError : public Error {
 public:
  ExpressionError(size_t offset, const std::string& message) : Error(message), offset_(offset) {}
  /// Bytes from the beginning of the text that Expression was given.
  size_t offset() const { return offset_; }

 private:
  size_t offset_;
};

}  // namespace terrazzo
