#include "runner/editor/previews/graph_loading.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "core/file/read_guard.h"
#include "graphs/text/format.h"
#include "runner/plan/preflight.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

/// Leaves out nodes that need something unset, and those that need them.
void leave_out_open(Graph& graph) {
  std::set<std::string> open;
  for (const GraphNode& n : graph.nodes) {
    bool is_open = n.is_open || n.params.size() != n.type->params.size();
    for (const auto& [port, wires] : n.inputs)
      is_open |= std::ranges::any_of(wires, [&](const Wire& w) { return open.contains(w.node); });
    if (is_open) open.insert(n.name);
  }
  std::erase_if(graph.nodes, [&](const GraphNode& n) { return open.contains(n.name); });
}

std::shared_ptr<const LoadedGraph> load_within(const std::string& text, const fs::path& file, const Sandbox& sandbox,
                                               const std::vector<Override>& overrides = {}) {
  const auto look_ahead = [&](const std::vector<GraphNode>& nodes) {
    std::vector<Problem> problems = sandbox_problems(nodes, sandbox);
    return problems.empty() ? preflight_of_nodes(nodes) : problems;
  };
  std::shared_ptr<LoadedGraph> out;
  within(sandbox, [&] {
    out = std::make_shared<LoadedGraph>(
        load_graph_text(text, file, overrides, {.allow_unset = true, .keep_going = true, .look_ahead = look_ahead}));
  });
  leave_out_open(out->graph);
  return out;
}

std::vector<Problem> unset_parameters(const LoadedGraph& loaded) {
  std::vector<Problem> out;
  for (const GraphParameter& p : loaded.parameters)
    if (!p.value && !p.formula)
      out.push_back({p.place, fmt::format("parameter \"{}\"", p.param.name),
                     "has no value yet: nodes that need it do not run", "", "", "unset", p.param.name});
  return out;
}

/// Nodes named in texts as "@node", also inside of expressions.
void add_named(const JsonValue& value, std::set<std::string>& names) {
  for (size_t at = value.is_text() ? value.text.find('@') : std::string::npos; at != std::string::npos;
       at = value.text.find('@', at + 1)) {
    size_t end = at + 1;
    const auto is_part = [](char c) { return c == '_' || c == '-' || std::isalnum(static_cast<unsigned char>(c)); };
    while (end < value.text.size() && is_part(value.text[end])) end++;
    names.insert(value.text.substr(at + 1, end - at - 1));
  }
  for (const JsonValue& item : value.items) add_named(item, names);
  for (const JsonMember& m : value.members) add_named(m.value, names);
}

/// Whether the node is a use of the graph, or of one that uses it.
bool uses_level(const JsonValue& document, const JsonValue& node, const std::string& level, int depth = 0) {
  constexpr int deepest = 16;
  const JsonValue* type = node.find("type");
  const JsonValue* graphs = document.find("graphs");
  if (!type || !type->is_text() || !graphs || depth > deepest) return false;
  if (type->text == level) return true;
  const JsonValue* inner = graphs->find(type->text);
  const JsonValue* nodes = inner ? inner->find("nodes") : nullptr;
  return nodes && std::ranges::any_of(nodes->members, [&](const JsonMember& m) {
           return uses_level(document, m.value, level, depth + 1);
         });
}

/// The names of the document's own nodes that a node, or the uses of a level, need.
std::set<std::string> needed_for(const JsonValue& document, const NodeOfDocument& wanted) {
  std::set<std::string> open, needed;
  const JsonValue* nodes = document.find("nodes");
  if (!nodes) return needed;
  if (wanted.level.empty())
    open.insert(wanted.node);
  else
    for (const JsonMember& m : nodes->members)
      if (uses_level(document, m.value, wanted.level)) open.insert(m.name);
  if (const JsonValue* parameters = document.find("parameters")) add_named(*parameters, open);
  while (!open.empty()) {
    const std::string name = open.extract(open.begin()).value();
    const JsonValue* node = nodes->find(name);
    if (node && needed.insert(name).second) add_named(*node, open);
  }
  return needed;
}

std::string with_only(JsonValue document, const std::set<std::string>& names) {
  std::erase_if(document.members, [](const JsonMember& m) { return m.name == "outputs" || m.name == "presets"; });
  if (JsonValue* nodes = document.find("nodes"))
    std::erase_if(nodes->members, [&](const JsonMember& m) { return !names.contains(m.name); });
  return formatted(document);
}

/// The document's own node that a problem is about: "wall" for "wall[brick]/layout".
std::string own_node(const Problem& p) {
  return p.node.substr(0, p.node.find_first_of("[/"));
}

/// Adds the nodes that need one of these, directly or not.
void add_dependents(const JsonValue& nodes, std::set<std::string>& names) {
  for (bool grows = true; grows;) {
    grows = false;
    for (const JsonMember& m : nodes.members) {
      std::set<std::string> needed;
      add_named(m.value, needed);
      if (!names.contains(m.name) && std::ranges::any_of(needed, [&](const auto& n) { return names.contains(n); }))
        grows = names.insert(m.name).second;
    }
  }
}

