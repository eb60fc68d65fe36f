#include "runner/editor/previews/coarse_look.h"

#include <algorithm>
#include <set>

#include "runner/report/pictures.h"

namespace terrazzo {

namespace {

constexpr int exemplar_side = 512;
constexpr size_t most_exemplars = 16;
/// Beyond this a coarse look would come too late.
constexpr double longest_wait = 0.5;

bool is_picture(ValueType type) {
  return type == ValueType::material || type == ValueType::image;
}

/// The input through which a node reads a uv map of `maker`.
bool reads_uv_of(const GraphNode& node, const std::string& maker) {
  for (const auto& [port, wires] : node.inputs)
    for (const Wire& w : wires)
      if (w.node == maker && node.type->find_input(port)->type == ValueType::uv_map) return true;
  return false;
}

std::optional<Wire> picture_beside(const GraphNode& node) {
  for (const Port& p : node.type->inputs)
    if (const auto at = node.inputs.find(p.name); at != node.inputs.end() && is_picture(p.type) && !at->second.empty())
      return at->second.front();
  return std::nullopt;
}

ImagePtr main_image(const Value& value) {
  if (const ImagePtr* image = std::get_if<ImagePtr>(&value)) return *image;
  const MaterialPtr* material = std::get_if<MaterialPtr>(&value);
  if (!material) return nullptr;
  const ImagePtr colour = (*material)->find(Semantic::base_color);
  return colour ? colour : (*material)->maps().front().image;
}

}  // namespace

bool may_be_previewed(const Stage& stage) {
  return (stage.state == StageState::run || stage.state == StageState::depends) &&
         stage.type().category == "synthesis" &&
         std::ranges::any_of(stage.type().outputs, [](const Port& p) { return p.type == ValueType::uv_map; });
}

bool resolves(const Graph& graph, const std::string& node, const std::string& maker) {
  const GraphNode* reader = graph.find(node);
  return reader && reads_uv_of(*reader, maker) && picture_beside(*reader) && !reader->type->outputs.empty() &&
         is_picture(reader->type->outputs.front().type);
}

std::optional<Wire> exemplar_of(const Graph& graph, const std::string& node) {
  for (const GraphNode& n : graph.nodes)
    if (reads_uv_of(n, node))
      if (std::optional<Wire> beside = picture_beside(n)) return beside;
  std::vector<const GraphNode*> open = {graph.find(node)};
  std::set<std::string> seen;
  for (size_t i = 0; i < open.size(); i++)
    for (const auto& [port, wires] : open[i]->inputs)
      for (const Wire& w : wires) {
        if (!seen.insert(w.node).second) continue;
        const GraphNode* behind = graph.find(w.node);
        const Port* output = behind->type->find_output(w.port);
        if (behind->type->category == "source" && output && is_picture(output->type)) return w;
        open.push_back(behind);
      }
  return std::nullopt;
}

ImagePtr ExemplarPictures::find(const Graph& graph, const Wire& exemplar, Session& session, const Sandbox& sandbox,
                                const std::atomic<bool>& cancelled) {
  const RunRequest request{.only = {exemplar.node},
                           .keep = {exemplar.node},
                           .look_ahead = false,
                           .sandbox = &sandbox,
                           .cancelled = &cancelled};
  const Plan plan = session.plan(graph, request);
  double seconds = 0;
  const Stage* stage = nullptr;
  for (const Stage& s : plan.stages) {
    if (s.state == StageState::run || s.state == StageState::depends)
      if (s.type().persist == Persist::payload) seconds += s.expected_seconds;
    if (s.node->name == exemplar.node) stage = &s;
  }
  if (stage && stage->known) {
    const auto name = stage->known->names.find(exemplar.port);
    const std::lock_guard lock(mutex_);
    const auto at = name == stage->known->names.end() ? pictures_.end() : pictures_.find(name->second);
    if (at != pictures_.end()) return at->second;
  }
  if (seconds > longest_wait) return nullptr;
  const RunResult result = session.run(plan, request);
  const auto kept = result.kept.find(exemplar.node);
  if (kept == result.kept.end() || !kept->second.contains(exemplar.port)) return nullptr;
  const Value& value = kept->second.at(exemplar.port);
  const ImagePtr image = main_image(value);
  if (!image) return nullptr;
  const Task task(&cancelled, {});
  const CurrentTask scope(task);
  ImagePtr picture = shrunk_for_display(image, exemplar_side);
  const std::lock_guard lock(mutex_);
  if (pictures_.size() >= most_exemplars) pictures_.erase(pictures_.begin());
  pictures_[digest_of(value)] = picture;
  return picture;
}

}  // namespace terrazzo
