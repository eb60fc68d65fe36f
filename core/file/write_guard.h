#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <utility>

#include "core/file/file_io.h"

namespace terrazzo {

/// While it lives, `check` is called before this thread creates a folder or a file for a result; it may throw.
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

  /// Creates a folder and its parents. Returns a path that refers to this folder while the guard lives, even if its
  /// name is later redirected by a link; without a guard returns `folder`. Throws Error.
  static std::filesystem::path made_folder(const std::filesystem::path& folder);

 private:
  static inline thread_local WriteGuard* current_ = nullptr;

  std::filesystem::path hold(const std::filesystem::path& folder);

  Check check_;
  WriteGuard* before_;
  std::map<std::filesystem::path, File> held_;
};

}  // namespace terrazzo
