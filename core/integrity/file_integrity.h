#pragma once

#include <filesystem>
#include <vector>

#include "core/base/geometry.h"

/// Facts about image files from their structure. Own code since libjpeg, libtiff and OpenImageIO 2.4 do not report or
/// notice these, or only after decoding and loading libraries for as long as a whole cached run takes: truncated files
/// are found before a run starts. Where decoders notice damage themselves, they are left to it.
namespace terrazzo {

/// Facts from the markers of a JPEG file (ITU T.81, annex B). OpenImageIO fills in what truncated progressive files
/// miss, and says nothing.
struct JpegFacts {
  int components = 0;        ///< 1 grey, 3 colour, 4 CMYK; 0 if no frame header was found
  int bits = 0;              ///< of each component
  Size size{};               ///< as stored, before its orientation is applied
  bool has_exif = false;     ///< it may have an orientation tag
  bool progressive = false;  ///< decoders hold the whole image in memory
  bool complete = false;     ///< the end-of-image marker is present
};
/// Unless `to_its_end`, stops at the frame header and does not set `complete`.
JpegFacts read_jpeg_facts(const std::filesystem::path& path, bool to_its_end = true);

/// The sample format of a TIFF or BigTIFF file's first image (TIFF 6.0, sections 3, 18 and 19).
struct TiffFacts {
  int samples = 0;  ///< per pixel; 0 if it is no TIFF file
  int bits = 1;     ///< per sample
  int format = 1;   ///< 1 unsigned, 2 signed, 3 floating point
  int photometric = -1;
  std::vector<int> extra_samples{};  ///< 0 unspecified, 1 premultiplied alpha, 2 unassociated alpha
};
TiffFacts read_tiff_facts(const std::filesystem::path& path);

/// Whether all strips or tiles of a TIFF or BigTIFF file's first image lie inside the file.
bool tiff_is_complete(const std::filesystem::path& path);

/// Whether the strips or tiles of a TIFF file are sound: deflated ones by their checksums, LZW and PackBits ones, which
/// have none, by their unpacked length. libtiff checks neither. True for other compressions.
bool tiff_is_sound(const std::filesystem::path& path);

/// Whether a PNG, JPEG or TIFF file, or one in a format of core/integrity/picture_ends.h, has its end; true for other
/// formats. Reads little, so a truncated JPEG file that happens to end like a complete one counts as complete.
bool seems_complete(const std::filesystem::path& path);

}  // namespace terrazzo
