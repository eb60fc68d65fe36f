#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/image/image.h"

/// Colour spaces, through OpenColorIO. The built-in configuration knows srgb_texture (sRGB transfer function, Rec.709
/// primaries), lin_rec709, acescg and raw; $OCIO or a graph's own configuration replaces it. All functions are
/// thread-safe.
namespace terrazzo {

/// The names of the configuration's colour spaces, for messages and checks. `config`: path of an OCIO configuration;
/// empty for $OCIO, or the built-in one if that is not set. Throws Error if the configuration cannot be read.
std::vector<std::string> color_space_names(const std::string& config = "");

/// The configuration's own name for a space that may be given by a common other name ("sRGB", "Utility - sRGB -
/// Texture", "linear", "ACEScg", "Raw"; case does not count). The four names of the built-in configuration are kept in
/// every configuration that has such a space. Throws Error naming the known spaces, and the nearest, if there is none.
std::string canonical_color_space(const std::string& name, const std::string& config = "");

/// The colour space of a map whose file does not say: srgb_texture for colours in 8 and 16 bit, lin_rec709 for colours
/// in float files, raw for everything that is no colour.
std::string assumed_color_space(Semantic semantic, Depth depth);

/// The image in another colour space, converted when pulled; the first three channels are colour (of one- and
/// two-channel images the first is grey), the last of two or four stays. A raw image, or one already in `to`, comes
/// back as it is; converting to raw changes the description only. Throws Error naming the known spaces if one is
/// unknown.
ImagePtr convert_color(const ImagePtr& image, const std::string& to, const std::string& config = "");

/// The files that decide what a configuration's names mean: the configuration and what lies in its search folders,
/// sorted; none for the built-in one. Nodes that convert colours list them in `files_read`.
std::vector<std::filesystem::path> color_config_files(const std::string& config = "");

/// Colour as three perceptually even channels (Oklab; Ottosson 2020: lightness 0..1, a and b about -0.4..0.4), computed
/// with the same bits on every machine when pulled. One- and two-channel images give one channel, the lightness of
/// their first. Raw images are taken as srgb_texture; spaces other than srgb_texture and lin_rec709 go through
/// OpenColorIO first and are rounded to steps of 1/65536.
ImagePtr to_oklab(const ImagePtr& image, const std::string& config = "");

}  // namespace terrazzo
