#include "runner/editor/previews/previews.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>

#include <nlohmann/json.hpp>

#include "runner/editor/previews/run_events.h"
#include "runner/editor/previews/shown_values.h"
#include "runner/report/pictures.h"

namespace terrazzo {

namespace {

constexpr int least_coarse_side = 16;

bool has_to_run(const Stage& stage) {
  return stage.state == StageState::run || stage.state == StageState::depends;
}

/// For every stage of a plan, whether it or anything behind it has to run.
std::vector<bool> waits_for_runs(const Plan& plan) {
  std::vector<bool> out(plan.stages.size());
  for (size_t i = 0; i < plan.stages.size(); i++) {  // sources come first
    out[i] = has_to_run(plan.stages[i]);
    if (plan.stages[i].loadable()) continue;
    for (const int source : plan.stages[i].sources) out[i] = out[i] || out[size_t(source)];
  }
  return out;
}

bool depends_on(const Plan& plan, size_t stage, size_t source) {
  std::vector<size_t> open = {stage};
  std::vector<bool> seen(plan.stages.size());
  for (size_t i = 0; i < open.size(); i++) {
    if (open[i] == source) return true;
    for (const int s : plan.stages[open[i]].sources)
      if (!seen[size_t(s)]) {
        seen[size_t(s)] = true;
        open.push_back(size_t(s));
      }
  }
  return false;
}

std::vector<std::string> names_in(const std::vector<PreviewTarget>& targets) {
  std::vector<std::string> out;
  for (const PreviewTarget& t : targets)
    if (std::ranges::find(out, t.node) == out.end()) out.push_back(t.node);
  return out;
}

}  // namespace

Previews::Previews(Session& session, const Sandbox& sandbox, PictureBoard& board, PublishEvent publish)
    : session_(session), sandbox_(sandbox), board_(board), publish_(std::move(publish)) {}

PreviewTargets Previews::targets_of(const EditedGraph& edited, const std::string& text,
                                    const std::vector<Wish>& wishes) {
  const Graph& graph = edited.loaded->graph;
  std::vector<PreviewTarget> all;
  for (const Wish& wish : wishes) {
    const std::optional<std::string> name = graph_node_of(graph, text, wish.at);
    const GraphNode* node = name ? graph.find(*name) : nullptr;
    if (!node || node->is_open || node->fails || node->type->outputs.empty() || node->type->is_sink()) continue;
    all.push_back({wish, *name, recipe_of(graph, *name)});
  }
  PreviewTargets out;
  if (all.empty()) return out;
  const std::vector<std::string> names = names_in(all);
  const Plan plan = session_.plan(graph, {.only = names, .keep = names, .keep_going = true, .sandbox = &sandbox_});
  const std::vector<bool> waits = waits_for_runs(plan);
  const auto place = [&](const PreviewTarget& t) {
    return size_t(std::ranges::find(graph.nodes, t.node, &GraphNode::name) - graph.nodes.begin());
  };
  std::vector<std::pair<size_t, PreviewTarget>> slow;
  for (PreviewTarget& t : all) {
    const size_t at = place(t);
    const std::optional<Resolution>& known = plan.stages[at].known;
    if (known && !known->names.empty() && board_.confirm(t.wish, known->names)) continue;
    if (waits[at])
      slow.emplace_back(at, std::move(t));
    else
      out.ready.push_back(std::move(t));
  }
  // What is looked at comes first, but for what it is made of, which is on the way.
  const auto looked = std::ranges::find_if(slow, [](const auto& s) { return s.second.wish.is_looked_at; });
  const size_t looked_at = looked == slow.end() ? graph.nodes.size() : looked->first;
  std::ranges::sort(slow, {}, &std::pair<size_t, PreviewTarget>::first);
  std::stable_partition(slow.begin(), slow.end(), [&](const auto& s) {
    return looked_at < graph.nodes.size() && depends_on(plan, looked_at, s.first);
  });
  for (auto& [at, target] : slow) out.slow.push_back(std::move(target));
  return out;
}

bool Previews::show_kept(const RunResult& result, const std::vector<PreviewTarget>& targets,
                         const std::atomic<bool>& cancelled) {
  bool is_shown = true;
  for (const PreviewTarget& t : targets) {
    const auto kept = result.kept.find(t.node);
    if (kept == result.kept.end()) continue;
    for (const auto& [output, value] : kept->second) try {
        board_.show(t.wish, output, value, cancelled);
      } catch (const Cancelled&) {
        throw;
      } catch (const Error& e) {
        is_shown = false;
        publish_("failed", {{"node", t.node}, {"message", e.what()}}, false);
      }
  }
  return is_shown;
}

void Previews::show_ready(const EditedGraph& edited, const std::vector<PreviewTarget>& targets,
                          const std::atomic<bool>& cancelled) {
  if (targets.empty()) return;
  RunEvents events(publish_, edited.is_part);
  const std::vector<std::string> names = names_in(targets);
  const RunResult result = session_.run(edited.loaded->graph, {.only = names,
                                                               .keep = names,
                                                               .keep_going = true,
                                                               .sandbox = &sandbox_,
                                                               .observer = &events,
                                                               .cancelled = &cancelled});
  show_kept(result, targets, cancelled);
}

/// Shows the levels of a uv map as they are made, in a thread of its own: the one that makes them goes on.
class Previews::CoarseLook {
 public:
  CoarseLook(Previews& owner, const Graph& graph, const std::vector<PreviewTarget>& targets, GracePeriod& time)
      : owner_(owner), graph_(graph), targets_(targets), time_(time), thread_([this] { work(); }) {}
  ~CoarseLook() { stop(); }
  CoarseLook(const CoarseLook&) = delete;
  CoarseLook& operator=(const CoarseLook&) = delete;

