#include "runner/plan/plan.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/text.h"
#include "runner/plan/history.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

/// How a sink's files differ from what it wrote; empty if they do not.
std::string trouble_with_files(const StageRecord& record, Cache* cache) {
  for (const OutputFile& f : record.files) {
    std::error_code missing;
    const uint64_t bytes = fs::file_size(f.path, missing);
    if (missing) return fmt::format("output file {} is missing", f.path.string());
    if (bytes != f.bytes || cache->file_digest(f.path) != f.content)
      return fmt::format("output file {} was changed since", f.path.string());
  }
  return "";
}

std::string why_new(const Stage& stage, const Resolution& r, const Cache* cache, const History* history) {
  if (!cache) return "no cache is used";
  const std::string difference = history ? history->first_difference(stage.node->name, r.ingredients) : "";
  return difference.empty() ? "never run before with these inputs and parameters" : difference;
}

std::string why_must_run(const Stage& stage, const Resolution& r, Cache* cache, const History* history) {
  const NodeType& type = stage.type();
  if (r.record) {
    if (type.is_sink()) return trouble_with_files(*r.record, cache);
    return stage.target && type.persist == Persist::payload && !r.stored ? "its stored result is gone" : "";
  }
  // A lazy stage has names without running; it runs for a reader, or because it is a target.
  return r.names.empty() || stage.target ? why_new(stage, r, cache, history) : "";
}

}  // namespace

std::string_view name_of(StageState state) {
  constexpr std::array<std::string_view, 6> names = {"not needed", "cached", "up to date", "derived", "depends", "run"};
  return names[static_cast<size_t>(state)];
}

bool is_complete(const StageRecord& record, const NodeType& type) {
  return std::all_of(type.outputs.begin(), type.outputs.end(),
                     [&](const Port& p) { return record.outputs.count(p.name) == 1; });
}

Digest digest_of_file(Cache* cache, const fs::path& path) {
  return cache ? cache->file_digest(path) : file_content_digest(path);
}

std::map<std::string, Digest> names_of(const NodeType& type, const Digest& key,
                                       const std::map<std::string, Value>& values) {
  std::map<std::string, Digest> names;
  for (const Port& p : type.outputs)
    names[p.name] = type.persist == Persist::derived ? derived_name(key, p.name) : digest_of(values.at(p.name));
  return names;
}

Resolution resolve(const Plan& plan, int index, Cache* cache, const History* history) {
  const Stage& stage = plan.stages[index];
  InputNames inputs;
  std::map<std::string_view, int> sources;
  for (const int source : stage.sources) sources[plan.stages[source].node->name] = source;
  for (const auto& [port, wires] : stage.node->inputs)
    for (const Wire& w : wires) inputs[port].push_back(plan.stages[sources.at(w.node)].known->names.at(w.port));

  Resolution r;
  r.ingredients =
      ingredients_of(*stage.node, inputs, [&](const fs::path& file) { return digest_of_file(cache, file); });
  r.key = key_of(r.ingredients);
  if (cache) r.record = cache->find_stage(r.key);
  if (r.record && !is_complete(*r.record, stage.type())) r.record.reset();
  if (r.record) r.names = r.record->outputs;
  if (!r.record && stage.type().persist == Persist::derived) r.names = names_of(stage.type(), r.key, {});
  if (r.record && stage.type().persist == Persist::payload)
    r.stored = std::all_of(stage.used_outputs.begin(), stage.used_outputs.end(),
                           [&](const std::string& port) { return cache->has_value(r.names.at(port)); });
  r.must_run = why_must_run(stage, r, cache, history);
  return r;
}

int Plan::count(StageState state) const {
  return static_cast<int>(
      std::count_if(stages.begin(), stages.end(), [&](const Stage& s) { return s.state == state; }));
}

std::string Plan::summary() const {
  std::vector<std::string> parts;
  const auto add = [&](StageState state, std::string_view what) {
    if (count(state) > 0) parts.push_back(fmt::format("{} {}", count(state), what));
  };
  add(StageState::cached, "cached");
  add(StageState::up_to_date, "up to date");
  add(StageState::derived, "derived");
  add(StageState::run, "to run");
  add(StageState::depends, "undecided until earlier stages have run");
  return fmt::format("{}: {}", counted(needed(), "stage"), fmt::join(parts, ", "));
}

std::string Plan::table() const {
  std::vector<std::array<std::string, 6>> rows = {{"node", "type", "shape", "state", "key", "why"}};
  for (const Stage& s : stages)
    rows.push_back({s.node->name, s.type().name, describe(s.shape), std::string(name_of(s.state)),
                    s.known ? s.known->key.hex().substr(0, 8) : "-", s.reason});
  std::array<size_t, 6> widths{};
  for (const auto& row : rows)
    for (size_t i = 0; i < row.size(); i++) widths[i] = std::max(widths[i], row[i].size());
  std::string out = summary() + "\n";
  for (const auto& row : rows) {
    std::string line;
    for (size_t i = 0; i < row.size(); i++) line += fmt::format("  {:<{}}", row[i], widths[i]);
    out += line.erase(line.find_last_not_of(' ') + 1) + "\n";
  }
  return out;
}

}  // namespace terrazzo
