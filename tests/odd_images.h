#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/base/geometry.h"

/// Image files that our own writer never makes.
namespace terrazzo::test {

using Bytes = std::vector<uint8_t>;

Bytes read_bytes(const std::filesystem::path& path);
void write_bytes(const std::filesystem::path& path, const Bytes& bytes);

/// A PNG file put together by hand. `rows` are the raw scanlines without filter bytes; color_type: 0 grey, 2 RGB, 3
/// palette, 4 grey and alpha, 6 RGBA. `palette`: RGB triples.
Bytes make_png(Size size, int bits, int color_type, const std::vector<Bytes>& rows, const Bytes& palette = {});

/// An uncompressed TIFF file of one channel, put together by hand. `format`: 1 unsigned, 2 signed, 3 floating point;
/// `samples` holds the values' bytes, little endian.
Bytes make_tiff(Size size, int bits, int format, const Bytes& samples);

/// An 8x8 JPEG of uniform colour with four components.
Bytes make_cmyk_jpeg();

/// What to tell OpenImageIO about a file to write.
struct OddFile {
  Size size;
  int channels = 1;
  std::string type = "uint8";                ///< "uint8", "int16", "half", "double", ...
  std::map<std::string, int> attributes{};   ///< integer attributes
  std::vector<std::string> channel_names{};  ///< empty: the usual ones
  Rect display{};                            ///< for EXR; empty: the same as the data
  int x = 0, y = 0;                          ///< where the data begins
  int tile = 0;                              ///< side of the tiles; 0 = none
  int images = 1;                            ///< so many images, each with the same pixels
  std::vector<std::string> part_names{};     ///< for EXR: one for each of `images`
  std::vector<int> part_x{};                 ///< for EXR: where the data of each part begins, if not at `x`
  std::string compression{};                 ///< as OpenImageIO calls it; empty: the format's usual one
  bool mip = false;                          ///< a second, smaller level
};
/// Writes floats (0..1 is the range of integer types) through OpenImageIO, in the format of the path's extension.
void write_odd(const std::filesystem::path& path, const OddFile& file, const std::vector<float>& pixels);

}  // namespace terrazzo::test
