#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <utility>

namespace terrazzo {

/// While it lives, `check` is called before this thread reads a file or lists a folder that a graph names beyond the
/// `files_read` of its nodes; it may throw. `named` is called before that for paths that come from the command line
/// instead of the graph; `by` is the command line's value, for messages.
class ReadGuard {
 public:
  using Check = std::function<void(const std::filesystem::path& path)>;

  using Named = std::function<void(const std::string& by, const std::filesystem::path& path)>;

  explicit ReadGuard(Check check, Named named = {})
      : check_(std::move(check)), named_(std::move(named)), before_(std::exchange(current_, this)) {}
  ~ReadGuard() { current_ = before_; }
  ReadGuard(const ReadGuard&) = delete;
  ReadGuard& operator=(const ReadGuard&) = delete;

  static bool is_set() { return current_ != nullptr; }
  static void check(const std::filesystem::path& path) {
    if (current_ && current_->check_) current_->check_(path);
  }
  static void name(const std::string& by, const std::filesystem::path& path) {
    if (current_ && current_->named_) current_->named_(by, path);
  }

 private:
  static inline thread_local ReadGuard* current_ = nullptr;
  Check check_;
  Named named_;
  ReadGuard* before_;
};

}  // namespace terrazzo
