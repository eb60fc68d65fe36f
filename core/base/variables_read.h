#pragma once

#include <map>
#include <string>
#include <utility>

namespace terrazzo {

/// The variables of the environment that results depend on: what code on this thread notes, for as long as the object
/// lives. Whoever asks a node for the files it reads puts these variables into the node's key too.
class VariablesRead {
 public:
  VariablesRead() : before_(std::exchange(current_, this)) {}
  ~VariablesRead() { current_ = before_; }
  VariablesRead(const VariablesRead&) = delete;
  VariablesRead& operator=(const VariablesRead&) = delete;

  static void note(const std::string& name, const std::string& value) {
    if (current_) current_->all_.insert_or_assign(name, value);
  }
  /// Values by name; variables that are not set are not among them.
  const std::map<std::string, std::string>& all() const { return all_; }

 private:
  static inline thread_local VariablesRead* current_ = nullptr;
  std::map<std::string, std::string> all_;
  VariablesRead* before_;
};

}  // namespace terrazzo
