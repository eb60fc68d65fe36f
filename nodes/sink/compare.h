#pragma once

#include <string>
#include <vector>

#include "core/node/node.h"

namespace terrazzo {

/// A figure that a comparison may give.
struct ComparedFigure {
  enum class Better : uint8_t { lower, higher, neither };  ///< neither: about 1 is good
  std::string name;
  Better better = Better::lower;
};

/// All figures that a compare node with these parameters may give, in their order. What a uv map itself decides is
/// among them.
std::vector<ComparedFigure> compared_figures(const Params& params, bool has_uv, bool has_labels);

}  // namespace terrazzo
