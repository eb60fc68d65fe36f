#pragma once

#include <string>
#include <vector>

#include "runner/api/session.h"

/// Selects the nodes and materials that a report shows.
namespace terrazzo {

/// The nodes whose values a report shows: the targets (sinks, or `only`), the nodes that sinks read, and, if they are
/// cheap, the exemplars and uv maps behind those, and the indexes of the uv maps: they run anyway, are stored, or only
/// read a file. At most `most_shown_nodes`. Pass them as PlanOptions::keep. Throws as make_plan.
std::vector<std::string> nodes_for_report(const Graph& graph, const std::vector<std::string>& only, Session& session);

inline constexpr size_t most_shown_nodes = 48;

struct ShownMaterial {
  std::string node;
  MaterialPtr material;
};

/// The materials among a run's kept values, without duplicates, including base colour images.
struct ShownMaterials {
  std::vector<ShownMaterial> results;    ///< materials that sinks write
  std::vector<ShownMaterial> exemplars;  ///< source materials of the results
};
ShownMaterials materials_of(const Graph& graph, const RunResult& result);

}  // namespace terrazzo
