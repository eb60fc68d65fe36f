#pragma once

#include <optional>
#include <string>

#include "core/node/node.h"
#include "graphs/document/forecasts.h"

/// The expected shapes of results, shown in plans.
namespace terrazzo {

/// The shape of a node's first output with a forecast.
struct PlanShape {
  std::optional<Size> size{};     ///< of a uv map, image or material; for an analysis that of its exemplar
  std::optional<int> channels{};  ///< of an image, or of all maps together if they are known
};
PlanShape shape_of(const GraphNode& node, const Forecasts& forecasts);

/// "2048x1024 9ch"; "-" if nothing is known.
std::string describe(const PlanShape& shape);

}  // namespace terrazzo
