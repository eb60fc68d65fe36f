#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "runner/plan/key.h"

namespace terrazzo {

/// The ingredients and times of a graph file's stages at their last run: a plan names the first difference, and a run
/// starts with what takes longest. Stored beside the cache; not needed for correct results. Not thread-safe.
class History {
 public:
  /// Reads the history of `graph_file` in `folder`; empty if that fails.
  History(const std::filesystem::path& folder, const std::filesystem::path& graph_file);

  /// "parameter seed changed from 1 to 2"; empty if the node has not been seen before, or nothing differs.
  std::string first_difference(const std::string& node, const std::vector<Ingredient>& now) const;
  /// Time of the node's last computation; nullopt if unknown.
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
