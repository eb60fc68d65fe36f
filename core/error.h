#pragma once

#include <exception>
#include <stdexcept>
#include <string>

namespace terrazzo {

/// Something a user can mend: a wrong value, an unreadable file, inputs that do not fit together. The message says what
/// was expected and what was found; `about` names the port or parameter, if one is to blame. Whoever runs a node adds
/// the graph file and the node's name.
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& message) : std::runtime_error(message) {}
  Error(std::string about, const std::string& message) : std::runtime_error(message), about_(std::move(about)) {}
  const std::string& about() const { return about_; }

 private:
  std::string about_;
};

/// Thrown by Task::check() once the run has been cancelled; never caught by nodes.
class Cancelled : public std::exception {
 public:
  const char* what() const noexcept override { return "cancelled"; }
};

}  // namespace terrazzo
