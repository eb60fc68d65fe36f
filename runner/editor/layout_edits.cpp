#include "runner/editor/layout_edits.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/text.h"
#include "graphs/edit/edit_context.h"
#include "graphs/tools/layout.h"

namespace terrazzo {

namespace {

using Positions = std::map<std::string, NodePlace>;

constexpr double node_width = 190, column_gap = 70, head_height = 48, row_height = 22;

const JsonValue* level_of(const JsonValue& document, const std::string& level) {
  if (level.empty()) return &document;
  const JsonValue* graphs = document.find("graphs");
  return graphs ? graphs->find(level) : nullptr;
}

const JsonValue* nodes_of(const JsonValue& document, const std::string& level) {
  const JsonValue* graph = level_of(document, level);
  const JsonValue* nodes = graph ? graph->find("nodes") : nullptr;
  return nodes && nodes->is_object() ? nodes : nullptr;
}

std::optional<JsonValue> read_text(const std::string& text) {
  return parse_json(text).value;
}

/// The nodes of a level with their sources before them, as far as the wires form no cycle.
class Arrangement {
 public:
  explicit Arrangement(const JsonValue& nodes) {
    std::map<std::string, size_t> positions;
    for (const JsonMember& m : nodes.members) positions.emplace(m.name, names_.size()), names_.push_back(m.name);
    sources_.resize(names_.size());
    heights_.resize(names_.size(), head_height);
    for (const JsonMember& m : nodes.members) {
      const size_t i = positions.at(m.name);
      for (const std::string& named : edits::named_nodes(m.value))
        if (const auto at = positions.find(named); at != positions.end() && at->second != i)
          sources_[i].push_back(at->second);
      heights_[i] = head_height + row_height * double(std::max<size_t>(1, sources_[i].size()));
    }
    sort();
  }

  /// All of them, from left to right.
  Positions automatic() const {
    std::vector<size_t> rank(names_.size());
    for (size_t k = 0; k < order_.size(); k++) rank[order_[k]] = k;
    std::vector<BoxSize> boxes;
    std::vector<LayoutWire> wires;
    for (const size_t i : order_) boxes.push_back({node_width, heights_[i]});
    for (const size_t i : order_)
      for (const size_t source : sources_[i])
        if (rank[source] < rank[i]) wires.push_back({rank[source], head_height, rank[i], head_height});
    const Layout layout = lay_out(boxes, wires);
    Positions out;
    for (size_t k = 0; k < order_.size(); k++)
      out[names_[order_[k]]] = {std::round(layout.corners[k].x), std::round(layout.corners[k].y), false};
    return out;
  }

  /// Those of `known`, and the others beside what they read.
  Positions completed(Positions known) const {
    const bool is_complete = std::ranges::all_of(names_, [&](const std::string& n) { return known.contains(n); });
    if (is_complete) return known;
    Positions automatic_ = automatic();
    if (known.empty()) return automatic_;
    for (const size_t i : order_) {
      if (known.contains(names_[i])) continue;
      NodePlace place = automatic_.at(names_[i]);
      bool has_source = false;
      for (const size_t s : sources_[i]) {
        const auto at = known.find(names_[s]);
        if (at == known.end() || (has_source && at->second.x + node_width + column_gap <= place.x)) continue;
        place = {at->second.x + node_width + column_gap, at->second.y, false};
        has_source = true;
      }
      known[names_[i]] = free_place(place, known);
    }
    return known;
  }

 private:
  static NodePlace free_place(NodePlace place, const Positions& known) {
    const auto covers = [&](const auto& other) {
      return std::abs(other.second.x - place.x) < node_width && std::abs(other.second.y - place.y) < 90;
    };
    for (int tries = 0; tries < 1000; tries++) {
      const auto at = std::ranges::find_if(known, covers);
      if (at == known.end()) break;
      place.y = at->second.y + 90;
    }
    return place;
  }

