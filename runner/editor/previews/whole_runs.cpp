#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "runner/editor/previews/run_events.h"
#include "runner/editor/previews/runs.h"
#include "runner/report/pictures.h"

/// Runs of whole graphs, sinks included, beside what is made to be looked at.
namespace terrazzo {

namespace {

using WholeRunJson = nlohmann::ordered_json;

/// Loading it takes a while, which the first picture need not wait for.
void load_picture_module() {
  constexpr Size size{64, 64};
  const ImagePtr grey = Image::from_floats({.size = size, .channels = 3, .color_space = "srgb_texture"},
                                           std::vector<float>(size_t(size.area()) * 3, 0.5f));
  try {
    picture_file(*grey);
  } catch (const Error&) {
    // The first picture says why.
  }
}

}  // namespace

void Runs::run(std::vector<NodeOfDocument> nodes, bool sinks) {
  {
    const std::lock_guard lock(mutex_);
    asked_ = Asked{std::move(nodes), sinks};
    run_cancelled_ = true;
  }
  changed_.notify_all();
}

void Runs::full_loop() {
  load_picture_module();
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [&] { return stops_ || asked_; });
    if (stops_) return;
    const Asked asked = *std::exchange(asked_, std::nullopt);
    const std::string text = text_;
    const std::filesystem::path file = file_;
    run_cancelled_ = false;
    runs_ = true;
    lock.unlock();
    try {
      run_fully(asked, text, file);
    } catch (const std::exception& e) {
      publish_("ran", {{"ok", false}, {"seconds", 0}, {"cancelled", false}, {"message", e.what()}}, false);
    }
    lock.lock();
    runs_ = false;
    // What it has computed can be shown.
    mark_dirty();
    changed_.notify_all();
  }
}

void Runs::run_fully(const Asked& asked, const std::string& text, const std::filesystem::path& file) {
  const EditedGraph edited = load_for_editing(text, file, asked.nodes, sandbox_);
  // A part of a graph might write other files than the whole.
  if (!edited.loaded || (asked.sinks && edited.is_part)) throw GraphError(file.string(), edited.problems);
  if (!edited.unset.empty() && (asked.sinks || asked.nodes.empty()))
    throw Error(fmt::format("{} {}", edited.unset.front().where, edited.unset.front().message));
  const Graph& graph = edited.loaded->graph;
  std::vector<std::string> names;
  for (const NodeOfDocument& n : asked.nodes) {
    const std::optional<std::string> inside = n.level.empty() ? n.node : graph_node_of(graph, text, n);
    if (!inside) throw Error(fmt::format("there is no node \"{}\"", n.node));
    names.push_back(*inside);
  }
  if (!asked.sinks) {
    names = without_sinks(graph, names);
    if (names.empty()) throw Error("there is nothing to run but what writes files");
  }
  RunEvents events(publish_, edited.is_part);
  const RunResult result = session_.run(
      graph,
      {.only = names, .keep_going = true, .sandbox = &sandbox_, .observer = &events, .cancelled = &run_cancelled_});
  WholeRunJson files = WholeRunJson::array();
  for (const StageOutcome& s : result.stages)
    for (const OutputFile& f : s.files) files.push_back(f.path.string());
  publish_("ran",
           {{"ok", result.ok()},
            {"seconds", result.seconds},
            {"cancelled", result.cancelled},
            {"summary", result.summary()},
            {"files", std::move(files)}},
           false);
}

}  // namespace terrazzo
