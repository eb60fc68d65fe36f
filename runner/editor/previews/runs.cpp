#include "runner/editor/previews/runs.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "runner/editor/previews/run_events.h"
#include "runner/plan/preflight.h"
#include "runner/plan/source_findings.h"

namespace terrazzo {

namespace {

using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

// A drag shows some pictures a second, and the one of the place where it ends comes hardly later for those on the way:
// tests/bench/performance.md, "The editor".
constexpr std::chrono::milliseconds longest_stale{500}, longest_stale_shown{150};

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::vector<NodeOfDocument> nodes_of(const std::vector<Wish>& wishes) {
  std::vector<NodeOfDocument> out;
  for (const Wish& w : wishes) out.push_back(w.at);
  return out;
}

bool are_same(const std::vector<Problem>& a, const std::vector<Problem>& b) {
  return std::ranges::equal(a, b, [](const Problem& x, const Problem& y) {
    return x.message == y.message && x.node == y.node && x.where == y.where && x.place.line == y.place.line &&
           x.place.column == y.place.column;
  });
}

}  // namespace

Runs::Runs(Session& session, const Sandbox& sandbox, PictureStore& store, PublishEvent publish,
           std::function<void()> found)
    : session_(session),
      sandbox_(sandbox),
      publish_(std::move(publish)),
      found_(std::move(found)),
      board_(store, publish_),
      previews_(session, sandbox, board_, publish_),
      sweeps_(session, sandbox, store, publish_),
      looking_(longest_stale, longest_stale_shown),
      making_(longest_stale, longest_stale_shown) {
  look_thread_ = std::thread([this] { look_loop(); });
  make_thread_ = std::thread([this] { make_loop(); });
  full_thread_ = std::thread([this] { full_loop(); });
}

Runs::~Runs() {
  {
    const std::lock_guard lock(mutex_);
    stops_ = look_is_stale_ = run_cancelled_ = true;
    to_make_.clear();
    looking_.cancel();
    making_.cancel();
  }
  changed_.notify_all();
  look_thread_.join();
  make_thread_.join();
  full_thread_.join();
}

void Runs::mark_dirty() {
  is_dirty_ = look_is_stale_ = true;
  looking_.set_stale(true);
}

void Runs::changed(std::string text, std::filesystem::path file) {
  sweeps_.cancel();
  {
    const std::lock_guard lock(mutex_);
    text_ = std::move(text);
    file_ = std::move(file);
    mark_dirty();
  }
  changed_.notify_all();
}

bool Runs::look_at_files() {
  std::shared_ptr<const EditedGraph> graph;
  std::string text;
  std::filesystem::path file;
  {
    const std::lock_guard lock(mutex_);
    // A graph that is being loaded reads them anyhow.
    if (is_dirty_ || looks_) return false;
    graph = graph_;
    text = text_;
    file = file_;
  }
  if (!files_.have_changed(graph, text, file, sandbox_)) return false;
  {
    const std::lock_guard lock(mutex_);
    mark_dirty();
  }
  changed_.notify_all();
  return true;
}

void Runs::show(const Json& request) {
  {
    const std::lock_guard lock(mutex_);
    wishes_.set(request);
    mark_dirty();
  }
  changed_.notify_all();
}

void Runs::forget(const std::string& tab) {
  {
    const std::lock_guard lock(mutex_);
    if (!wishes_.forget(tab)) return;
    mark_dirty();
  }
  changed_.notify_all();
}

void Runs::cancel() {
  sweeps_.cancel();
  {
    const std::lock_guard lock(mutex_);
    to_make_.clear();
    asked_.reset();
    run_cancelled_ = true;
    making_.cancel();
  }
  changed_.notify_all();
}

Json Runs::sweep(const Json& request) {
  std::string text;
  std::filesystem::path file;
  {
    const std::lock_guard lock(mutex_);
    text = text_;
    file = file_;
  }
  return sweeps_.start(request, text, file);
}

RunFindings Runs::findings() const {
  const std::lock_guard lock(mutex_);
  return findings_;
}

std::vector<std::string> Runs::current_pictures() const {
  return board_.current();
}

bool Runs::wait_until_idle(std::chrono::milliseconds most) const {
  if (!sweeps_.wait_until_idle(most)) return false;
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, most, [&] {
    return !is_dirty_ && !is_plan_old_ && !looks_ && to_make_.empty() && !makes_ && !asked_ && !runs_;
  });
}

void Runs::look_loop() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [&] { return stops_ || is_dirty_ || is_plan_old_; });
    if (stops_) return;
    const bool is_dirty = std::exchange(is_dirty_, false);
    is_plan_old_ = false;
    looks_ = true;
    look_is_stale_ = false;
    looking_.begin();
    const std::string text = text_;
    const std::filesystem::path file = file_;
    const std::vector<Wish> wishes = wishes_.all();
    const std::shared_ptr<const EditedGraph> graph = graph_;
    lock.unlock();
    try {
      if (is_dirty)
        look(text, file, wishes);
      else if (graph && graph->loaded)
        tell_plan(*graph, false);
    } catch (const Cancelled&) {
      // A newer change is waiting.
    } catch (const std::exception& e) {
      publish_("ran", {{"ok", false}, {"seconds", 0}, {"cancelled", false}, {"preview", true}, {"message", e.what()}},
               false);
    }
    lock.lock();
    looks_ = false;
    changed_.notify_all();
  }
}

