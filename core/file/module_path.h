#pragma once

#include <filesystem>
#include <string>

namespace terrazzo {

/// The path of a module that is loaded on demand: beside the library that this code is in, in a folder "terrazzo"
/// there, where it is installed, or where it was built. Throws Error if it is in none of these places; `what` it is,
/// says the message.
std::filesystem::path module_path(const std::string& name, const std::string& what);

}  // namespace terrazzo
