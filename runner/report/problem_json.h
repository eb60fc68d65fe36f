#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include "graphs/text/json.h"
#include "graphs/text/problem.h"

namespace terrazzo {

/// Problems of a graph as JSON, with pointers into the files they are in. Not thread-safe.
class ProblemsAsJson {
 public:
  /// `graph`: the file whose problems these are; it is read when one needs a pointer.
  explicit ProblemsAsJson(std::string graph) : graph_(std::move(graph)) {}
  /// For a document in memory, which may be nullopt if it is not JSON.
  ProblemsAsJson(std::string graph, std::optional<JsonValue> document) : graph_(std::move(graph)) {
    documents_.emplace(graph_, std::move(document));
  }

  /// {"severity", "code", "file", "line"?, "column"?, "pointer"?, "node"?, "message"}
  nlohmann::ordered_json entry(const Problem& problem, std::string_view severity);

 private:
  std::string pointer(const std::string& file, Place place);

  std::string graph_;
  std::map<std::string, std::optional<JsonValue>> documents_;
};

}  // namespace terrazzo
