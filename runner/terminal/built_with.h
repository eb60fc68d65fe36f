#pragma once

#include <string>

namespace terrazzo {

/// The version, the compiler and libraries of the build, and the plug-in ABI.
std::string built_with();

}  // namespace terrazzo
