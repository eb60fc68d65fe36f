#pragma once

#include <filesystem>
#include <string>
#include <string_view>

/// Facts from the headers of image files that the image library misreads or does not report. Thread-safe.
namespace terrazzo {

struct FormatFacts {
  std::string refusal{};          ///< why the pixels cannot be read correctly; empty if they can
  bool unused_alpha = false;      ///< the fourth channel is padding: the header does not declare it as alpha
  bool premultiplied = false;     ///< colours are multiplied by alpha
  bool inverted_colours = false;  ///< all channels but alpha are stored as 1 - value
  bool inverted_alpha = false;
  std::string note{};  ///< a note for the user, as a clause that begins with "its" or "it"
};

/// A message on why colours of a space such as "CMYK" are not read, and what to do.
std::string refusal_of_space(std::string_view space);

/// Reads a few bytes of a TIFF, BMP, TGA, PSD, DDS, JPEG 2000 or FITS file; for other formats returns the defaults.
/// Throws FileError if the file cannot be read.
FormatFacts format_facts(const std::filesystem::path& path);

}  // namespace terrazzo
