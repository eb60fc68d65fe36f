#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "runner/api/session.h"
#include "runner/editor/previews/grace.h"
#include "runner/editor/previews/graph_loading.h"
#include "runner/editor/previews/picture_board.h"
#include "runner/editor/previews/previews.h"
#include "runner/editor/previews/sweeps.h"
#include "runner/editor/previews/watched_files.h"
#include "runner/editor/previews/wishes.h"

namespace terrazzo {

/// Problems that only planning a graph, or opening its files, finds.
struct RunFindings {
  std::vector<Problem> errors{}, warnings{};
};

/// Runs an edited graph in the background: what tabs want to see, again after every change, and what the user asks for.
/// At most one change is worked on, and only the newest waits. What is under way when a change comes may show its first
/// picture, so that pictures follow a slider, but takes no longer than GracePeriod allows; work whose result is the
/// same goes on. Sinks run only in run(). Thread-safe.
class Runs {
 public:
  /// `found` is called when findings() have changed; from any thread. Borrows the session and the sandbox.
  Runs(Session& session, const Sandbox& sandbox, PictureStore& store, PublishEvent publish,
       std::function<void()> found);
  /// Cancels what runs, and waits for its end.
  ~Runs();
  Runs(const Runs&) = delete;
  Runs& operator=(const Runs&) = delete;

  /// The document has this text now.
  void changed(std::string text, std::filesystem::path file);
  /// Looks whether files have changed that the graph reads; if so, everything is looked at again. To be called about
  /// once a second, by one thread.
  bool look_at_files();
  /// What a tab wants to see, see Wishes::set. Throws Error.
  void show(const nlohmann::ordered_json& request);
  void forget(const std::string& tab);

  /// Starts a run of these nodes, or of everything; cancels one that was started before. With `sinks` those run that
  /// were meant, else only what they read. Throws Error for unknown nodes.
  void run(std::vector<NodeOfDocument> nodes, bool sinks);
  void cancel();
  /// See Sweeps::start; a change of the document ends it.
  nlohmann::ordered_json sweep(const nlohmann::ordered_json& request);
  void end_sweep() { sweeps_.cancel(); }

  /// What a run of everything would do, and why, as in the event "plan".
  nlohmann::ordered_json plan();
  RunFindings findings() const;
  /// See PictureBoard::current.
  std::vector<std::string> current_pictures() const;
  /// Waits until nothing runs or waits; for tests.
  bool wait_until_idle(std::chrono::milliseconds most) const;

 private:
  struct Asked {
    std::vector<NodeOfDocument> nodes;
    bool sinks = false;
  };
  /// Something that pictures depend on has changed. Needs the lock.
  void mark_dirty();
  void look_loop();
  void look(const std::string& text, const std::filesystem::path& file, const std::vector<Wish>& wishes);
  void tell_plan(const EditedGraph& graph, bool look_deeper);
  void set_findings(RunFindings findings);
  void make_loop();
  /// What of the work is not stale goes on; what is, as long as what it shows will be shown anew.
  void hand_over(std::shared_ptr<const EditedGraph> graph, std::vector<PreviewTarget> targets);
  void full_loop();
  void run_fully(const Asked& asked, const std::string& text, const std::filesystem::path& file);

  Session& session_;
  const Sandbox& sandbox_;
  PublishEvent publish_;
  std::function<void()> found_;
  PictureBoard board_;
  Previews previews_;
  Sweeps sweeps_;
  WatchedFiles files_;

  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  bool stops_ = false;
  std::string text_;
  std::filesystem::path file_;
  Wishes wishes_;
  bool is_dirty_ = false, is_plan_old_ = false;
  bool looks_ = false, makes_ = false, runs_ = false;  // what the threads are at
  RunFindings findings_;
  std::shared_ptr<const EditedGraph> graph_;  // as last loaded

  std::deque<PreviewTarget> to_make_;
  std::shared_ptr<const EditedGraph> graph_to_make_;
  std::vector<PreviewTarget> being_made_;  // first what is computed, then what its coarse forms are shown for
  std::optional<Asked> asked_;
  GracePeriod looking_, making_;
  std::atomic<bool> look_is_stale_{false}, run_cancelled_{false};
  std::thread look_thread_, make_thread_, full_thread_;
};

}  // namespace terrazzo
