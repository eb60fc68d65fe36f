#include "runner/report/run_data.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "graphs/text/format.h"
#include "graphs/values/convert.h"

namespace terrazzo {

namespace {

using Json = nlohmann::ordered_json;

Json json_from(const ParamValue& value) {
  return Json::parse(compact(json_of(value)), nullptr, false);
}

bool is_default(const GraphNode& node, const std::string& name, const ParamValue& value) {
  const Param* param = node.type->find_param(name);
  return param && param->fallback && *param->fallback == value;
}

Json settings_json(const Graph& graph) {
  Json out = Json::array();
  for (const GraphSetting& s : graph.settings)
    out.push_back({{"name", s.name}, {"value", json_from(s.value)}, {"given", s.given}, {"help", s.help}});
  return out;
}

Json seeds_json(const Graph& graph) {
  Json out = Json::object();
  for (const GraphNode& n : graph.nodes)
    if (const auto seed = n.params.find("seed"); seed != n.params.end()) out[n.name] = json_from(seed->second);
  return out;
}

Json parameters_json(const GraphNode& node) {
  Json out = Json::array();
  for (const auto& [name, value] : node.params) {
    const Param* param = node.type->find_param(name);
    out.push_back({{"name", name},
                   {"value", json_from(value)},
                   {"text", text_of(value)},
                   {"unit", param ? param->unit : ""},
                   {"default", is_default(node, name, value)},
                   {"help", param ? param->help : ""}});
  }
  return out;
}

Json inputs_json(const GraphNode& node) {
  Json out = Json::object();
  for (const auto& [port, wires] : node.inputs)
    for (const Wire& w : wires) out[port].push_back(w.node + "." + w.port);
  return out;
}

Json node_json(const Stage& stage, const StageOutcome& outcome, const std::vector<NamedPicture>& pictures) {
  const GraphNode& node = *stage.node;
  Json files = Json::array(), shown = Json::array();
  for (const OutputFile& f : outcome.files) files.push_back(f.path.string());
  for (const NamedPicture& p : pictures) shown.push_back({{"id", p.id}, {"caption", p.caption}});
  return {{"name", node.name},
          {"type", node.type->name},
          {"summary", node.type->summary},
          {"comment", node.comment},
          {"state", what_it_did(stage, outcome)},
          {"reason", reason_of(stage, outcome)},
          {"seconds", outcome.seconds},
          {"parameters", parameters_json(node)},
          {"inputs", inputs_json(node)},
          {"notes", outcome.notes},
          {"files", files},
          {"pictures", shown}};
}

Json material_json(const LitMaterial& lit) {
  const Size size = lit.material->size();
  const ImagePtr normal = lit.material->find(Semantic::normal);
  const bool is_down = normal && normal->info().normal_y == NormalY::down;
  return {{"title", lit.title},
          {"width", size.width},
          {"height", size.height},
          {"normal_y", is_down ? "down" : "up"},
          {"maps", lit.maps}};
}

}  // namespace

std::string_view what_it_did(const Stage& stage, const StageOutcome& outcome) {
  constexpr std::array<std::string_view, 6> names = {"not asked for", "cached", "run", "failed", "not run", "skipped"};
  if (!stage.needed) return "not needed";
  if (outcome.kind == StageOutcome::Kind::reused && stage.type().is_sink()) return "up to date";
  return names[static_cast<size_t>(outcome.kind)];
}

const std::string& reason_of(const Stage& stage, const StageOutcome& outcome) {
  return outcome.reason.empty() ? stage.reason : outcome.reason;
}

std::string settings_text(const GraphNode& node) {
  std::vector<std::string> parts;
  for (const auto& [name, value] : node.params)
    if (!is_default(node, name, value)) parts.push_back(name + " " + text_of(value));
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string run_as_json(const Plan& plan, const RunResult& result,
                        const std::map<std::string, std::vector<NamedPicture>>& pictures,
                        const std::vector<LitMaterial>& materials) {
  Json nodes = Json::array(), lit = Json::array(), failures = Json::array();
  for (size_t i = 0; i < plan.stages.size(); i++) {
    const auto shown = pictures.find(plan.stages[i].node->name);
    nodes.push_back(node_json(plan.stages[i], result.stages[i],
                              shown == pictures.end() ? std::vector<NamedPicture>() : shown->second));
  }
  for (const LitMaterial& m : materials) lit.push_back(material_json(m));
  for (const Failure& f : result.failures) failures.push_back({{"node", f.node}, {"message", f.message}});
  const Json out = {{"program", "terrazzo " TERRAZZO_VERSION},
                    {"graph", plan.graph->file.string()},
                    {"summary", plan.graph->summary},
                    {"ok", result.ok()},
                    {"seconds", result.seconds},
                    {"settings", settings_json(*plan.graph)},
                    {"seeds", seeds_json(*plan.graph)},
                    {"nodes", nodes},
                    {"failures", failures},
                    {"materials", lit}};
  return out.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace terrazzo
