#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/image_io/image_libraries.h"

namespace terrazzo {

/// What a colour configuration depends on besides its own text.
struct ColorFiles {
  std::vector<std::filesystem::path> files;      ///< that are there, in the order in which they were found
  std::map<std::string, std::string> variables;  ///< of the environment, by name
};

/// Finds the files that a configuration names as OpenColorIO finds them, and those that CLF and CTF files name in turn.
/// Opens only regular files that ReadGuard allows. Throws Error for a file in which it cannot tell what it names.
ColorFiles find_color_files(const ColorConfiguration& config);

}  // namespace terrazzo
