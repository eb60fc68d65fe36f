#pragma once

#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/image/image.h"

namespace terrazzo {

/// Pixels could not be computed. Since they are computed on demand, the reader that gets this error is not necessarily
/// the node that made the image: maker() names that node.
class PixelError : public Error {
 public:
  PixelError(std::string maker, const std::string& message) : Error(message), maker_(std::move(maker)) {}
  const std::string& maker() const { return maker_; }

 private:
  std::string maker_;
};

/// While it lives, names the maker of all images created on this thread. Errors from their operations become a
/// PixelError with this name.
class PixelMaker {
 public:
  explicit PixelMaker(std::string name) : name_(std::move(name)), before_(std::exchange(current_, this)) {}
  ~PixelMaker() { current_ = before_; }
  PixelMaker(const PixelMaker&) = delete;
  PixelMaker& operator=(const PixelMaker&) = delete;

  /// The current maker; empty if there is none.
  static std::string name();

 private:
  static inline thread_local PixelMaker* current_ = nullptr;
  std::string name_;
  PixelMaker* before_;
};

/// Wraps the operation to throw PixelError for the current maker. Returns it unchanged if there is none.
Operation blaming_maker(Operation operation);

}  // namespace terrazzo
