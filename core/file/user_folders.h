#pragma once

#include <filesystem>
#include <string>

/// Where a user's files lie.
namespace terrazzo {

/// An environment variable; empty if it is not set.
std::string environment(const char* name);

/// The folder that the program's own `variable` names; else terrazzo in the one that `base` names, such as
/// XDG_CACHE_HOME; else terrazzo in `usual` below the home folder. Throws Error if there is no home folder.
std::filesystem::path user_folder(const char* variable, const char* base, const char* usual);

}  // namespace terrazzo
