#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <utility>

#include "core/file/file_io.h"

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

  /// Makes a folder with those above it. Returns a path that means this very folder for as long as the guard lives,
  /// whatever its name comes to lead to; without a guard it is the folder itself. Throws Error.
  static std::filesystem::path made_folder(const std::filesystem::path& folder);

 private:
  static inline thread_local WriteGuard* current_ = nullptr;

  std::filesystem::path hold(const std::filesystem::path& folder);

  Check check_;
  WriteGuard* before_;
  std::map<std::filesystem::path, File> held_;
};

}  // namespace terrazzo
