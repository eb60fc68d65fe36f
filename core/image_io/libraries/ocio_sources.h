#pragma once

#include <map>
#include <string>

#include <OpenColorIO/OpenColorIO.h>

#include "core/image_io/image_libraries.h"

namespace terrazzo {

/// What any transform of a configuration names, whatever it is used for: of colour spaces, looks, view and named
/// transforms, and those within them. Opens no file.
ColorSources sources_of(const OCIO_NAMESPACE::Config& config);

/// The text with its variables filled in; adds these to `variables`.
std::string expand(const OCIO_NAMESPACE::Context& context, const char* text,
                   std::map<std::string, std::string>& variables);

}  // namespace terrazzo
