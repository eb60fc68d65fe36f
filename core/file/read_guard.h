#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <utility>

namespace terrazzo {

/// While it lives, `check` is called before this thread reads a file or lists a folder that a graph names beyond the
/// `files_read` of its nodes; it may throw. `allow` is called before that for paths that the user names, instead of
/// the graph.
class ReadGuard {
 public:
  using Act = std::function<void(const std::filesystem::path& path)>;

  explicit ReadGuard(Act check, Act allow = {})
      : check_(std::move(check)), allow_(std::move(allow)), before_(std::exchange(current_, this)) {}
  ~ReadGuard() { current_ = before_; }
  ReadGuard(const ReadGuard&) = delete;
  ReadGuard& operator=(const ReadGuard&) = delete;

  static bool is_set() { return current_ != nullptr; }
  static void check(const std::filesystem::path& path) {
    if (current_ && current_->check_) current_->check_(path);
  }
  static void allow(const std::filesystem::path& path) {
    if (current_ && current_->allow_) current_->allow_(path);
  }

 private:
  static inline thread_local ReadGuard* current_ = nullptr;
  Act check_, allow_;
  ReadGuard* before_;
};

}  // namespace terrazzo
