#pragma once

#include <exception>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "runner/engine/schedule.h"

namespace terrazzo {

/// What a program that started a run wants to know of it afterwards: `run --summary FILE.json`. The members of the file
/// are described in examples/guide/automation.md and, for programs, in examples/guide/summary.schema.json.
struct RunSummary {
  std::filesystem::path graph;
  const Plan* plan = nullptr;         ///< null if there was none: the graph is invalid
  const RunResult* result = nullptr;  ///< null if nothing ran
  Cache* cache = nullptr;
  std::vector<std::string> warnings{};              ///< that are not about a node
  std::map<std::string, std::string> variations{};  ///< of a sweep or table: the one that a node is made for, by name
  const std::exception* error = nullptr;            ///< why there was no run, or why its results could not be written
  int exit_code = 0;
};

/// Stands near the beginning of every such file.
inline constexpr std::string_view summary_mark = "\"program\": \"terrazzo ";

/// Where a summary and the times in it come from. Throws FileError.
void write_run_summary(const RunSummary& summary, const std::filesystem::path& path);

}  // namespace terrazzo
