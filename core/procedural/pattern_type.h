#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/procedural/surface.h"

namespace terrazzo {

/// A pattern type. The factory is called with a spec whose scale and palette are filled in.
struct PatternType {
  std::string name;
  std::string summary;
  double scale = 5;     ///< pieces across by default
  double depth = 0.1;   ///< from the lowest to the highest point, in widths of a piece
  double cavity = 0.3;  ///< how much recesses darken the colour (dirt and interreflection), 0..1
  std::vector<Palette> palettes;
  std::unique_ptr<Surface> (*make)(const Canvas& canvas, const PatternSpec& spec, const Palette& palette);
};

}  // namespace terrazzo
