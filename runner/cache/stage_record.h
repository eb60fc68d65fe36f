#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/base/hash.h"

namespace terrazzo {

/// A file that a sink wrote.
struct OutputFile {
  std::filesystem::path path;
  uint64_t bytes = 0;
  Digest content;
};

/// The cache record of a computed stage.
struct StageRecord {
  std::map<std::string, Digest> outputs;  ///< value digest by output port
  std::vector<std::string> notes;         ///< notes and warnings of the node
  std::vector<OutputFile> files;          ///< for sinks
  double seconds = 0;                     ///< time to compute
};

}  // namespace terrazzo
