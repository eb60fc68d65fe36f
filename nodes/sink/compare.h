#pragma once

#include <string>
#include <vector>

#include "core/node/node.h"

namespace terrazzo {

/// A figure that a comparison may report.
struct ComparedFigure {
  enum class Better : uint8_t { lower, higher, neither };  ///< neither: values near 1 are good
  std::string name;
  Better better = Better::lower;
};

/// All figures that a compare node with these parameters may report, in order, including those computed from the uv
/// map.
std::vector<ComparedFigure> compared_figures(const Params& params, bool has_uv, bool has_labels);

}  // namespace terrazzo
