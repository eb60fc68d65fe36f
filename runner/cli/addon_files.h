#pragma once

#include <span>
#include <string_view>

namespace terrazzo {

/// A file of the add-on for Blender, embedded in the program: examples/blender/terrazzo_blender.
struct AddonFile {
  std::string_view name;  ///< "panels.py"
  std::string_view text;
};

/// By name, in alphabetical order.
std::span<const AddonFile> addon_files();

}  // namespace terrazzo
