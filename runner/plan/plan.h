#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "runner/cache/cache.h"
#include "runner/plan/key.h"
#include "runner/plan/plan_shapes.h"

namespace terrazzo {

class History;

enum class StageState : uint8_t {
  not_needed,  ///< no target needs it
  cached,      ///< computed before; outputs are read from the cache if a reader needs them
  up_to_date,  ///< a sink whose files are all there, unchanged
  derived,     ///< lazy; computed when a reader runs
  depends,     ///< runs or not, depending on the result of a stage that runs
  run,         ///< has to run
};
std::string_view name_of(StageState state);

/// The result of looking up a stage, once all its inputs have names.
struct Resolution {
  Digest key;
  std::vector<Ingredient> ingredients;
  std::optional<StageRecord> record;    ///< from the cache
  std::map<std::string, Digest> names;  ///< by output port; empty until known
  bool stored = false;                  ///< every output that may be needed is in the cache
  std::string must_run;                 ///< why it must run regardless of its readers; empty if it need not
};

/// A node of the graph in a plan. Refers to other stages by their index in Plan::stages.
struct Stage {
  const GraphNode* node = nullptr;
  bool needed = false;
  bool target = false;                    ///< a sink, or named in `only`
  bool kept = false;                      ///< its values are returned to the caller
  std::vector<int> sources;               ///< its source stages, each once
  std::vector<int> readers;               ///< the needed stages that read it, each once
  std::vector<std::string> used_outputs;  ///< the ports that its readers use; all if it is kept or a target
  std::optional<Resolution> known;        ///< missing while an input has no name
  StageState state = StageState::not_needed;
  std::string reason;
  std::vector<std::string> faults;  ///< why it is certain to fail, as complete messages; only with `keep_going`
  PlanShape shape{};                ///< shape of its result, as far as it is known
  double expected_seconds = 0;      ///< computing time from earlier runs, else 1 second; 0 if it is not expected to run

  const NodeType& type() const { return *node->type; }
  /// Whether a run will reuse or compute it; a lazy stage that has never run may not be needed.
  bool expected() const { return needed && (state != StageState::derived || known->record); }
  /// Whether its values can be loaded without running it.
  bool loadable() const { return known && known->record && type().persist == Persist::payload && known->stored; }
};

/// The stages that a run will execute or reuse, with reasons. The graph must outlive the plan.
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

/// Looks up a stage whose inputs all have names. Reads the cache; changes nothing.
Resolution resolve(const Plan& plan, int stage, Cache* cache, const History* history);

/// The names of a stage's outputs, given the computed `values`.
std::map<std::string, Digest> names_of(const NodeType& type, const Digest& key,
                                       const std::map<std::string, Value>& values);

/// Whether the record names all outputs.
bool is_complete(const StageRecord& record, const NodeType& type);

/// The digest of a file's content, memoised if there is a cache.
Digest digest_of_file(Cache* cache, const std::filesystem::path& path);

}  // namespace terrazzo
