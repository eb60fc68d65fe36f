#pragma once

#include <cstdint>
#include <vector>

#include "core/base/task.h"
#include "core/image/image.h"
#include "core/material/material.h"

/// Maps line by line, as wrap detection compares them.
namespace terrazzo {

/// A map in memory, and where it counts.
struct SeenMap {
  ImagePtr image;
  std::vector<uint8_t> counts{};  ///< 1 where it does, row by row; empty: everywhere

  /// Of a window that may lie across a border.
  bool counts_all(int x, int y, int side) const;
  /// How many rows, or columns, it has.
  int lines(bool rows) const { return rows ? image->height() : image->width(); }
};

/// A material's maps; none if one is too small to tell. `mask`: white where maps count; null: everywhere. Throws
/// Cancelled.
std::vector<SeenMap> seen_maps(const Material& material, const ImagePtr& mask, int smallest, const Task& task);

/// A row or column, and where it counts.
struct PixelLine {
  std::vector<float> values;
  std::vector<uint8_t> counts;
};
/// `i` may lie beyond the borders, around which it goes on.
PixelLine line_of(const SeenMap& map, bool rows, int i);

/// How far a line is from the next, summed over all pixels as if those where both count were all.
struct LineStep {
  double distance = 0;
  double seen = 0;  ///< the share of pixels where both count
};
LineStep step_between(const PixelLine& a, const PixelLine& b);
/// Of the lines before and after the border that is so many lines away from the seam.
LineStep step_at(const SeenMap& map, bool rows, int i);

}  // namespace terrazzo