  /// Of several levels, the last is shown.
  void add(const Stage& stage, const UvMapPtr& coarse) {
    if (std::min(coarse->size().width, coarse->size().height) < least_coarse_side) return;
    {
      const std::lock_guard lock(mutex_);
      next_ = {stage.node->name, stage.shape.size ? *stage.shape.size : coarse->size(), coarse};
    }
    changed_.notify_one();
  }
  /// Shows nothing any more.
  void stop() {
    {
      const std::lock_guard lock(mutex_);
      stops_ = true;
    }
    changed_.notify_one();
    if (thread_.joinable()) thread_.join();
  }

 private:
  /// The run, and with it the stage, may end before it is shown.
  struct Level {
    std::string maker{};
    Size full{};
    UvMapPtr coarse{};
  };
  void work() {
    std::unique_lock lock(mutex_);
    for (;;) {
      changed_.wait(lock, [&] { return stops_ || next_.coarse; });
      if (stops_) return;
      const Level level = std::exchange(next_, {});
      lock.unlock();
      try {
        show(level.maker, level.full, *level.coarse);
      } catch (const std::exception&) {
        // The true picture will come.
      }
      lock.lock();
    }
  }

  /// Of the material that shows a uv map; null as long as it is not known.
  ImagePtr exemplar_for(const std::string& maker) {
    ImagePtr& picture = exemplars_[maker];
    const std::optional<Wire> wire = picture ? std::nullopt : exemplar_of(graph_, maker);
    if (wire) picture = owner_.exemplars_.find(graph_, *wire, owner_.session_, owner_.sandbox_, time_.cancelled());
    return picture;
  }

  void show(const std::string& maker, Size full, const UvMap& coarse) {
    ImagePtr resolved;
    for (const PreviewTarget& t : targets_) {
      const bool shows_uv = t.node == maker;
      if (time_.cancelled() || (!shows_uv && !resolves(graph_, t.node, maker))) continue;
      if (!shows_uv && !resolved)
        if (const ImagePtr exemplar = exemplar_for(maker)) resolved = resolved_coarsely(coarse, *exemplar);
      const ImagePtr picture = shows_uv || !resolved ? uv_in_colours(coarse, t.wish.side) : resolved;
      const ImagePtr display = shrunk_for_display(picture, t.wish.side);
      const std::lock_guard lock(mutex_);
      if (stops_) return;
      owner_.board_.show_coarse(t.wish, graph_.find(t.node)->type->outputs.front(), display, full, time_.cancelled());
      if (t.wish == targets_.front().wish) time_.shown();
    }
  }

  Previews& owner_;
  const Graph& graph_;
  const std::vector<PreviewTarget>& targets_;
  GracePeriod& time_;
  std::map<std::string, ImagePtr> exemplars_;  // by the node that makes the uv map
  std::mutex mutex_;
  std::condition_variable changed_;
  Level next_;
  bool stops_ = false;
  std::thread thread_;
};

bool Previews::make(const EditedGraph& edited, const std::vector<PreviewTarget>& targets, GracePeriod& time) {
  const Graph& graph = edited.loaded->graph;
  const PreviewTarget& target = targets.front();
  RunRequest request{.only = {target.node},
                     .keep = {target.node},
                     .keep_going = true,
                     .sandbox = &sandbox_,
                     .cancelled = &time.cancelled()};
  Plan plan = session_.plan(graph, request);
  std::optional<CoarseLook> look;
  RunEvents::Coarse coarse;
  if (std::ranges::any_of(plan.stages, may_be_previewed)) {
    look.emplace(*this, graph, targets, time);
    coarse = [&look](const Stage& s, const UvMapPtr& uv) { look->add(s, uv); };
  }
  RunEvents events(publish_, edited.is_part, std::move(coarse));
  request.observer = &events;
  const RunResult result = session_.run(std::move(plan), request);
  look.reset();
  if (result.cancelled) throw Cancelled();
  return show_kept(result, {target}, time.cancelled()) && result.failures.empty();
}

}  // namespace terrazzo
