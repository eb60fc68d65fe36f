#pragma once

#include <atomic>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "graphs/library/library.h"
#include "runner/engine/schedule.h"

namespace terrazzo {

/// What `library add` is asked for.
struct LibraryAddition {
  std::string source;            ///< a folder of maps, or an analysis that exists
  std::string material;          ///< of an analysis that exists: the folder of its maps; may be empty
  std::vector<std::string> set;  ///< for the analysis of a folder
  bool other_material = false;   ///< the maps need not look like those that were analysed
};

/// Analyses a folder, or takes an analysis, and paints the exemplar: an entry without a name, whose files lie in
/// `place`. Not set if the run failed, or was cancelled; `result` says how. Throws GraphError, UsageError or Error.
std::optional<LibraryEntry> made_entry(const LibraryAddition& asked, const std::filesystem::path& place,
                                       const std::atomic<bool>& cancelled, RunResult& result);

}  // namespace terrazzo
