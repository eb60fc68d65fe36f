#pragma once

#include <vector>

#include "core/image/image.h"

namespace terrazzo {

/// Where a picture has structure, whatever it shows: its brightness (of normals their slope) and its edges on a small
/// grid.
struct Structure {
  Size size;
  std::vector<float> values, edges;
};
Structure structure_of(const ImagePtr& image, Size grid);

/// How well the structures of two maps of one surface coincide, 0..1: the best of the correlations of values and edges
/// of one with those of the other. Maps of a surface reach 0.06 to 1, maps of which one is turned mostly below 0.1.
double agreement(const Structure& a, const Structure& b);

/// The grid on which two pictures are compared.
Size structure_grid(Size a, Size b);

}  // namespace terrazzo