void Runs::look(const std::string& text, const std::filesystem::path& file, const std::vector<Wish>& wishes) {
  const auto start = Clock::now();
  const auto graph = std::make_shared<const EditedGraph>(load_for_editing(text, file, nodes_of(wishes), sandbox_));
  {
    const std::lock_guard lock(mutex_);
    graph_ = graph;
  }
  board_.retain(wishes);
  if (!graph->loaded) {
    hand_over(graph, {});
    set_findings({.errors = graph->problems});
    publish_("plan", {{"stages", Json::array()}, {"summary", ""}}, true);
    return;
  }
  PreviewTargets targets;
  try {
    targets = previews_.targets_of(*graph, text, wishes);
  } catch (const Error&) {
    // It comes again, with its place, in tell_plan.
  }
  const bool is_all = targets.slow.empty();
  hand_over(graph, std::move(targets.slow));
  previews_.show_ready(*graph, targets.ready, looking_.cancelled());
  if (look_is_stale_) throw Cancelled();
  if (is_all)
    publish_("ran", {{"ok", true}, {"seconds", seconds_since(start)}, {"cancelled", false}, {"preview", true}}, false);
  tell_plan(*graph, true);
}

void Runs::tell_plan(const EditedGraph& edited, bool look_deeper) {
  const Graph& graph = edited.loaded->graph;
  RunFindings findings{.errors = edited.problems, .warnings = edited.unset};
  bool is_sound = findings.errors.empty();
  std::optional<Plan> plan;
  try {
    try {
      plan = session_.plan(graph, {.sandbox = &sandbox_});
    } catch (const GraphError& e) {
      is_sound = false;
      if (!edited.is_part)
        for (const Problem& p : e.problems()) findings.errors.push_back(p);
      plan = session_.plan(graph, {.keep_going = true, .sandbox = &sandbox_});
    }
  } catch (const Error& e) {
    if (findings.errors.empty()) findings.errors.push_back({{}, "", e.what(), "", "", "input"});
  }
  if (look_is_stale_) throw Cancelled();
  publish_("plan", plan ? plan_json(*plan) : Json{{"stages", Json::array()}, {"summary", ""}}, true);
  if (!look_deeper) return;
  if (is_sound) {
    const Task task(&look_is_stale_, {});
    const CurrentTask scope(task);
    for (Problem& p : look_at_sources(graph, task).warnings) findings.warnings.push_back(std::move(p));
    for (Problem& p : lint_of(graph, task)) findings.warnings.push_back(std::move(p));
  }
  set_findings(std::move(findings));
}

void Runs::set_findings(RunFindings findings) {
  {
    const std::lock_guard lock(mutex_);
    if (are_same(findings.errors, findings_.errors) && are_same(findings.warnings, findings_.warnings)) return;
    findings_ = std::move(findings);
  }
  if (found_) found_();
}

void Runs::hand_over(std::shared_ptr<const EditedGraph> graph, std::vector<PreviewTarget> targets) {
  {
    const std::lock_guard lock(mutex_);
    if (!being_made_.empty() && !making_.cancelled()) {
      const PreviewTarget& first = being_made_.front();
      const auto same = std::ranges::find_if(
          targets, [&](const PreviewTarget& t) { return t.recipe == first.recipe && t.wish == first.wish; });
      // What is shown already must not be covered by something older.
      const bool all_come_anew = std::ranges::all_of(being_made_, [&](const PreviewTarget& t) {
        return std::ranges::find(targets, t.wish, &PreviewTarget::wish) != targets.end();
      });
      making_.set_stale(same == targets.end());
      if (same != targets.end())
        targets.erase(same);
      else if (!all_come_anew)
        making_.cancel();
    }
    to_make_ = {std::move_iterator(targets.begin()), std::move_iterator(targets.end())};
    graph_to_make_ = std::move(graph);
  }
  changed_.notify_all();
}

void Runs::make_loop() {
  auto start = Clock::now();
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [&] { return stops_ || !to_make_.empty(); });
    if (stops_) return;
    if (!std::exchange(makes_, true)) start = Clock::now();
    being_made_ = {to_make_.begin(), to_make_.end()};
    to_make_.pop_front();
    const std::vector<PreviewTarget> targets = being_made_;
    const std::shared_ptr<const EditedGraph> graph = graph_to_make_;
    making_.begin();
    lock.unlock();
    bool ok = false, is_cancelled = false;
    std::string message;
    try {
      ok = previews_.make(*graph, targets, making_);
    } catch (const Cancelled&) {
      is_cancelled = true;
    } catch (const std::exception& e) {
      message = e.what();
    }
    lock.lock();
    being_made_.clear();
    if (!to_make_.empty()) continue;
    makes_ = false;
    is_plan_old_ = !is_cancelled;
    lock.unlock();
    Json data = {{"ok", ok}, {"seconds", seconds_since(start)}, {"cancelled", is_cancelled}, {"preview", true}};
    if (!message.empty()) data["message"] = message;
    publish_("ran", data, false);
    changed_.notify_all();
    lock.lock();
  }
}

Json Runs::plan() {
  std::string text;
  std::filesystem::path file;
  {
    const std::lock_guard lock(mutex_);
    text = text_;
    file = file_;
  }
  const EditedGraph edited = load_for_editing(text, file, {}, sandbox_);
  if (!edited.loaded) return {{"stages", Json::array()}, {"summary", ""}};
  return plan_json(session_.plan(edited.loaded->graph, {.keep_going = true, .sandbox = &sandbox_}));
}

}  // namespace terrazzo
