#pragma once

#include <map>
#include <string>

#include <OpenColorIO/OpenColorIO.h>

#include "core/image_io/image_libraries.h"

namespace terrazzo {

/// The files, folders and variables that a configuration's transforms name: those of colour spaces, looks, view and
/// named transforms, including nested ones. Opens no file.
ColorSources sources_of(const OCIO_NAMESPACE::Config& config);

/// Expands variables in a text and adds them to `variables`.
std::string expand(const OCIO_NAMESPACE::Context& context, const char* text,
                   std::map<std::string, std::string>& variables);

}  // namespace terrazzo
