#pragma once

#include <optional>
#include <string>

#include "core/node/node.h"
#include "graphs/document/forecasts.h"

/// What plans show of the results of nodes before they run.
namespace terrazzo {

/// Of a node's first output of which something is known.
struct PlanShape {
  std::optional<Size> size{};     ///< of a uv map, image or material; of an analysis its exemplar's
  std::optional<int> channels{};  ///< of an image; of all maps together, if it is certain which they are
};
PlanShape shape_of(const GraphNode& node, const Forecasts& forecasts);

/// "2048x1024 9ch"; "-" if nothing is known.
std::string describe(const PlanShape& shape);

}  // namespace terrazzo
