#pragma once

#include <map>
#include <string>
#include <utility>

namespace terrazzo {

/// While it lives, collects the environment variables that code on this thread reports by note(). Active while
/// files_read is called, so that these variables become part of the node's key.
class VariablesRead {
 public:
  VariablesRead() : before_(std::exchange(current_, this)) {}
  ~VariablesRead() { current_ = before_; }
  VariablesRead(const VariablesRead&) = delete;
  VariablesRead& operator=(const VariablesRead&) = delete;

  static void note(const std::string& name, const std::string& value) {
    if (current_) current_->all_.insert_or_assign(name, value);
  }
  /// Values by name. Unset variables are missing.
  const std::map<std::string, std::string>& all() const { return all_; }

 private:
  static inline thread_local VariablesRead* current_ = nullptr;
  std::map<std::string, std::string> all_;
  VariablesRead* before_;
};

}  // namespace terrazzo
