#pragma once

#include <memory>

#include "runner/engine/run_options.h"
#include "runner/engine/run_result.h"

namespace terrazzo {

/// A piece of work for one stage, and its result. Created by the coordinator, run by `perform` on a worker.
struct StageJob {
  enum class Kind : uint8_t {
    begin,    ///< nothing to do; wakes the coordinator
    look_up,  ///< resolve the stage's key, once its inputs have names
    load,     ///< read its values from the cache
    compute,  ///< run the node
    store,    ///< put its values and its record into the cache
  };
  Kind kind = Kind::begin;
  int stage = 0;
  uint64_t memory = 0;                   ///< bytes that a compute job is expected to need
  std::unique_ptr<NodeContext> context;  ///< for compute
  std::map<std::string, Value> values;   ///< in for store; out for load (empty if it failed) and compute
  std::optional<StageRecord> record;     ///< in for store; out for compute
  std::optional<Resolution> resolution;  ///< out for look_up
  std::shared_ptr<Lease> lease;          ///< out for compute, in for store: given up once its result is stored
  bool stored = false;                   ///< out for store: its values can be loaded again
  bool computed_remotely = false;        ///< out for compute: values and record were stored by another process
  bool busy = false;                     ///< out for look_up and compute: another process is computing it; retry later
  bool resumed = false;                  ///< was busy, and is being retried
  bool waited = false;                   ///< has been busy before
  bool cancelled = false;
  std::optional<std::string> failure;  ///< the complete message
  std::string blames_node;             ///< the responsible node, if it is not the one that ran
  std::string blames_input;            ///< the message if an input is responsible: other readers may report the same
  std::vector<std::filesystem::path> made_folders;  ///< by compute, outer ones first
  Span span;

  /// The key of its stage.
  const Digest& key(const Plan& plan) const { return resolution ? resolution->key : plan.stages[stage].known->key; }
};
using StageJobPtr = std::shared_ptr<StageJob>;

/// Whether another process is computing a stage that must run, and will store its names.
bool is_being_made(const Stage& stage, const Resolution& known, const RunOptions& options);

/// Runs the job on any thread; never throws. Reads only settled parts of the plan.
void perform(StageJob& job, const Plan& plan, const RunOptions& options);

}  // namespace terrazzo
