#pragma once

#include <filesystem>
#include <functional>
#include <utility>

namespace terrazzo {

/// What is asked, and may throw, before this thread makes a folder or a file for a result: for as long as the object
/// lives.
class WriteGuard {
 public:
  using Check = std::function<void(const std::filesystem::path& target)>;

  explicit WriteGuard(Check check) : check_(std::move(check)), before_(std::exchange(current_, this)) {}
  ~WriteGuard() { current_ = before_; }
  WriteGuard(const WriteGuard&) = delete;
  WriteGuard& operator=(const WriteGuard&) = delete;

  static void check(const std::filesystem::path& target) {
    if (current_ && current_->check_) current_->check_(target);
  }

 private:
  static inline thread_local WriteGuard* current_ = nullptr;
  Check check_;
  WriteGuard* before_;
};

}  // namespace terrazzo
