#pragma once

#include <filesystem>
#include <string>
#include <vector>

/// Files that are maps by their names, but cannot be read.
namespace terrazzo {

/// Includes dangling links, pipes and devices, so that reading them fails: otherwise the material would silently lack a
/// map.
bool is_no_folder(const std::filesystem::directory_entry& entry);

/// A message about each file with a map keyword in a picture format that cannot be read, by name.
std::vector<std::string> notes_on_other_formats(const std::filesystem::path& folder);

/// What to say of files with map keywords but without an image extension; folders in `present` end in '/'.
std::string maps_of_other_endings(const std::vector<std::string>& present);

}  // namespace terrazzo
