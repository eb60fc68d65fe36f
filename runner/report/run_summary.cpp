#include "runner/report/run_summary.h"

#include <algorithm>
#include <span>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/file/atomic_file.h"
#include "graphs/text/format.h"
#include "graphs/text/problem.h"
#include "graphs/values/convert.h"
#include "runner/report/process_usage.h"
#include "runner/report/run_data.h"

namespace terrazzo {

namespace {

using Json = nlohmann::ordered_json;

/// Raised when a member is removed or changes its meaning, but not when one is added.
constexpr int summary_version = 1;

std::string_view status_of(const RunSummary& s) {
  if (s.result && s.result->cancelled) return "cancelled";
  if (s.result) return s.result->ok() && !s.error ? "done" : "failed";
  return s.error ? "invalid" : "planned";
}

Json counts_json(const RunResult& r) {
  using Kind = StageOutcome::Kind;
  return {{"cached", r.count(Kind::reused)},
          {"run", r.count(Kind::run)},
          {"failed", r.count(Kind::failed)},
          {"skipped", r.count(Kind::skipped)},
          {"not_run", r.count(Kind::unfinished)}};
}

Json files_json(const StageOutcome& outcome) {
  Json files = Json::array();
  for (const OutputFile& f : outcome.files)
    files.push_back({{"path", f.path.string()}, {"bytes", f.bytes}, {"digest", f.content.hex()}});
  return files;
}

/// The bytes of a stage's results in the cache; equal results of two stages count for both.
uint64_t stored_bytes(const StageOutcome& outcome, const Cache* cache) {
  uint64_t bytes = 0;
  if (cache)
    for (const auto& [port, value] : outcome.outputs) bytes += cache->stored_bytes(value);
  return bytes;
}

Json notes_json(const StageOutcome& outcome) {
  Json notes = Json::array();
  for (const std::string& note : outcome.notes) {
    const bool warning = is_warning(note);
    notes.push_back({{"warning", warning}, {"message", warning ? note.substr(warning_mark.size()) : note}});
  }
  return notes;
}

/// Adds the variation of a node, unless several variations share it.
void add_variation(Json& out, const std::string& node, const RunSummary& s) {
  if (const auto at = s.variations.find(node); at != s.variations.end()) out["variation"] = at->second;
}

Json stage_json(const Stage& stage, const StageOutcome& outcome, const RunSummary& s) {
  Json out = {{"node", outcome.node},
              {"type", stage.type().name},
              {"version", stage.type().version},
              {"did", what_it_did(stage, outcome)},
              {"hit", outcome.kind == StageOutcome::Kind::reused},
              {"reason", reason_of(stage, outcome)},
              {"key", outcome.key ? Json(outcome.key->hex()) : Json()},
              {"seconds", outcome.seconds},
              {"stored_bytes", stored_bytes(outcome, s.cache)},
              {"files", files_json(outcome)},
              {"notes", notes_json(outcome)}};
  if (!outcome.because.empty()) out["because"] = outcome.because;
  add_variation(out, outcome.node, s);
  return out;
}

Json stages_json(const RunSummary& s) {
  Json out = Json::array();
  for (size_t i = 0; s.plan && s.result && i < s.plan->stages.size(); i++)
    out.push_back(stage_json(s.plan->stages[i], s.result->stages[i], s));
  return out;
}

Json problem_json(const std::string& graph, const Problem& p) {
  Json out = {{"message", describe(graph, p)}};
  if (!p.node.empty()) out["node"] = p.node;
  return out;
}

std::span<const Problem> shown(const std::vector<Problem>& problems) {
  return {problems.data(), std::min(problems.size(), most_problems_shown)};
}

Json failures_json(const RunSummary& s) {
  Json out = Json::array();
  if (s.result)
    for (const Failure& f : s.result->failures) {
      out.push_back({{"message", f.message}, {"node", f.node}});
      add_variation(out.back(), f.node, s);
    }
  if (const auto* graph = dynamic_cast<const GraphError*>(s.error)) {
    for (const Problem& p : shown(graph->problems())) {
      out.push_back(problem_json(graph->file(), p));
      add_variation(out.back(), p.node, s);
    }
    if (const std::string more = problems_not_shown(graph->problems().size()); !more.empty())
      out.push_back({{"message", more}});
  } else if (s.error) {
    out.push_back({{"message", s.error->what()}});
  }
  return out;
}

Json settings_json(const RunSummary& s) {
  Json out = Json::object();
  if (s.plan)
    for (const GraphSetting& g : s.plan->graph->settings)
      out[g.name] = Json::parse(compact(json_of(g.value)), nullptr, false);
  return out;
}

Json cache_json(const Cache* cache) {
  if (!cache) return nullptr;
  return {{"folder", cache->folder().string()}, {"limit", cache->limit()}};
}

}  // namespace

void write_run_summary(const RunSummary& s, const std::filesystem::path& path) {
  const ProcessUsage usage = process_usage();
  const Json out = {{"format", summary_version},
                    {"program", "terrazzo " TERRAZZO_VERSION},
                    {"graph", s.graph.string()},
                    {"status", status_of(s)},
                    {"exit_code", s.exit_code},
                    {"seconds", s.result ? s.result->seconds : 0},
                    {"cpu_seconds", usage.cpu_seconds},
                    {"peak_memory", usage.peak_memory},
                    {"cache", cache_json(s.cache)},
                    {"settings", settings_json(s)},
                    {"counts", s.result ? counts_json(*s.result) : counts_json({})},
                    {"stages", stages_json(s)},
                    {"failures", failures_json(s)},
                    {"warnings", s.warnings}};
  write_whole_file(path, out.dump(1, ' ', false, Json::error_handler_t::replace) + '\n');
}

}  // namespace terrazzo
