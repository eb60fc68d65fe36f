#pragma once

#include <string>
#include <vector>

#include "runner/api/session.h"

/// What of a run a report shows.
namespace terrazzo {

/// The nodes whose values a report shows: the targets (sinks, or `only`), what sinks read, and, where that costs
/// nothing much, the exemplars and uv maps these are made from: as far as they run anyway, are stored, or only read a
/// file. At most `most_shown_nodes`. Pass them as PlanOptions::keep. Throws as make_plan does.
std::vector<std::string> nodes_for_report(const Graph& graph, const std::vector<std::string>& only, Session& session);

inline constexpr size_t most_shown_nodes = 48;

struct ShownMaterial {
  std::string node;
  MaterialPtr material;
};

/// The materials of a run, from the values that it kept; each once, images of base colour among them.
struct ShownMaterials {
  std::vector<ShownMaterial> results;    ///< what sinks write
  std::vector<ShownMaterial> exemplars;  ///< sources that results are made from
};
ShownMaterials materials_of(const Graph& graph, const RunResult& result);

}  // namespace terrazzo
