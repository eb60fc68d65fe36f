#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <mutex>
#include <string>

#include <nlohmann/json.hpp>

#include "runner/editor/previews/picture_board.h"
#include "runner/engine/run_options.h"

namespace terrazzo {

/// Tells the tabs what a run does, in the events of runner/report/progress.h. Thread-safe.
class RunEvents : public RunObserver {
 public:
  /// `coarse` is called with coarse results, if set; by the thread that makes them.
  using Coarse = std::function<void(const Stage& stage, const UvMapPtr& coarse)>;
  /// `is_part`: places in messages are those of another document, and are left out.
  RunEvents(PublishEvent publish, bool is_part, Coarse coarse = {});

  void started(const Stage& s) override;
  void waits(const Stage& s) override;
  void progressed(const Stage& s, double fraction) override;
  void previewed(const Stage& s, const UvMapPtr& coarse) override;
  bool wants_previews() const override { return bool(coarse_); }
  void noted(const Stage& s, const std::string& message) override;
  void finished(const Stage& s, double seconds) override;
  void reused(const Stage& s) override;
  void failed(const Stage& s, const std::string& message) override;
  void skipped(const Stage& s, const std::string& because) override;

 private:
  void tell(const char* event, const Stage& s, const nlohmann::ordered_json& more = nlohmann::ordered_json::object());

  PublishEvent publish_;
  bool is_part_;
  Coarse coarse_;
  std::mutex mutex_;
  std::map<const Stage*, std::chrono::steady_clock::time_point> last_progress_;
};

/// The event "plan": {"stages": [{node, type, state, reason, seconds}], "summary"}.
nlohmann::ordered_json plan_json(const Plan& plan);

}  // namespace terrazzo
