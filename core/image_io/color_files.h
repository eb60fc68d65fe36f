#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/image_io/image_libraries.h"

namespace terrazzo {

/// The files and variables that a colour configuration depends on, besides its own text.
struct ColorFiles {
  std::vector<std::filesystem::path> files;      ///< existing files, in the order in which they were found
  std::map<std::string, std::string> variables;  ///< of the environment, by name
};

/// Finds the files that a configuration names, by OpenColorIO's search rules, and those that CLF and CTF files
/// reference in turn. Opens only regular files that ReadGuard allows. Throws Error for a file whose references it
/// cannot parse.
ColorFiles find_color_files(const ColorConfiguration& config);

}  // namespace terrazzo