  void sort() {
    enum class State : uint8_t { unseen, open, done };
    std::vector<State> state(names_.size(), State::unseen);
    for (size_t start = 0; start < names_.size(); start++) {
      if (state[start] != State::unseen) continue;
      std::vector<std::pair<size_t, size_t>> path = {{start, 0}};
      state[start] = State::open;
      while (!path.empty()) {
        auto& [node, next] = path.back();
        if (next == sources_[node].size()) {
          state[node] = State::done;
          order_.push_back(node);
          path.pop_back();
        } else if (const size_t source = sources_[node][next++]; state[source] == State::unseen) {
          state[source] = State::open;
          path.emplace_back(source, 0);
        }
      }
    }
  }

  std::vector<std::string> names_;
  std::vector<std::vector<size_t>> sources_;
  std::vector<double> heights_;
  std::vector<size_t> order_;
};

void complete(const JsonValue& document, const std::string& level, std::map<std::string, LevelLayout>& levels) {
  const JsonValue* nodes = nodes_of(document, level);
  if (!nodes) return;
  Positions here, elsewhere;  // positions of nodes that do not exist at present stay in the file
  for (const auto& [name, place] : levels[level].nodes) (nodes->find(name) ? here : elsewhere).emplace(name, place);
  here = Arrangement(*nodes).completed(std::move(here));
  here.merge(elsewhere);
  levels[level].nodes = std::move(here);
}

std::vector<std::string> levels_of(const JsonValue& document) {
  std::vector<std::string> out = {""};
  if (const JsonValue* graphs = document.find("graphs"))
    for (const JsonMember& m : graphs->members) out.push_back(m.name);
  return out;
}

std::string member_text(const nlohmann::ordered_json& object, const char* key) {
  const auto at = object.find(key);
  return at != object.end() && at->is_string() ? at->get<std::string>() : "";
}

/// A position in pixels; throws Error for what is none.
double coordinate(const nlohmann::ordered_json& value) {
  if (!value.is_number() || !(std::abs(value.get<double>()) < 1e7))
    throw Error("expected a position as [x, y] in pixels");
  return std::round(value.get<double>());
}

bool has_position(const nlohmann::ordered_json& edit) {
  return edit.contains("x") && edit.contains("y") && edit["x"].is_number() && edit["y"].is_number();
}

NodePlace middle_of(const Positions& places) {
  NodePlace out;
  for (const auto& [name, place] : places)
    out.x += place.x / double(places.size()), out.y += place.y / double(places.size());
  return {std::round(out.x), std::round(out.y), false};
}

}  // namespace

std::map<std::string, LevelLayout> complete_layout(std::string_view text,
                                                   const std::map<std::string, LevelLayout>& levels) {
  std::map<std::string, LevelLayout> out = levels;
  if (const ParsedJson parsed = parse_json(text); parsed.value)
    for (const std::string& level : levels_of(*parsed.value)) complete(*parsed.value, level, out);
  return out;
}

LayoutEdits::LayoutEdits(const std::string& text, const LayoutFile& layout)
    : text_(text), before_(layout), levels_(layout.levels) {}

LevelLayout& LayoutEdits::frozen(const std::string& level) {
  if (const std::optional<JsonValue> document = read_text(text_)) {
    if (!level_of(*document, level)) throw Error(fmt::format("the document has no graph \"{}\"", level));
    complete(*document, level, levels_);
  }
  return levels_[level];
}

void LayoutEdits::follow(const EditedText& changed, const nlohmann::ordered_json& edits) {
  if (changed.text == text_) return;
  const std::optional<JsonValue> before = read_text(text_), after = read_text(changed.text);
  text_ = changed.text;
  if (!before || !after) return;
  for (const EditedText::Renamed& r : changed.renamed)
    if (auto node = levels_[r.level].nodes.extract(r.from)) {
      node.key() = r.to;
      levels_[r.level].nodes.insert(std::move(node));
    }
  std::map<std::string, Positions> gone;  // by level
  for (auto& entry : levels_) {
    const std::string& level = entry.first;
    const JsonValue *old = nodes_of(*before, level), *now = nodes_of(*after, level);
    std::erase_if(entry.second.nodes, [&](const auto& node) {
      const bool goes = (old && old->find(node.first)) && (!now || !now->find(node.first));
      if (goes) gone[level].insert(node);
      return goes;
    });
  }
  std::erase_if(levels_, [&](const auto& l) { return level_of(*before, l.first) && !level_of(*after, l.first); });
  for (size_t i = 0; i < changed.added.size() && i < changed.added_by.size(); i++) {
    const nlohmann::ordered_json& edit = edits.at(changed.added_by[i]);
    const std::string level = member_text(edit, "level"), op = member_text(edit, "op");
    if (op == "group" && gone.contains(level)) {
      levels_[level].nodes[changed.added[i]] = middle_of(gone[level]);
      levels_[changed.added[i]].nodes = gone[level];
    }
  }
  place_added(changed, edits);
}

/// Several nodes that one change has added keep together.
void LayoutEdits::place_added(const EditedText& changed, const nlohmann::ordered_json& edits) {
  const std::optional<JsonValue> document = read_text(text_);
  for (size_t i = 0; i < changed.added.size() && i < changed.added_by.size();) {
    const size_t by = changed.added_by[i];
    std::set<std::string> names;
    for (; i < changed.added.size() && changed.added_by[i] == by; i++) names.insert(changed.added[i]);
    const nlohmann::ordered_json& edit = edits.at(by);
    const std::string level = member_text(edit, "level");
    const JsonValue* nodes = document ? nodes_of(*document, level) : nullptr;
    if (has_position(edit) && nodes) {
      JsonValue own = JsonValue::empty_object();
      for (const JsonMember& m : nodes->members)
        if (names.contains(m.name)) own.members.push_back(m);
      LevelLayout& layout = frozen(level);
      for (const auto& [name, place] : Arrangement(own).automatic())
        layout.nodes[name] = {place.x + coordinate(edit["x"]), place.y + coordinate(edit["y"]), false};
    } else if (const auto known = levels_.find(level); known != levels_.end() && !known->second.nodes.empty()) {
      frozen(level);
    }
  }
}

void LayoutEdits::apply(const nlohmann::ordered_json& edit) {
  const std::string op = member_text(edit, "op");
  LevelLayout& level = frozen(member_text(edit, "level"));
  const auto node = [&](const std::string& name) -> NodePlace& {
    const auto at = level.nodes.find(name);
    if (at == level.nodes.end()) throw Error(fmt::format("the graph has no node \"{}\"", name));
    return at->second;
  };
  if (op == "move") {
    const nlohmann::ordered_json& positions = edit.at("positions");
    for (const auto& [name, at] : positions.items()) {
      if (!at.is_array() || at.size() != 2) throw Error("expected a position as [x, y] in pixels");
      NodePlace& place = node(name);
      place.x = coordinate(at[0]);
      place.y = coordinate(at[1]);
    }
    label_ = positions.size() == 1 ? fmt::format("move \"{}\"", positions.begin().key())
                                   : fmt::format("move {}", counted(int64_t(positions.size()), "node"));
  } else if (op == "pin") {
    const bool on = edit.value("on", true);
    for (const nlohmann::ordered_json& name : edit.at("nodes")) node(name.get<std::string>()).pinned = on;
    label_ = on ? "pin" : "unpin";
  } else {
    const nlohmann::ordered_json& set = edit.at("set");
    std::string id = member_text(edit, "id");
    for (int i = 1; id.empty(); i++)
      if (const std::string wanted = fmt::format("f{}", i); !level.frames.contains(wanted)) id = wanted;
    if (set.is_null()) {
      level.frames.erase(id);
      label_ = "remove a frame";
      return;
    }
    LayoutFrame& frame = level.frames[id];
    if (set.contains("title")) frame.title = set.at("title").get<std::string>();
    for (const auto& [key, member] : {std::pair("x", &frame.x), std::pair("y", &frame.y),
                                      std::pair("width", &frame.width), std::pair("height", &frame.height)})
      if (set.contains(key)) *member = coordinate(set.at(key));
    label_ = "change a frame";
  }
}

LayoutFile LayoutEdits::result() const {
  return levels_ == before_.levels ? before_ : with_levels(before_, levels_);
}

}  // namespace terrazzo
