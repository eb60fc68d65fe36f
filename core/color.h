#pragma once

#include <string>
#include <vector>

#include "core/image.h"

/// Colour spaces, through OpenColorIO. The built-in configuration knows srgb_texture (sRGB transfer function, Rec.709
/// primaries), lin_rec709, acescg and raw; $OCIO or a graph's own configuration replaces it. All functions are
/// thread-safe.
namespace terrazzo {

/// The names of the configuration's colour spaces, for messages and checks. `config`: path of an OCIO configuration;
/// empty for $OCIO, or the built-in one if that is not set. Throws Error if the configuration cannot be read.
std::vector<std::string> color_space_names(const std::string& config = "");

/// The image in another colour space, converted when pulled; the first three channels are colour, a fourth stays. A raw
/// image, or one already in `to`, comes back as it is. Throws Error naming the known spaces if one is unknown.
ImagePtr convert_color(const ImagePtr& image, const std::string& to, const std::string& config = "");

/// Colour as three perceptually even channels (Oklab; Ottosson 2020), computed with the same bits on every machine.
/// One- and two-channel images give the lightness of their first channel.
ImagePtr to_oklab(const ImagePtr& image);

}  // namespace terrazzo
