#include <algorithm>

#include <fmt/format.h>

#include "graphs/document/subgraphs.h"
#include "graphs/text/edit.h"
#include "graphs/text/format.h"
#include "graphs/text/migrate.h"
#include "graphs/values/convert.h"
#include "nodes/common/registry.h"
#include "runner/api/job.h"

namespace terrazzo {

namespace fs = std::filesystem;

namespace {

/// The changes of a job's values to its document.
using Path = std::vector<std::string>;

/// The parts of an override's name: "seed", "lattice.mode", "weighted.weights.height".
Path path_of(const JobOutline& outline, const std::string& name) {
  Path parts;
  for (size_t begin = 0; begin <= name.size();) {
    const size_t end = std::min(name.find('.', begin), name.size());
    parts.push_back(name.substr(begin, end - begin));
    begin = end + 1;
  }
  const bool is_parameter =
      parts.size() == 1 ||
      (std::ranges::find(outline.nodes, parts.front(), &JobNode::name) == outline.nodes.end() &&
       std::ranges::any_of(outline.parameters, [&](const JobParameter& p) { return p.param.name == parts.front(); }));
  parts.insert(parts.begin(), is_parameter ? "parameters" : "nodes");
  if (is_parameter) parts.insert(parts.begin() + 2, "default");
  return parts;
}

/// The declaration of a path; null if unknown.
const Param* param_at(const JobOutline& outline, const Path& path) {
  if (path.size() != 3) return nullptr;
  if (path.front() == "parameters") {
    for (const JobParameter& p : outline.parameters)
      if (p.param.name == path[1]) return &p.param;
    return nullptr;
  }
  const auto node = std::ranges::find(outline.nodes, path[1], &JobNode::name);
  if (node == outline.nodes.end()) return nullptr;
  const auto param = std::ranges::find(node->params, path[2], &Param::name);
  return param == node->params.end() ? nullptr : &*param;
}

const JsonValue* value_at(const JsonValue& document, const Path& path) {
  const JsonValue* at = &document;
  for (const std::string& name : path)
    if (!(at = at->find(name))) break;
  return at;
}

/// Formats a value for the document. Members of maps, wires and the like have no descriptor.
JsonValue json_for(const std::string& value, const Param* param) {
  if (param) return read_command_line(value, *param);
  ParsedJson parsed = parse_json(value);
  return parsed.value ? std::move(*parsed.value) : JsonValue::of(value);
}

/// Rewrites a relative path for another folder.
void move_path(JsonValue& value, const fs::path& folder) {
  if (!value.is_text() || value.text.empty() || std::string_view("=$@").find(value.text.front()) != std::string::npos ||
      value.text.starts_with("library:") || fs::path(value.text).is_absolute())
    return;
  const fs::path place = fs::absolute(value.text).lexically_normal();
  const fs::path inside = place.lexically_relative(fs::absolute(folder).lexically_normal());
  value.text = inside.empty() || inside.begin()->string() == ".." ? place.string() : inside.string();
}

}  // namespace

JobOutline Job::outline() const {
  JobOutline out;
  ParsedJson parsed = parse_json(text_);
  std::vector<Problem> ignored;
  if (!parsed.value || !migrate(*parsed.value, document_migrations(), ignored)) return out;
  const JsonValue document = std::move(*parsed.value);
  const KnownTypes types(node_types());
  Subgraphs subgraphs(types, document_migrations(), ignored);
  const Subgraph& main = subgraphs.read_main(document, fs::absolute(path_));
  for (const GraphParameter& p : main.parameters) out.parameters.push_back({p.param, p.group, p.value});
  const JsonValue* nodes = document.find("nodes");
  if (!nodes) return out;
  for (const JsonMember& m : nodes->members) {
    JobNode& node = out.nodes.emplace_back();
    node.name = m.name;
    const JsonValue* type = m.value.find("type");
    if (type) node.type = type->text;
    const auto* source = main.find_source(m.name);
    node.is_known = source && source->second;
    if (!node.is_known) continue;
    node.params = source->second->params;
    node.inputs = source->second->inputs;
    node.outputs = source->second->outputs;
  }
  return out;
}

std::optional<std::string> Job::value_of(const std::string& name) const {
  const JobOutline all = outline();
  const Path path = path_of(all, name);
  for (const auto& [set, value] : values_)
    if (set == name) return compact(json_for(value, param_at(all, path)));
  const ParsedJson parsed = parse_json(text_);
  const JsonValue* value = parsed.value ? value_at(*parsed.value, path) : nullptr;
  return value ? std::optional(compact(*value)) : std::nullopt;
}

std::string Job::pointer_to(const Problem& problem) const {
  if (!problem.file.empty()) return "";
  if (problem.place.line > 0) {
    const ParsedJson parsed = parse_json(text_);
    return parsed.value ? terrazzo::pointer_to(*parsed.value, problem.place) : "";
  }
  if (!problem.override_position || *problem.override_position >= values_.size()) return "";
  std::string out;
  for (const std::string& step : path_of(outline(), values_[*problem.override_position].first)) {
    out += '/';
    for (const char c : step) out += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
  }
  return out;
}

std::string Job::text(const fs::path& folder) const {
  const JobOutline all = outline();
  std::string out = text_;
  for (const auto& [name, value] : values_) {
    const Path path = path_of(all, name);
    const bool is_node = path.front() == "nodes";
    if (is_node && std::ranges::find(all.nodes, path[1], &JobNode::name) == all.nodes.end())
      throw Error(name, fmt::format("\"{}\" cannot be written: the document has no node \"{}\"", name, path[1]));
    const ParsedJson parsed = parse_json(out);
    if (!is_node && parsed.value && !value_at(*parsed.value, {"parameters", path[1]}))
      throw Error(name, fmt::format("\"{}\" cannot be written: the document has no such parameter", name));
    const Param* param = param_at(all, path);
    JsonValue json = json_for(value, param);
    if (param && param->type == ParamType::path) move_path(json, folder);
    out = with_value(out, path, json);
  }
  return out;
}

}  // namespace terrazzo
