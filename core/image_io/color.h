#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/image/image.h"

/// Colour spaces, through OpenColorIO. The built-in configuration has srgb_texture (sRGB transfer function, Rec.709
/// primaries), lin_rec709, acescg and raw; $OCIO or a graph's own configuration replaces it. Thread-safe.
namespace terrazzo {

/// The names of the configuration's colour spaces, for messages and checks. `config`: path of an OCIO configuration;
/// empty for $OCIO, or the built-in one if that is not set. Throws Error if the configuration cannot be read.
std::vector<std::string> color_space_names(const std::string& config = "");

/// Resolves a common alias ("sRGB", "Utility - sRGB - Texture", "linear", "ACEScg", "Raw"; case-insensitive) to the
/// configuration's own name. The four names of the built-in configuration work in every configuration that has such a
/// space. Throws Error with the known spaces and the closest match if there is none.
std::string canonical_color_space(const std::string& name, const std::string& config = "");

/// The default colour space of a map whose file states none: srgb_texture for 8- and 16-bit colours, lin_rec709 for
/// float colours, raw for everything else.
std::string assumed_color_space(Semantic semantic, Depth depth);

/// The image in another colour space, converted when pulled. The first three channels are colour (of one- and
/// two-channel images the first is grey); alpha stays. Returns raw images, and images already in `to`, unchanged.
/// Converting to raw changes only the description. Throws Error with the known spaces if a space is unknown.
ImagePtr convert_color(const ImagePtr& image, const std::string& to, const std::string& config = "");

/// The files that define a configuration's colour spaces: the configuration and the files in its search folders,
/// sorted; none for the built-in one. Nodes that convert colours list them in `files_read`.
std::vector<std::filesystem::path> color_config_files(const std::string& config = "");

/// The image in the perceptually uniform space Oklab (Ottosson 2020: lightness 0..1, a and b about -0.4..0.4), computed
/// when pulled, bit-exact on every machine. One- and two-channel images give one channel: the lightness of their first.
/// Raw images count as srgb_texture. Spaces other than srgb_texture and lin_rec709 are converted by OpenColorIO first
/// and rounded to multiples of 1/65536.
ImagePtr to_oklab(const ImagePtr& image, const std::string& config = "");

}  // namespace terrazzo
