#pragma once

#include <string>

namespace terrazzo {

/// The version; the compiler and the libraries that the program was built with; and the interface that plug-ins must be
/// compiled for.
std::string built_with();

}  // namespace terrazzo
