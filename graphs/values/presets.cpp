#include "graphs/values/presets.h"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

#include "core/base/suggest.h"
#include "graphs/text/read_document.h"

namespace terrazzo {

namespace fs = std::filesystem;

namespace {

class PresetReader {
 public:
  PresetReader(const fs::path& base, const std::string& where, bool in_graph, std::vector<Problem>& problems)
      : base_(base), file_(where), in_graph_(in_graph), problems_(problems) {}

  Preset read(const JsonMember& member) {
    Preset out{member.name, "", {}};
    const std::string where = (in_graph_ ? "" : file_ + ": ") + "preset " + in_quotes(member.name);
    const auto report = [&](Place place, const std::string& message) {
      if (in_graph_)
        problems_.push_back({place, where, message});
      else
        problems_.push_back({{}, fmt::format("{}:{}:{}", file_, place.line, place.column), message});
    };
    if (!member.value.is_object()) {
      report(member.value.place,
             "expected an object such as {\"help\": \"...\", \"set\": {\"seed\": 3}}, found " + found(member.value));
      return out;
    }
    static const std::vector<std::string> keys = {"help", "set"};
    for (const JsonMember& m : member.value.members) {
      if (m.name == "set") {
        out.set = read_override_object(m.value, base_, in_graph_ ? where : file_, in_graph_, problems_);
      } else if (m.name != "help") {
        report(m.place, fmt::format("unknown key {}{}", in_quotes(m.name), suggestion(m.name, keys)));
      } else if (m.value.is_text()) {
        out.help = m.value.text;
      } else {
        report(m.value.place, "expected a text for \"help\", found " + found(m.value));
      }
    }
    return out;
  }

 private:
  const fs::path& base_;
  const std::string& file_;
  const bool in_graph_;
  std::vector<Problem>& problems_;
};

const std::string& name_in(const std::string& name) {
  return name;
}
template <typename T>
const std::string& name_in(const std::pair<const std::string, T>& named) {
  return named.first;
}

}  // namespace

std::vector<Preset> read_presets(const JsonValue& section, const fs::path& base, const std::string& where,
                                 bool in_graph, std::vector<Problem>& problems) {
  std::vector<Preset> out;
  if (!section.is_object())
    problems.push_back({in_graph ? section.place : Place{}, in_graph ? "\"presets\"" : where,
                        "expected an object of presets by name, found " + found(section)});
  PresetReader reader(base, where, in_graph, problems);
  for (const JsonMember& m : section.members) out.push_back(reader.read(m));
  return out;
}

std::vector<Preset> presets_beside(const fs::path& graph, std::vector<Problem>& problems) {
  fs::path file = graph;
  file.replace_extension(".presets.json");
  std::error_code missing;
  if (graph.empty() || !fs::exists(file, missing)) return {};
  const std::optional<JsonValue> json = read_json_document(file, "file of presets", problems);
  if (!json) return {};
  return read_presets(*json, fs::absolute(file).parent_path(), file.string(), false, problems);
}

std::vector<Override> chosen_presets(const std::vector<Preset>& presets, const std::vector<std::string>& names,
                                     std::vector<Problem>& problems) {
  std::vector<Override> out;
  std::vector<std::string> known;
  for (const Preset& p : presets) known.push_back(p.name);
  for (const std::string& name : names) {
    const auto at = std::ranges::find(presets, name, &Preset::name);
    if (at == presets.end()) {
      const std::string hint = known.empty() ? "; it has none" : suggestion(name, known);
      problems.push_back({{}, "--preset " + name, "the graph has no preset of that name" + hint});
    } else {
      out.insert(out.end(), at->set.begin(), at->set.end());
    }
  }
  return out;
}

void check_targets(const std::vector<const Preset*>& presets, const std::vector<GraphParameter>& parameters,
                   const NodeTypes& nodes, std::vector<Problem>& problems) {
  std::set<std::string> parameter_names;
  std::map<std::string, const NodeType*> types;
  for (const GraphParameter& p : parameters) parameter_names.insert(p.param.name);
  for (const auto& [name, type] : nodes) types.emplace(name, type);
  size_t hints = 0;
  const auto refuse = [&](const Override& o, const std::string& what, const std::string& name, const auto& known) {
    std::vector<std::string> names;
    if (hints++ < most_problems_shown)
      for (const auto& k : known) names.push_back(name_in(k));
    o.diagnostics(problems).add(o.place, fmt::format("{} {}{}", what, in_quotes(name), suggestion(name, names)));
  };
  const auto check = [&](const Override& o) {
    if (o.node.empty()) {
      if (!parameter_names.contains(o.name)) refuse(o, "the graph has no parameter", o.name, parameter_names);
      return;
    }
    if (o.node.find_first_of("/[") != o.node.npos) return;  // not known before subgraphs and loops have been read
    const auto node = types.find(o.node);
    if (node == types.end()) return refuse(o, "the graph has no node", o.node, types);
    const NodeType* type = node->second;
    if (!type || type->find_input(o.name) || type->find_param(o.name)) return;
    std::vector<std::string> known;
    for (const Port& port : type->inputs) known.push_back(port.name);
    for (const Param& param : type->params) known.push_back(param.name);
    refuse(o, type->name + " has no port or parameter", o.name, known);
  };
  for (const Preset* preset : presets) std::ranges::for_each(preset->set, check);
}

}  // namespace terrazzo
