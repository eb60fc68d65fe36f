#include "runner/editor/layout_edits.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/text.h"
#include "graphs/document/nodes.h"
#include "runner/editor/arrangement.h"

namespace terrazzo {

namespace {

using Positions = std::map<std::string, NodePlace>;

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

void complete(const JsonValue& document, const std::string& level, std::map<std::string, LevelLayout>& levels) {
  const JsonValue* nodes = nodes_of(document, level);
  if (!nodes) return;
  Positions here, elsewhere;  // positions of nodes that do not exist at present stay in the file
  for (const auto& [name, place] : levels[level].nodes) (nodes->find(name) ? here : elsewhere).emplace(name, place);
  here = Arrangement(document, *nodes).completed(std::move(here));
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

/// The ends of a wire that has bends: "node.output > node.input". Names of nodes have no points.
struct WireEnds {
  std::string from, output, to, input;

  static std::optional<WireEnds> of(const std::string& key) {
    const size_t between = key.find(" > ");
    if (between == std::string::npos) return std::nullopt;
    const std::string left = key.substr(0, between), right = key.substr(between + 3);
    const size_t a = left.find('.'), b = right.find('.');
    if (b == std::string::npos) return std::nullopt;
    return WireEnds{left.substr(0, a), a == std::string::npos ? "" : left.substr(a), right.substr(0, b),
                    right.substr(b + 1)};
  }
  std::string key() const { return from + output + " > " + to + "." + input; }
};

constexpr const char *inputs_box = "@inputs", *outputs_box = "@outputs";

bool comes_from(const JsonValue& value, const std::string& node) {
  if (is_wire(value)) return wire_parts(value.text).first == node;
  return std::ranges::any_of(value.items, [&](const JsonValue& v) { return comes_from(v, node); });
}

/// Whether a level has such a wire.
bool has_wire(const JsonValue& document, const std::string& level, const WireEnds& wire) {
  const JsonValue* graph = level_of(document, level);
  const JsonValue* readers = graph ? graph->find(wire.to == outputs_box ? "outputs" : "nodes") : nullptr;
  const JsonValue* reader = readers && wire.to != outputs_box ? readers->find(wire.to) : readers;
  const JsonValue* value = reader ? reader->find(wire.input) : nullptr;
  if (!value) return false;
  if (const JsonValue* from = value->is_object() ? value->find("from") : nullptr) value = from;
  return comes_from(*value, wire.from);
}

/// Whether an edit may change the places that are chosen automatically.
bool changes_structure(const nlohmann::ordered_json& edit) {
  const std::string op = member_text(edit, "op");
  return op != "set" && op != "unset" && op != "value" && op != "parameter";
}

NodePlace middle_of(const Positions& places) {
  NodePlace out;
  for (const auto& [name, place] : places)
    out.x += place.x / double(places.size()), out.y += place.y / double(places.size());
  return {std::round(out.x), std::round(out.y), false};
}

/// Moves what stands to the right of a block of new nodes, in its rows, by the width that they take there.
void make_room(LevelLayout& layout, const Positions& block) {
  constexpr double beside = 120;  // about a card's height
  const auto by_x = [](const auto& a, const auto& b) { return a.second.x < b.second.x; };
  const auto by_y = [](const auto& a, const auto& b) { return a.second.y < b.second.y; };
  const auto [left, right] = std::ranges::minmax_element(block, by_x);
  const auto [top, bottom] = std::ranges::minmax_element(block, by_y);
  const double column = left->second.x, by = right->second.x - column;
  const double low = top->second.y - beside, high = bottom->second.y + beside;
  for (auto& [name, place] : layout.nodes)
    if (!block.contains(name) && place.x > column + 1 && place.y > low && place.y < high) place.x += by;
  for (auto& entry : layout.frames) {
    LayoutFrame& f = entry.second;
    if (f.y + f.height < low || f.y > high) continue;
    if (f.x > column + 1)
      f.x += by;
    else if (f.x + f.width > column + 1)
      f.width += by;
  }
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
  if (before && after && before_.fault.empty()) keep_places(*before, *after, edits);
  text_ = changed.text;
  if (!before || !after) return;
  std::map<size_t, NodePlace> ungrouped;  // by position of the edit: where the node was
  for (size_t i = 0; i < edits.size(); i++)
    if (member_text(edits[i], "op") == "ungroup") {
      const Positions& nodes = levels_[member_text(edits[i], "level")].nodes;
      if (const auto at = nodes.find(member_text(edits[i], "node")); at != nodes.end()) ungrouped[i] = at->second;
    }
  for (const EditedText::Renamed& r : changed.renamed)
    if (auto node = levels_[r.level].nodes.extract(r.from)) {
      node.key() = r.to;
      levels_[r.level].nodes.insert(std::move(node));
    }
  follow_wires(*after, changed);
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
      Positions& nodes = levels_[level].nodes;
      nodes[changed.added[i]] =
          Arrangement(*after, *nodes_of(*after, level)).free_place(middle_of(gone[level]), changed.added[i], nodes);
      levels_[changed.added[i]].nodes = gone[level];
    }
  }
  place_added(changed, edits, ungrouped);
}

/// Nodes that were placed automatically stay where they are seen: an edit must not move others.
void LayoutEdits::keep_places(const JsonValue& before, const JsonValue& after, const nlohmann::ordered_json& edits) {
  std::set<std::string> touched;
  for (const nlohmann::ordered_json& e : edits)
    if (changes_structure(e)) touched.insert(member_text(e, "level"));
  for (const std::string& level : touched) {
    const JsonValue* nodes = nodes_of(before, level);
    const Positions& known = levels_[level].nodes;
    if (!nodes || std::ranges::all_of(nodes->members, [&](const JsonMember& m) { return known.contains(m.name); }))
      continue;
    std::map<std::string, LevelLayout> old = levels_, now = levels_;
    complete(before, level, old);
    complete(after, level, now);
    const bool is_moved = std::ranges::any_of(old[level].nodes, [&](const auto& node) {
      const auto at = now[level].nodes.find(node.first);
      return at == now[level].nodes.end() || !(at->second == node.second);
    });
    if (is_moved) levels_[level].nodes = std::move(old[level].nodes);
  }
}

/// Bends of wires follow new names, and go with their wires.
void LayoutEdits::follow_wires(const JsonValue& after, const EditedText& changed) {
  for (auto& entry : levels_) {
    const std::string& level = entry.first;
    std::map<std::string, std::vector<std::array<double, 2>>> kept;
    for (auto& [key, points] : entry.second.bends) {
      std::optional<WireEnds> wire = WireEnds::of(key);
      if (!wire) continue;
      for (const EditedText::Renamed& r : changed.renamed)
        if (r.level == level)
          for (std::string* name : {&wire->from, &wire->to})
            if (*name == r.from) *name = r.to;
      if (has_wire(after, level, *wire)) kept.emplace(wire->key(), std::move(points));
    }
    entry.second.bends = std::move(kept);
  }
}

/// Several nodes that one change has added keep together.
void LayoutEdits::place_added(const EditedText& changed, const nlohmann::ordered_json& edits,
                              const std::map<size_t, NodePlace>& ungrouped) {
  const std::optional<JsonValue> document = read_text(text_);
  for (size_t i = 0; i < changed.added.size() && i < changed.added_by.size();) {
    const size_t by = changed.added_by[i];
    std::set<std::string> names;
    for (; i < changed.added.size() && changed.added_by[i] == by; i++) names.insert(changed.added[i]);
    const nlohmann::ordered_json& edit = edits.at(by);
    const std::string level = member_text(edit, "level");
    const JsonValue* nodes = document ? nodes_of(*document, level) : nullptr;
    const auto was = ungrouped.find(by);
    if (nodes && (has_position(edit) || was != ungrouped.end())) {
      const NodePlace corner =
          was != ungrouped.end() ? was->second : NodePlace{coordinate(edit["x"]), coordinate(edit["y"])};
      JsonValue own = JsonValue::empty_object();
      for (const JsonMember& m : nodes->members)
        if (names.contains(m.name)) own.members.push_back(m);
      LevelLayout& layout = frozen(level);
      Positions block = Arrangement(*document, own).automatic();
      for (auto& [name, place] : block) place = {place.x + corner.x, place.y + corner.y, false};
      if (was != ungrouped.end() && !block.empty()) {
        make_room(layout, block);
        Positions others;
        for (const JsonMember& m : nodes->members)
          if (const auto at = layout.nodes.find(m.name); at != layout.nodes.end() && !names.contains(m.name))
            others.insert(*at);
        block = Arrangement(*document, *nodes).clear_of(std::move(block), others);
      }
      for (const auto& [name, place] : block) layout.nodes[name] = place;
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
      NodePlace& place = name == inputs_box || name == outputs_box ? level.nodes[name] : node(name);
      place.x = coordinate(at[0]);
      place.y = coordinate(at[1]);
    }
    label_ = positions.size() == 1 ? fmt::format("move \"{}\"", positions.begin().key())
                                   : fmt::format("move {}", counted(int64_t(positions.size()), "node"));
  } else if (op == "pin") {
    const bool on = edit.value("on", true);
    for (const nlohmann::ordered_json& name : edit.at("nodes")) node(name.get<std::string>()).pinned = on;
    label_ = on ? "pin" : "unpin";
  } else if (op == "bend") {
    const nlohmann::ordered_json& points = edit.at("points");
    const std::string wire = member_text(edit, "wire");
    const std::optional<WireEnds> ends = WireEnds::of(wire);
    const std::optional<JsonValue> document = read_text(text_);
    if (!ends || !document || !has_wire(*document, member_text(edit, "level"), *ends))
      throw Error(fmt::format("the graph has no wire \"{}\"", wire));
    std::vector<std::array<double, 2>> bends;
    for (const nlohmann::ordered_json& p : points) bends.push_back({coordinate(p.at(0)), coordinate(p.at(1))});
    if (bends.empty())
      level.bends.erase(wire);
    else
      level.bends[wire] = std::move(bends);
    label_ = "bend a wire";
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
