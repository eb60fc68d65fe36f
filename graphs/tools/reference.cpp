#include "graphs/tools/reference.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "graphs/text/format.h"
#include "graphs/tools/descriptor_json.h"
#include "graphs/values/convert.h"

namespace terrazzo {

namespace {

constexpr size_t page_width = 80;

/// Breaks text at its spaces; line breaks in it stay. The first line begins with `first`, the others with as many
/// spaces as `indent`.
std::string wrapped(const std::string& text, const std::string& first, size_t indent) {
  std::string out = first;
  size_t column = first.size();
  bool at_start = true;
  for (size_t at = 0; at < text.size();) {
    if (text[at] == '\n' || text[at] == ' ') {
      if (text[at] == '\n') {
        out += '\n' + std::string(indent, ' ');
        column = indent;
        at_start = true;
      }
      at++;
      continue;
    }
    const size_t end = std::min(text.find_first_of(" \n", at), text.size());
    const size_t length = end - at;
    if (!at_start && column + 1 + length > page_width) {
      out += '\n' + std::string(indent, ' ');
      column = indent;
    } else if (!at_start) {
      out += ' ';
      column++;
    }
    out += text.substr(at, length);
    column += length;
    at_start = false;
    at = end;
  }
  return out + '\n';
}

std::string described(const std::string& name, const std::string& kind, const std::string& help) {
  return wrapped(kind, fmt::format("  {}: ", name), 6) + (help.empty() ? "" : wrapped(help, "      ", 6));
}

std::string described_port(const Port& p) {
  return described(
      p.name, fmt::format("{}{}{}", p.list ? "list of " : "", name_of(p.type), p.optional ? ", optional" : ""), p.help);
}

std::string described_param(const Param& p) {
  const std::string taken =
      p.type == ParamType::choice ? fmt::format("one of {}", fmt::join(p.choices, ", ")) : expectation(p);
  const std::string fallback = p.fallback ? "default " + compact(json_of(*p.fallback)) : "must be given";
  return described(p.name, taken + "; " + fallback, p.help);
}

std::string described_parameter(const GraphParameter& p) {
  Param param = p.param;
  if (p.formula) param.fallback = ParamValue(p.formula->text.text);
  std::string out = described_param(param);
  if (p.visible_if) out += wrapped("only if " + p.visible_if->text.substr(1), "      ", 6);
  return out;
}

std::string described_step(const NodeStep& s) {
  return described(s.name, s.when, s.help);
}

}  // namespace

std::string node_reference(const NodeType& type) {
  std::string out = wrapped(type.summary, type.name + ": ", 2);
  if (!type.help.empty()) out += '\n' + wrapped(type.help, "", 0);
  const auto section = [&](const std::string& title, const auto& all, auto described) {
    if (all.empty()) return;
    out += '\n' + title + '\n';
    for (const auto& one : all) out += described(one);
  };
  section("Inputs", type.inputs, described_port);
  section("Outputs", type.outputs, described_port);
  section("Parameters", type.params, described_param);
  section("Steps, in the order in which they run", type.steps, described_step);
  return out;
}

std::string graph_reference(const std::string& name, const GraphInterface& graph) {
  std::string out = wrapped(graph.summary.empty() ? "a graph" : graph.summary, name + ": ", 2);
  if (!graph.help.empty()) out += '\n' + wrapped(graph.help, "", 0);
  std::vector<std::string> groups;  // without a heading first, then in the document's order
  groups.emplace_back();
  for (const GraphParameter& p : graph.parameters)
    if (std::find(groups.begin(), groups.end(), p.group) == groups.end()) groups.push_back(p.group);
  for (const std::string& group : groups) {
    std::string lines;
    for (const GraphParameter& p : graph.parameters)
      if (p.group == group) lines += described_parameter(p);
    const std::string title = group.empty() ? "Parameters (--set NAME=VALUE)" : group;
    if (!lines.empty()) out += '\n' + title + '\n' + lines;
  }
  if (graph.presets.empty()) return out;
  out += "\nPresets (--preset NAME)\n";
  for (const Preset& p : graph.presets) {
    std::vector<std::string> sets;
    for (const Override& o : p.set) sets.push_back(o.node.empty() ? o.name : o.node + "." + o.name);
    out += described(p.name, p.help.empty() ? fmt::format("sets {}", fmt::join(sets, ", ")) : p.help,
                     p.help.empty() ? "" : fmt::format("sets {}", fmt::join(sets, ", ")));
  }
  return out;
}

std::string node_list(const std::vector<NodeType>& types) {
  size_t width = 0;
  for (const NodeType& t : types) width = std::max(width, t.name.size());
  std::string out;
  for (const std::string& category : categories_of(types)) {
    std::string lines;
    for (const NodeType& t : types)
      if (t.category == category) lines += wrapped(t.summary, fmt::format("  {:{}}  ", t.name, width), width + 4);
    if (!lines.empty()) out += fmt::format("{}{}\n{}", out.empty() ? "" : "\n", category, lines);
  }
  return out;
}

std::string nodes_json(const std::vector<NodeType>& types) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const NodeType& t : types) out.push_back(json_of_type(t));
  return out.dump(2) + '\n';
}

}  // namespace terrazzo
