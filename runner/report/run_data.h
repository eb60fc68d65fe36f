#pragma once

#include <map>
#include <string>
#include <vector>

#include "runner/engine/schedule.h"
#include "runner/report/pictures.h"

namespace terrazzo {

/// What a stage did, in one or two words: "run", "cached", "up to date", "failed", "not run", "skipped", "not
/// needed".
std::string_view what_it_did(const Stage& stage, const StageOutcome& outcome);

/// Why, as the run found out or the plan foresaw.
const std::string& reason_of(const Stage& stage, const StageOutcome& outcome);

/// Parameters of a node that are not what they are if nobody sets them, as "size 512x512, seed 7".
std::string settings_text(const GraphNode& node);

/// A picture on the page, by its id.
struct NamedPicture {
  std::string id;
  std::string caption;
};

/// A material to be lit, by the ids of its maps.
struct LitMaterial {
  std::string title;
  MaterialPtr material;
  std::map<std::string, std::string> maps;  ///< by the name of what a map means: {"base_color": "picture-1"}
};

/// Everything that can be said of a run, as JSON: the graph file, its parameters, seeds, nodes with their parameters,
/// what they did and why, and which pictures of the page show what they gave (`pictures`, by node).
std::string run_as_json(const Plan& plan, const RunResult& result,
                        const std::map<std::string, std::vector<NamedPicture>>& pictures,
                        const std::vector<LitMaterial>& materials);

}  // namespace terrazzo
