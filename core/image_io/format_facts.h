#pragma once

#include <filesystem>
#include <string>
#include <string_view>

/// What the headers of image files say that the image library reads wrongly, or does not tell. Thread-safe.
namespace terrazzo {

struct FormatFacts {
  std::string refusal{};          ///< why the pixels cannot be read rightly; empty if they can
  bool unused_alpha = false;      ///< the fourth channel is none: the header does not say that it holds anything
  bool premultiplied = false;     ///< colours are multiplied by alpha
  bool inverted_colours = false;  ///< what comes of all channels but alpha is 1 - value
  bool inverted_alpha = false;
  std::string note{};  ///< what the user should know, a part of a sentence that begins with "its" or "it"
};

/// Why colours of a space such as "CMYK" are not read, and what to do.
std::string refusal_of_space(std::string_view space);

/// Of a file of a format that they are known for: TIFF, BMP, TGA, PSD, DDS, JPEG 2000, FITS. Looks at a few bytes.
/// Throws FileError if the file cannot be read.
FormatFacts format_facts(const std::filesystem::path& path);

}  // namespace terrazzo
