#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "runner/plan/planning.h"

namespace terrazzo {

class Sandbox;

/// Receives the events of a run. Calls come from any thread, concurrently, and must return quickly. Every needed stage
/// gets one of finished, reused, not_needed, failed and skipped, unless the run ends early.
class RunObserver {
 public:
  virtual ~RunObserver() = default;
  virtual void planned(const Plan&) {}
  virtual void started(const Stage&) {}
  /// Another process is computing it; called once.
  virtual void waits(const Stage&) {}
  virtual void progressed(const Stage&, double /*fraction*/) {}
  /// A coarse form of what the stage is making. Only if wants_previews(), which is asked when a stage starts.
  virtual void previewed(const Stage&, const UvMapPtr& /*coarse*/) {}
  virtual bool wants_previews() const { return false; }
  virtual void noted(const Stage&, const std::string& /*message*/) {}
  virtual void finished(const Stage&, double /*seconds*/) {}
  /// It did not have to run: its result is cached, or its files are up to date.
  virtual void reused(const Stage&) {}
  /// Its result turned out not to be needed and does not exist.
  virtual void not_needed(const Stage&) {}
  virtual void failed(const Stage&, const std::string& /*message*/) {}
  /// It cannot run because the node `because`, which it needs, has failed. Only with `targets.keep_going`.
  virtual void skipped(const Stage&, const std::string& /*because*/) {}
};

struct RunOptions {
  PlanOptions targets;
  Cache* cache = nullptr;      ///< null: nothing is reused and nothing is kept
  History* history = nullptr;  ///< for the reasons in plans; updated by the run
  int threads = 0;             ///< 0: one per core
  uint64_t memory = 0;         ///< budget in bytes for values and running nodes; 0: the process's, see memory_budget
  bool checked = false;        ///< runs each node twice, see runner/engine/checked.h; uses one thread and no cache
  const std::atomic<bool>* cancelled = nullptr;  ///< set it to stop the run; may be null
  RunObserver* observer = nullptr;
  const Sandbox* sandbox = nullptr;  ///< restricts which files nodes may read and write; may be null
};

}  // namespace terrazzo
