#pragma once

#include <map>
#include <string>
#include <vector>

#include "runner/engine/schedule.h"
#include "runner/report/pictures.h"

namespace terrazzo {

/// The outcome of a stage in one or two words: "run", "cached", "up to date", "failed", "not run", "skipped", "not
/// needed".
std::string_view what_it_did(const Stage& stage, const StageOutcome& outcome);

/// The reason, from the run or from the plan.
const std::string& reason_of(const Stage& stage, const StageOutcome& outcome);

/// A node's parameters that differ from their defaults, as "size 512x512, seed 7".
std::string settings_text(const GraphNode& node);

/// A picture on the page, by its id.
struct NamedPicture {
  std::string id;
  std::string caption;
};

/// A material for the lit view, by the ids of its maps.
struct LitMaterial {
  std::string title;
  MaterialPtr material;
  std::map<std::string, std::string> maps;  ///< by semantic name: {"base_color": "picture-1"}
};

/// The complete description of a run as JSON: the graph file, its parameters, seeds, nodes with their parameters,
/// outcomes and reasons, and the ids of the pictures that show their results (`pictures`, by node).
std::string run_as_json(const Plan& plan, const RunResult& result,
                        const std::map<std::string, std::vector<NamedPicture>>& pictures,
                        const std::vector<LitMaterial>& materials);

}  // namespace terrazzo
