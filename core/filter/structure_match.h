#pragma once

#include <vector>

#include "core/image/image.h"

namespace terrazzo {

/// The structure of a picture on a small grid, comparable between kinds of maps: brightness (for normals their slope)
/// and edges.
struct Structure {
  Size size;
  std::vector<float> values, edges;
};
Structure structure_of(const ImagePtr& image, Size grid);

/// How well the structures of two maps match, 0..1: the best correlation between values or edges of one and those of
/// the other. Maps of the same surface reach 0.06 to 1; if one is rotated, mostly less than 0.1.
double agreement(const Structure& a, const Structure& b);

/// The grid on which two pictures are compared.
Size structure_grid(Size a, Size b);

}  // namespace terrazzo