/// Loads all nodes but those with mistakes and those that need them; null if a mistake is in no node.
std::shared_ptr<const LoadedGraph> load_sound(const std::string& text, const fs::path& file,
                                              std::vector<Problem> problems, const Sandbox& sandbox) {
  constexpr int most_rounds = 8;  // leaving a node out may reveal mistakes of others
  const ParsedJson parsed = parse_json(text);
  const JsonValue* nodes = parsed.value ? parsed.value->find("nodes") : nullptr;
  if (!nodes) return nullptr;
  std::set<std::string> unsound;
  for (int round = 0; round < most_rounds; round++) {
    const size_t before = unsound.size();
    for (const Problem& p : problems)
      if (nodes->find(own_node(p))) unsound.insert(own_node(p));
    if (unsound.size() == before) return nullptr;
    add_dependents(*nodes, unsound);
    std::set<std::string> sound;
    for (const JsonMember& m : nodes->members)
      if (!unsound.contains(m.name)) sound.insert(m.name);
    if (sound.empty()) return nullptr;
    try {
      std::shared_ptr<const LoadedGraph> loaded = load_within(with_only(*parsed.value, sound), file, sandbox);
      problems = sandbox_problems(loaded->graph.nodes, sandbox);
      if (problems.empty()) return loaded;
    } catch (const GraphError& e) {
      problems = e.problems();
    } catch (const Error&) {
      return nullptr;
    }
  }
  return nullptr;
}

/// Loads as many of the wanted nodes as have no mistakes; null if none.
std::shared_ptr<const LoadedGraph> load_parts(const std::string& text, const fs::path& file,
                                              const std::vector<NodeOfDocument>& wanted, const Sandbox& sandbox) {
  const ParsedJson parsed = parse_json(text);
  if (!parsed.value || !parsed.value->is_object()) return nullptr;
  std::shared_ptr<const LoadedGraph> loaded;
  std::set<std::string> names;
  for (const NodeOfDocument& one : wanted) {
    std::set<std::string> more = needed_for(*parsed.value, one);
    if (more.empty()) continue;
    more.insert(names.begin(), names.end());
    if (more == names) continue;
    try {
      loaded = load_within(with_only(*parsed.value, more), file, sandbox);
      names = std::move(more);
    } catch (const Error&) {
      // It is reported with the whole document.
    }
  }
  return loaded;
}

/// Nodes that may not read or write where they would are reported, and none of the graph is planned or run.
bool is_within(const LoadedGraph& loaded, const Sandbox& sandbox, std::vector<Problem>& problems) {
  std::vector<Problem> found = sandbox_problems(loaded.graph.nodes, sandbox);
  const bool is_fine = found.empty();
  for (Problem& p : found) problems.push_back(std::move(p));
  return is_fine;
}

}  // namespace

void within(const Sandbox& sandbox, const std::function<void()>& act) {
  const ReadGuard guard([&](const fs::path& path) { sandbox.check("read", path); });
  act();
}

std::vector<std::string> without_sinks(const Graph& graph, const std::vector<std::string>& names) {
  std::set<std::string> out;
  const auto add_sources = [&](const GraphNode& sink) {
    for (const auto& [port, wires] : sink.inputs)
      for (const Wire& w : wires) out.insert(w.node);
  };
  for (const GraphNode& n : graph.nodes) {
    const bool is_meant =
        names.empty() || std::ranges::any_of(names, [&](const std::string& name) { return stands_for(name, n.name); });
    if (!is_meant) continue;
    if (n.type->is_sink())
      add_sources(n);
    else if (!names.empty())
      out.insert(n.name);
  }
  if (out.empty())  // a graph without sinks
    for (const GraphNode& n : graph.nodes)
      if (names.empty() && !n.type->is_sink()) out.insert(n.name);
  return {out.begin(), out.end()};
}

EditedGraph load_variation(const std::string& text, const fs::path& file, std::vector<Override> overrides,
                           const Sandbox& sandbox) {
  for (Override& o : overrides) o.base = file.parent_path();
  EditedGraph out{.loaded = load_within(text, file, sandbox, overrides)};
  if (!is_within(*out.loaded, sandbox, out.problems)) throw GraphError(file.string(), out.problems);
  return out;
}

EditedGraph load_for_editing(const std::string& text, const fs::path& file, const std::vector<NodeOfDocument>& wanted,
                             const Sandbox& sandbox) {
  EditedGraph out;
  out.begun = fs::file_time_type::clock::now();
  try {
    out.loaded = load_within(text, file, sandbox);
    out.unset = unset_parameters(*out.loaded);
    if (is_within(*out.loaded, sandbox, out.problems)) return out;
  } catch (const GraphError& e) {
    out.problems = e.problems();
  } catch (const Error& e) {
    out.problems = {{{}, "", e.what(), "", "", "input"}};
  }
  out.is_part = true;
  out.loaded = load_sound(text, file, out.problems, sandbox);
  if (out.loaded) return out;
  out.loaded = load_parts(text, file, wanted, sandbox);
  std::vector<Problem> known;
  if (out.loaded && !is_within(*out.loaded, sandbox, known)) out.loaded = nullptr;
  return out;
}

}  // namespace terrazzo
