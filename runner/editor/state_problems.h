#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "runner/editor/document.h"
#include "runner/report/problem_json.h"

namespace terrazzo {

/// The problems of an edited document, each once, with the level, node and key that they are about.
class StateProblems {
 public:
  StateProblems(const DocumentSnapshot& document, const std::optional<JsonValue>& json)
      : json_(json), file_(document.file.string()), as_json_(file_, json) {}

  /// Of each severity the first hundred.
  void add(const std::vector<Problem>& problems, const char* severity);
  nlohmann::ordered_json take() { return std::move(all_); }

 private:
  void locate(nlohmann::ordered_json& entry, const Problem& problem) const;

  const std::optional<JsonValue>& json_;
  const std::string file_;
  ProblemsAsJson as_json_;
  std::set<std::string> known_;
  nlohmann::ordered_json all_ = nlohmann::ordered_json::array();
};

}  // namespace terrazzo
