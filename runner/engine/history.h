#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "runner/engine/key.h"

namespace terrazzo {

/// What the stages of one graph file were made of the last time they ran, so that a plan can name the first thing that
/// differs, and how long they took, so that a run can begin with what takes longest. Kept beside the cache; losing it
/// loses nothing but the wording of reasons and a good order. Not thread-safe.
class History {
 public:
  /// Reads what `folder` has on `graph_file`; nothing if it cannot be read.
  History(const std::filesystem::path& folder, const std::filesystem::path& graph_file);

  /// "parameter seed changed from 1 to 2"; empty if the node has not been seen before, or nothing differs.
  std::string first_difference(const std::string& node, const std::vector<Ingredient>& now) const;
  /// What computing the node took the last time; nothing if that is not known.
  std::optional<double> seconds(const std::string& node) const;
  void remember(const std::string& node, const std::vector<Ingredient>& now, double seconds);
  /// Writes it back if anything has been remembered; silent if that fails.
  void save() const;

 private:
  std::filesystem::path path_;
  std::map<std::string, std::vector<Ingredient>> nodes_;
  std::map<std::string, double> seconds_;
  bool changed_ = false;
};

}  // namespace terrazzo
