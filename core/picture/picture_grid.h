#pragma once

#include <string>
#include <vector>

#include "core/base/task.h"
#include "core/image/image.h"

namespace terrazzo {

/// The layout of `picture_grid`.
struct GridSpec {
  int columns = 4;                    ///< at most; fewer pictures make a narrower sheet
  Size cell{256, 256};                ///< space for each picture, in pixels
  int gap = 8;                        ///< around cells, in pixels
  bool enlarge = false;               ///< scale smaller pictures up to their cells
  std::vector<std::string> captions;  ///< below the pictures, in their order; may be fewer, and empty
};

/// Throws Error if a sheet of that many pictures is impossible.
void require_grid(size_t pictures, const GridSpec& spec);

/// The size of the sheet for that many pictures.
Size grid_size(size_t pictures, const GridSpec& spec);

/// Pictures of any sizes and kinds row by row in cells of one size, each scaled to fit and centred, as one 8-bit sRGB
/// image. Colours are converted from their colour space; a picture of one or two channels is shown by its first as
/// grey, a fourth channel is left out; values are clamped to [0, 1]. Captions have up to three lines in a readable size
/// and are truncated to their cell. Throws Error if there is no picture, more captions than pictures, or the sheet
/// would be wider or higher than 32768 pixels.
ImagePtr picture_grid(const std::vector<ImagePtr>& pictures, const GridSpec& spec, const Task& task);

}  // namespace terrazzo
