#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "runner/plan/key.h"

namespace terrazzo {

/// The ingredients and times of a graph file's stages in their last run. Plans use it to name the first difference,
/// runs to start slow stages early. Stored beside the cache; results do not depend on it. Not thread-safe.
class History {
 public:
  /// Reads the history of `graph_file` in `folder`; empty if that fails.
  History(const std::filesystem::path& folder, const std::filesystem::path& graph_file);

  /// "parameter seed changed from 1 to 2"; empty if the node has not been seen before, or nothing differs.
  std::string first_difference(const std::string& node, const std::vector<Ingredient>& now) const;
  /// Seconds that the node's last computation took; nullopt if unknown.
  std::optional<double> seconds(const std::string& node) const;
  void remember(const std::string& node, const std::vector<Ingredient>& now, double seconds);
  /// Writes changes back; ignores errors.
  void save() const;

 private:
  std::filesystem::path path_;
  std::map<std::string, std::vector<Ingredient>> nodes_;
  std::map<std::string, double> seconds_;
  bool changed_ = false;
};

}  // namespace terrazzo
