#pragma once

#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/image/image.h"

namespace terrazzo {

/// Pixels could not be computed. They are computed when somebody asks for them, so whoever sees this error need not be
/// the one who made the image.
class PixelError : public Error {
 public:
  PixelError(std::string maker, const std::string& message) : Error(message), maker_(std::move(maker)) {}
  const std::string& maker() const { return maker_; }

 private:
  std::string maker_;
};

/// Who makes the images that this thread makes, for as long as the object lives: what their operations throw becomes a
/// PixelError of this maker.
class PixelMaker {
 public:
  explicit PixelMaker(std::string name) : name_(std::move(name)), before_(std::exchange(current_, this)) {}
  ~PixelMaker() { current_ = before_; }
  PixelMaker(const PixelMaker&) = delete;
  PixelMaker& operator=(const PixelMaker&) = delete;

  /// Empty if nobody has said.
  static std::string name();

 private:
  static inline thread_local PixelMaker* current_ = nullptr;
  std::string name_;
  PixelMaker* before_;
};

/// The operation, throwing PixelError for the current maker; as it is if there is none.
Operation blaming_maker(Operation operation);

}  // namespace terrazzo
