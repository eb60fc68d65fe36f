#include "runner/editor/previews/wishes.h"

#include <algorithm>
#include <set>

#include <nlohmann/json.hpp>

#include "graphs/text/json.h"

namespace terrazzo {

namespace {

using Json = nlohmann::ordered_json;

constexpr size_t most_tabs = 64, most_pinned = 64;
constexpr int pinned_side = 256, least_side = 16, greatest_side = 16384;

const Json* member(const Json& object, const char* name) {
  if (!object.is_object()) return nullptr;
  const auto at = object.find(name);
  return at == object.end() || at->is_null() ? nullptr : &*at;
}

std::string text_member(const Json& object, const char* name) {
  const Json* value = member(object, name);
  if (!value) return "";
  if (!value->is_string()) throw Error(name, std::string("expected a text as \"") + name + "\"");
  return value->get<std::string>();
}

Wish wish_of(const Json& from) {
  Wish out{.at = {text_member(from, "level"), text_member(from, "node")}, .map = text_member(from, "map")};
  if (out.at.node.empty()) throw Error("node", "expected the name of a node");
  return out;
}

/// The names that instances of a level's nodes begin with: "walls/" for the level "larger" of the node "walls".
void add_prefixes(const JsonValue& document, const JsonValue* nodes, const std::string& level, const std::string& path,
                  int depth, std::vector<std::string>& out) {
  constexpr int deepest = 16;
  const JsonValue* graphs = document.find("graphs");
  if (!nodes || !graphs || depth > deepest) return;
  for (const JsonMember& m : nodes->members) {
    const JsonValue* type = m.value.find("type");
    const JsonValue* inner = type && type->is_text() ? graphs->find(type->text) : nullptr;
    if (!inner) continue;
    if (type->text == level) out.push_back(path + m.name);
    add_prefixes(document, inner->find("nodes"), level, path + m.name + "/", depth + 1, out);
  }
}

/// Whether a name of the graph is that of a node of a document within instances of `prefix`: "walls[2]/layout".
bool lies_behind(std::string_view name, std::string_view prefix, std::string_view node) {
  if (!prefix.empty()) {
    if (!name.starts_with(prefix)) return false;
    name.remove_prefix(prefix.size());
    if (name.starts_with('[')) name.remove_prefix(std::min(name.size(), name.find(']') + 1));
    if (!name.starts_with('/')) return false;
    name.remove_prefix(1);
  }
  return stands_for(node, name);
}

}  // namespace

void Wishes::set(const Json& request) {
  const std::string tab = text_member(request, "tab");
  if (tab.empty()) throw Error("tab", "expected the id of a tab");
  const Json* side = member(request, "side");
  const Json* full = member(request, "full");
  if (side && !side->is_number_integer()) throw Error("side", "expected a whole number of pixels");
  std::vector<Wish> wishes;
  if (const Json* looked = member(request, "looked")) {
    Wish wish = wish_of(*looked);
    wish.is_looked_at = true;
    wish.side = std::clamp(side ? side->get<int>() : pinned_side, least_side, greatest_side);
    wish.exact = full && full->is_boolean() && full->get<bool>();
    wishes.push_back(std::move(wish));
  }
  if (const Json* pinned = member(request, "pinned")) {
    if (!pinned->is_array() || pinned->size() > most_pinned) throw Error("pinned", "expected a list of nodes");
    for (const Json& p : *pinned) {
      Wish wish = wish_of(p);
      wish.side = pinned_side;
      wishes.push_back(std::move(wish));
    }
  }
  if (!by_tab_.contains(tab) && by_tab_.size() >= most_tabs) by_tab_.erase(by_tab_.begin());
  by_tab_[tab] = std::move(wishes);
}

bool Wishes::forget(const std::string& tab) {
  return by_tab_.erase(tab) > 0;
}

std::vector<Wish> Wishes::all() const {
  std::map<NodeOfDocument, Wish> merged;
  for (const auto& [tab, wishes] : by_tab_)
    for (const Wish& w : wishes) {
      const auto [at, is_new] = merged.try_emplace(w.at, w);
      if (is_new) continue;
      Wish& one = at->second;
      if (w.is_looked_at && one.is_looked_at && one.map != w.map) one.map.clear();
      if (w.is_looked_at && !one.is_looked_at) one.map = w.map;
      one.is_looked_at |= w.is_looked_at;
      one.exact |= w.exact;
      one.side = std::max(one.side, w.side);
    }
  std::vector<Wish> out;
  for (auto& [at, wish] : merged) out.push_back(std::move(wish));
  std::stable_partition(out.begin(), out.end(), [](const Wish& w) { return w.is_looked_at; });
  return out;
}

std::optional<std::string> graph_node_of(const Graph& graph, const std::string& document, const NodeOfDocument& at) {
  std::vector<std::string> prefixes;
  if (at.level.empty()) {
    prefixes.emplace_back();
  } else {
    const ParsedJson parsed = parse_json(document);
    if (!parsed.value) return std::nullopt;
    add_prefixes(*parsed.value, parsed.value->find("nodes"), at.level, "", 0, prefixes);
  }
  for (const std::string& prefix : prefixes) {
    std::set<std::string> inside, read_outside;
    const GraphNode* last = nullptr;
    for (const GraphNode& n : graph.nodes) {
      const bool is_inside = lies_behind(n.name, prefix, at.node);
      if (is_inside) {
        inside.insert(n.name);
        if (!n.type->outputs.empty()) last = &n;
        continue;
      }
      for (const auto& [port, wires] : n.inputs)
        for (const Wire& w : wires)
          if (inside.contains(w.node)) read_outside.insert(w.node);
    }
    for (const GraphNode& n : graph.nodes)
      if (read_outside.contains(n.name)) return n.name;
    if (last) return last->name;
  }
  return std::nullopt;
}

Digest recipe_of(const Graph& graph, const std::string& node) {
  std::map<std::string, Digest> recipes;  // the graph is in topological order
  for (const GraphNode& n : graph.nodes) {
    Hasher h;
    h.add(n.type->name).add(n.type->version);
    add_to(h, n.params);
    for (const auto& [port, wires] : n.inputs) {
      h.add(port).add(int64_t(wires.size()));
      for (const Wire& w : wires) h.add(recipes.at(w.node)).add(w.port);
    }
    recipes[n.name] = h.digest();
    if (n.name == node) break;
  }
  const auto at = recipes.find(node);
  return at == recipes.end() ? Digest() : at->second;
}

}  // namespace terrazzo
