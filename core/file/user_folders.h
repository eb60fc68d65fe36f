#pragma once

#include <filesystem>
#include <string>

/// The locations of a user's files.
namespace terrazzo {

/// An environment variable; empty if it is not set.
std::string environment(const char* name);

/// The folder in the environment variable `variable`; else "terrazzo" in the folder in `base`, such as XDG_CACHE_HOME;
/// else "terrazzo" in `usual` below the home folder. Throws Error if there is no home folder.
std::filesystem::path user_folder(const char* variable, const char* base, const char* usual);

}  // namespace terrazzo
