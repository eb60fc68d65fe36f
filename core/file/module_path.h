#pragma once

#include <filesystem>
#include <string>

namespace terrazzo {

/// The path of a module that is loaded on demand: beside the library that contains this code, in a folder "terrazzo"
/// there, in the installation, or in the build tree. Throws Error if it is in none of these places. `what`: a
/// description for the message.
std::filesystem::path module_path(const std::string& name, const std::string& what);

}  // namespace terrazzo
