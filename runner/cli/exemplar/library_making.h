#pragma once

#include <atomic>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "graphs/library/library.h"
#include "runner/engine/schedule.h"

namespace terrazzo {

/// The options of `library add`.
struct LibraryAddition {
  std::string source;            ///< a folder of maps, a picture, or an existing analysis
  std::string material;          ///< the folder of an existing analysis's maps; may be empty
  std::vector<std::string> set;  ///< for the analysis of a folder
  bool other_material = false;   ///< the maps may differ from the analysed ones
};

/// Analyses a folder or a picture, or takes an existing analysis, and makes a picture of the exemplar. Returns an entry
/// without a name, whose files are in `place`; nullopt if the run failed or was cancelled, see `result`. Throws
/// GraphError, UsageError or Error.
std::optional<LibraryEntry> made_entry(const LibraryAddition& asked, const std::filesystem::path& place,
                                       const std::atomic<bool>& cancelled, RunResult& result);

}  // namespace terrazzo
