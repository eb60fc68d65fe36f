#pragma once

#include <exception>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "runner/engine/schedule.h"

namespace terrazzo {

/// The machine-readable summary of a run: `run --summary FILE.json`. The file's members are described in
/// examples/guide/automation.md and, for programs, in examples/guide/summary.schema.json.
struct RunSummary {
  std::filesystem::path graph;
  const Plan* plan = nullptr;         ///< null if the graph is invalid
  const RunResult* result = nullptr;  ///< null if nothing ran
  Cache* cache = nullptr;
  std::vector<std::string> warnings{};              ///< warnings that are not about a node
  std::map<std::string, std::string> variations{};  ///< for a sweep or table: the variation of each node, by name
  const std::exception* error = nullptr;            ///< why nothing ran, or why results could not be written
  int exit_code = 0;
};

/// Identifies a summary; near the beginning of the file.
inline constexpr std::string_view summary_mark = "\"program\": \"terrazzo ";

/// Writes the summary. Throws FileError.
void write_run_summary(const RunSummary& summary, const std::filesystem::path& path);

}  // namespace terrazzo
