#pragma once

#include <memory>

#include "runner/engine/schedule.h"

namespace terrazzo {

/// A piece of work for one stage, and what came of it. Made by the coordinator, filled in by `perform` on some worker.
struct Job {
  enum class Kind : uint8_t {
    begin,    ///< nothing to do; wakes the coordinator
    look_up,  ///< resolve the stage's key now that its inputs have names
    load,     ///< read its values from the cache
    compute,  ///< run the node
    store,    ///< put its values and its record into the cache
  };
  Kind kind = Kind::begin;
  int stage = 0;
  uint64_t memory = 0;                   ///< what a compute job is expected to need
  std::unique_ptr<NodeContext> context;  ///< for compute
  std::map<std::string, Value> values;   ///< in for store; out for load (empty if it failed) and compute
  std::optional<StageRecord> record;     ///< in for store; out for compute
  std::optional<Resolution> resolution;  ///< out for look_up
  std::shared_ptr<Lease> lease;          ///< out for compute, in for store: given up once its result is stored
  bool made_elsewhere = false;           ///< out for compute: values and record are what another process has stored
  bool busy = false;                     ///< out for compute: another process is at it; to be tried again
  bool resumed = false;                  ///< was busy, and there is reason to try it again
  bool waited = false;                   ///< has been busy before
  bool cancelled = false;
  std::optional<std::string> failure;  ///< a complete message
  std::string blames_input;            ///< what it says, if what came in is to blame: others may say the same
  std::vector<std::filesystem::path> made_folders;  ///< by compute, outer ones first
  Span span;
};
using JobPtr = std::shared_ptr<Job>;

/// Does what the job says; never throws. Reads of the plan only what is settled by then.
void perform(Job& job, const Plan& plan, const RunOptions& options);

}  // namespace terrazzo
