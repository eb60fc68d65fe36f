#include <map>

#include <nlohmann/json.hpp>

#include "graphs/text/edit.h"
#include "graphs/tools/diff.h"
#include "runner/editor/state.h"
#include "runner/scheduler/run_tool.h"

namespace terrazzo {

namespace {

using NodesByName = std::map<std::string, const JsonValue*>;

/// The nodes of all levels: "layout", "walls/layout".
NodesByName all_nodes(const JsonValue& document) {
  NodesByName out;
  const auto add = [&](const JsonValue& graph, const std::string& prefix) {
    if (const JsonValue* nodes = graph.find("nodes"))
      for (const JsonMember& m : nodes->members) out.emplace(prefix + m.name, &m.value);
  };
  add(document, "");
  if (const JsonValue* graphs = document.find("graphs"))
    for (const JsonMember& m : graphs->members) add(m.value, m.name + "/");
  return out;
}

/// The file in git's last commit. A repository may be a stranger's: no hooks, no programs that its settings name,
/// nothing from the network.
std::optional<std::string> committed(const std::filesystem::path& file) {
  const auto passes = [](std::string_view name) { return !name.starts_with("GIT_"); };
  const ToolResult read =
      run_tool({"git", "--no-pager", "--no-optional-locks", "-c", "core.fsmonitor=false", "-c",
                "core.hooksPath=/dev/null", "-c", "protocol.allow=never", "-C", file.parent_path().string(), "cat-file",
                "blob", "HEAD:./" + file.filename().string()},
               passes);
  return read.ok() ? std::optional(read.out) : std::nullopt;
}

}  // namespace

nlohmann::ordered_json changed_since_commit(const DocumentSnapshot& d) {
  nlohmann::ordered_json lines = nlohmann::ordered_json::array(), nodes = nlohmann::ordered_json::object();
  const std::optional<std::string> text = committed(d.file);
  const std::optional<JsonValue> before = text ? parse_json(*text).value : std::nullopt;
  const std::optional<JsonValue> now = parse_json(d.text).value;
  if (before && now) {
    for (const std::string& line : differences(*before, *now)) lines.push_back(line);
    const NodesByName old = all_nodes(*before), current = all_nodes(*now);
    for (const auto& [name, value] : current) {
      const auto at = old.find(name);
      if (at == old.end())
        nodes[name] = "added";
      else if (!same_value(*at->second, *value))
        nodes[name] = "changed";
    }
    for (const auto& [name, value] : old)
      if (!current.contains(name)) nodes[name] = "removed";
  }
  return {{"lines", std::move(lines)}, {"nodes", std::move(nodes)}};
}

}  // namespace terrazzo
