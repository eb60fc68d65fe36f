#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runner/cache/cache.h"
#include "runner/engine/key.h"

namespace terrazzo {

class History;

enum class StageState : uint8_t {
  not_needed,  ///< nothing that was asked for needs it
  cached,      ///< computed before; its outputs are known, and read from the cache if a reader wants them
  up_to_date,  ///< a sink whose files are all there, as it wrote them
  derived,     ///< lazy; made when a reader runs
  depends,     ///< runs or not, depending on what comes out of a stage that runs
  run,         ///< has to run
};
std::string_view name_of(StageState state);

/// What is known of a stage once the names of all its inputs are.
struct Resolution {
  Digest key;
  std::vector<Ingredient> ingredients;
  std::optional<StageRecord> record;    ///< what the cache knows
  std::map<std::string, Digest> names;  ///< by output port; empty until known
  bool stored = false;                  ///< every output that somebody may want lies in the cache
  std::string must_run;                 ///< why it has to run whatever its readers do; empty if it has not
};

/// A node of the graph as the runner sees it. Other stages are named by their index in Plan::stages.
struct Stage {
  const GraphNode* node = nullptr;
  bool needed = false;
  bool target = false;                    ///< asked for: a sink, or named in `only`
  bool kept = false;                      ///< its values are asked for
  std::vector<int> sources;               ///< the stages its wires come from, each once
  std::vector<int> readers;               ///< the needed stages that read it, each once
  std::vector<std::string> used_outputs;  ///< the ports that those read, or all of them if it is kept or a target
  std::optional<Resolution> known;        ///< missing as long as an input's name is
  StageState state = StageState::not_needed;
  std::string reason;

  const NodeType& type() const { return *node->type; }
  /// Whether a run is going to reuse or compute it; a lazy stage that has never run may not be asked for.
  bool expected() const { return needed && (state != StageState::derived || known->record); }
  /// Whether its values can be had without running it.
  bool loadable() const { return known && known->record && type().persist == Persist::payload && known->stored; }
};

struct PlanOptions {
  std::vector<std::string> only;  ///< the targets; empty: every sink, or every node nobody reads if there is no sink
  std::vector<std::string> keep;  ///< more targets, whose values are wanted in memory
};

/// What a run will do, and why. The graph must outlive it.
struct Plan {
  const Graph* graph = nullptr;
  std::vector<Stage> stages;  ///< one per node, in the graph's order

  int count(StageState state) const;
  int needed() const { return static_cast<int>(stages.size()) - count(StageState::not_needed); }
  /// "12 stages: 9 cached, 3 to run".
  std::string summary() const;
  /// The summary and an aligned table of all stages.
  std::string table() const;
};

/// Works out what has to run. `cache` may be null: then everything has to; `history`, if given, lets reasons name the
/// first thing that differs from the last run. Throws Error if a name in `options` is not a node, and GraphError with
/// all problems that can be told before anything runs (see runner/engine/preflight.h).
Plan make_plan(const Graph& graph, Cache* cache, const PlanOptions& options = {}, const History* history = nullptr);

/// What can be said of a stage now that all its inputs' names are known. Reads the cache; changes nothing.
Resolution resolve(const Plan& plan, int stage, Cache* cache, const History* history);

/// The names of a stage's outputs after computing it to `values`.
std::map<std::string, Digest> names_of(const NodeType& type, const Digest& key,
                                       const std::map<std::string, Value>& values);

/// Whether the record names all outputs.
bool is_complete(const StageRecord& record, const NodeType& type);

/// The content digest of a file, memoised if there is a cache.
Digest digest_of_file(Cache* cache, const std::filesystem::path& path);

}  // namespace terrazzo
