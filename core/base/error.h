#pragma once

#include <exception>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace terrazzo {

/// An error that a user can fix: a wrong value, an unreadable file, inputs that do not fit together. The message says
/// what was expected and what was found. `about` names the responsible port or parameter, if any, or a part of one
/// ("weights.height", "maps.0"). The runner adds the graph file and the node's name.
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& message) : std::runtime_error(message) {}
  Error(std::string about, const std::string& message) : std::runtime_error(message), about_(std::move(about)) {}
  const std::string& about() const { return about_; }

 private:
  std::string about_;
};

/// Several errors at once. Handlers that catch Error see only the first one.
class Errors : public Error {
 public:
  explicit Errors(std::vector<Error> all) : Error(all.front()), all_(std::move(all)) {}
  const std::vector<Error>& all() const { return all_; }

 private:
  std::vector<Error> all_;
};

/// Calls all checks, even if some throw, then throws Errors with everything that was thrown.
template <typename... Checks>
void check_all(const Checks&... checks) {
  std::vector<Error> found;
  const auto call = [&found](const auto& check) {
    try {
      check();
    } catch (const Errors& e) {
      found.insert(found.end(), e.all().begin(), e.all().end());
    } catch (const Error& e) {
      found.push_back(e);
    }
  };
  (call(checks), ...);
  if (!found.empty()) throw Errors(std::move(found));
}

/// Thrown by Task::check() once the run has been cancelled; never caught by nodes.
class Cancelled : public std::exception {
 public:
  const char* what() const noexcept override { return "cancelled"; }
};

}  // namespace terrazzo
