#pragma once

#include <filesystem>
#include <vector>

#include "core/base/geometry.h"

/// Facts about image files that the image library does not report or notice, read from the files' own structure.
namespace terrazzo {

/// What the markers of a JPEG file (ITU T.81, annex B) say; decoders fill in for missing data without a word.
struct JpegFacts {
  int components = 0;        ///< 1 grey, 3 colour, 4 CMYK; 0 if no frame header was found
  int bits = 0;              ///< of each component
  Size size{};               ///< as stored, before it is turned
  bool has_exif = false;     ///< it may have to be turned
  bool progressive = false;  ///< decoders hold all of it at once
  bool complete = false;     ///< the end-of-image marker is there
};
/// Unless `to_its_end`, reads up to the frame header, and does not look whether it is complete.
JpegFacts read_jpeg_facts(const std::filesystem::path& path, bool to_its_end = true);

/// Whether the chunks of a PNG file go on to its end mark.
bool png_is_complete(const std::filesystem::path& path);

/// What a TIFF or BigTIFF file says of its first image's values (TIFF 6.0, sections 3, 18 and 19).
struct TiffFacts {
  int samples = 0;  ///< of a pixel; 0 if it is no TIFF file
  int bits = 1;     ///< of each
  int format = 1;   ///< 1 unsigned, 2 signed, 3 floating point
  int photometric = -1;
  std::vector<int> extra_samples{};  ///< 0 unspecified, 1 alpha that colours are multiplied by, 2 other alpha
};
TiffFacts read_tiff_facts(const std::filesystem::path& path);

/// Whether all strips or tiles of a TIFF or BigTIFF file's first image lie inside the file.
bool tiff_is_complete(const std::filesystem::path& path);

/// Whether the checksums of a TIFF file's deflated strips or tiles fit, and whether those in LZW and PackBits, which
/// have none, stand for as many bytes as they should; decoders look at neither. True for other compressions.
bool tiff_is_sound(const std::filesystem::path& path);

/// False if the end of a PNG, JPEG or TIFF file is missing, or of another that core/integrity/picture_ends.h knows.
/// Reads little, and so takes a cut-off JPEG file that by chance ends like a whole one for whole; true for files of
/// other formats.
bool seems_complete(const std::filesystem::path& path);

}  // namespace terrazzo
