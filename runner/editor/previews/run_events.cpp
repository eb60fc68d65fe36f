#include "runner/editor/previews/run_events.h"

#include "core/base/text.h"

namespace terrazzo {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::chrono::milliseconds between_progress{100};

/// "graph.json:3:5: node ..." without what is in front of the node.
std::string without_place(const std::string& message) {
  const size_t at = message.find("node \"");
  return at == std::string::npos ? message : message.substr(at);
}

}  // namespace

RunEvents::RunEvents(PublishEvent publish, bool is_part, Coarse coarse)
    : publish_(std::move(publish)), is_part_(is_part), coarse_(std::move(coarse)) {}

void RunEvents::tell(const char* event, const Stage& s, const Json& more) {
  Json data = {{"node", s.node->name}};
  data.update(more);
  publish_(event, data, false);
}

void RunEvents::started(const Stage& s) {
  tell("start", s);
}

void RunEvents::waits(const Stage& s) {
  tell("wait", s);
}

void RunEvents::progressed(const Stage& s, double fraction) {
  {
    const std::lock_guard lock(mutex_);
    auto& last = last_progress_[&s];
    const auto now = std::chrono::steady_clock::now();
    if (now - last < between_progress) return;
    last = now;
  }
  tell("progress", s, {{"fraction", fraction}});
}

void RunEvents::previewed(const Stage& s, const UvMapPtr& coarse) {
  coarse_(s, coarse);
}

void RunEvents::noted(const Stage& s, const std::string& message) {
  const bool warning = is_warning(message);
  tell("note", s, {{"message", warning ? message.substr(warning_mark.size()) : message}, {"warning", warning}});
}

void RunEvents::finished(const Stage& s, double seconds) {
  tell("done", s, {{"seconds", seconds}});
}

void RunEvents::reused(const Stage& s) {
  tell("cached", s);
}

void RunEvents::failed(const Stage& s, const std::string& message) {
  tell("failed", s, {{"message", is_part_ ? without_place(message) : message}});
}

void RunEvents::skipped(const Stage& s, const std::string& because) {
  tell("skipped", s, {{"because", because}});
}

Json plan_json(const Plan& plan) {
  Json stages = Json::array();
  for (const Stage& s : plan.stages) {
    Json stage = {{"node", s.node->name},
                  {"type", s.type().name},
                  {"state", name_of(s.state)},
                  {"reason", s.reason},
                  {"seconds", s.expected_seconds}};
    if (s.shape.size) stage["size"] = {s.shape.size->width, s.shape.size->height};
    if (!s.faults.empty()) stage["fault"] = s.faults.front();
    stages.push_back(std::move(stage));
  }
  return {{"stages", std::move(stages)}, {"summary", plan.summary()}};
}

}  // namespace terrazzo
