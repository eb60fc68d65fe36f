#pragma once

#include <string>
#include <string_view>

#include "graphs/library/library.h"

namespace terrazzo {

/// An entry as the JSON file that describes it. Files beside it go by name; the material's folder is relative to the
/// library if it lies in it.
std::string entry_as_json(const LibraryEntry& entry);

/// The way back. `text`: of the file of the entry `name` in `library`. Throws Error that says what is wrong with it.
LibraryEntry entry_from_json(std::string_view text, const std::string& name, const std::filesystem::path& library);

/// The file that describes an entry.
std::filesystem::path entry_file(const std::filesystem::path& library, const std::string& name);

}  // namespace terrazzo
