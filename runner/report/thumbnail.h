#pragma once

#include <string>

#include "core/image/image.h"

namespace terrazzo {

/// The image as people see it, at most `longest` pixels a side: a PNG as a data URI. Colours are shown in sRGB; values
/// outside [0, 1] are clipped; two channels are shown as red and green. Pulls every pixel once.
std::string thumbnail_uri(const ImagePtr& image, int longest);

}  // namespace terrazzo
