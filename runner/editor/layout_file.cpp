#include "runner/editor/layout_file.h"

#include <cmath>

#include <fmt/format.h>

#include "graphs/text/edit.h"
#include "graphs/text/format.h"

namespace terrazzo {

namespace {

JsonValue boolean(bool value) {
  JsonValue out;
  out.kind = JsonValue::Kind::boolean;
  out.boolean = value;
  return out;
}

/// Whole pixels: a sidecar is committed, and should not change without cause.
JsonValue pair_of(double x, double y) {
  JsonValue out;
  out.kind = JsonValue::Kind::list;
  for (const double v : {x, y}) out.items.push_back(JsonValue::of(int64_t(std::llround(v))));
  return out;
}

bool read_pair(const JsonValue* v, double& x, double& y) {
  if (!v || v->items.size() != 2 || !v->items[0].is_number() || !v->items[1].is_number()) return false;
  x = v->items[0].number;
  y = v->items[1].number;
  return std::abs(x) < 1e7 && std::abs(y) < 1e7;
}

LevelLayout read_level(const JsonValue& json) {
  LevelLayout out;
  if (const JsonValue* nodes = json.find("nodes"))
    for (const JsonMember& m : nodes->members) {
      NodePlace place;
      const bool is_plain = m.value.is_list();
      if (!read_pair(is_plain ? &m.value : m.value.find("at"), place.x, place.y)) continue;
      const JsonValue* pinned = m.value.find("pinned");
      place.pinned = pinned && pinned->boolean;
      out.nodes.emplace(m.name, place);
    }
  if (const JsonValue* frames = json.find("frames"))
    for (const JsonMember& m : frames->members) {
      LayoutFrame frame;
      const JsonValue* title = m.value.find("title");
      if (title && title->is_text()) frame.title = title->text;
      if (read_pair(m.value.find("at"), frame.x, frame.y) && read_pair(m.value.find("size"), frame.width, frame.height))
        out.frames.emplace(m.name, frame);
    }
  if (const JsonValue* wires = json.find("wires"))
    for (const JsonMember& m : wires->members) {
      std::vector<std::array<double, 2>> points;
      for (const JsonValue& item : m.value.items)
        if (std::array<double, 2> point{}; read_pair(&item, point[0], point[1])) points.push_back(point);
      if (!points.empty()) out.bends.emplace(m.name, std::move(points));
    }
  return out;
}

JsonValue& member(JsonValue& object, const std::string& name) {
  if (!object.find(name) || !object.find(name)->is_object()) object.set(name, JsonValue::empty_object());
  return *object.find(name);
}

/// Writes the members that differ, and removes those that are gone; `known`: those that the file had and that could be
/// read. Others stay.
template <typename T, typename Write>
void write_members(JsonValue& section, const std::map<std::string, T>& known, const std::map<std::string, T>& now,
                   const Write& write) {
  std::erase_if(section.members, [&](const JsonMember& m) { return known.contains(m.name) && !now.contains(m.name); });
  for (const auto& [name, value] : now)
    if (const auto at = known.find(name); at == known.end() || at->second != value) write(section, name, value);
}

void write_node(JsonValue& section, const std::string& name, const NodePlace& place) {
  JsonValue* there = section.find(name);
  if (there && there->is_object()) {
    there->set("at", pair_of(place.x, place.y));
    there->set("pinned", boolean(place.pinned));
  } else if (place.pinned) {
    JsonValue node = JsonValue::empty_object();
    node.set("at", pair_of(place.x, place.y));
    node.set("pinned", boolean(true));
    section.set(name, std::move(node));
  } else {
    section.set(name, pair_of(place.x, place.y));
  }
}

void write_frame(JsonValue& section, const std::string& name, const LayoutFrame& frame) {
  JsonValue& out = member(section, name);
  out.set("title", JsonValue::of(frame.title));
  out.set("at", pair_of(frame.x, frame.y));
  out.set("size", pair_of(frame.width, frame.height));
}

void write_bends(JsonValue& section, const std::string& wire, const std::vector<std::array<double, 2>>& points) {
  JsonValue out;
  out.kind = JsonValue::Kind::list;
  for (const auto& [x, y] : points) out.items.push_back(pair_of(x, y));
  section.set(wire, std::move(out));
}

bool is_empty(const LevelLayout& level) {
  return level.nodes.empty() && level.frames.empty() && level.bends.empty();
}

}  // namespace

std::filesystem::path layout_path(const std::filesystem::path& graph) {
  std::filesystem::path out = graph;
  return out.replace_extension(".layout.json");
}

LayoutFile read_layout(std::string text) {
  LayoutFile out{.levels = {}, .text = std::move(text), .fault = ""};
  if (out.text.empty()) return out;
  const ParsedJson parsed = parse_json(out.text);
  if (!parsed.value) {
    const Problem& p = parsed.problems.front();
    out.fault = fmt::format("line {}, column {}: {}", p.place.line, p.place.column, p.message);
  } else if (!parsed.value->is_object()) {
    out.fault = "expected an object, found " + found(*parsed.value);
  } else if (const JsonValue* levels = parsed.value->find("levels")) {
    for (const JsonMember& m : levels->members) out.levels.emplace(m.name, read_level(m.value));
  }
  return out;
}

LayoutFile with_levels(const LayoutFile& before, const std::map<std::string, LevelLayout>& levels) {
  const bool is_new = before.text.empty() || !before.fault.empty();
  const std::string text = is_new ? "{\n  \"levels\": {\n  }\n}\n" : before.text;
  JsonValue json = json_in(text);
  static const LevelLayout none;
  const auto known = [&](const std::string& level) -> const LevelLayout& {
    const auto at = is_new ? before.levels.end() : before.levels.find(level);
    return at == before.levels.end() ? none : at->second;
  };
  JsonValue& all = member(json, "levels");
  for (const auto& [name, level] : levels) {
    if (is_empty(level) && is_empty(known(name))) continue;
    JsonValue& out = member(all, name);
    if (!level.nodes.empty() || out.find("nodes"))
      write_members(member(out, "nodes"), known(name).nodes, level.nodes, write_node);
    if (!level.frames.empty() || out.find("frames"))
      write_members(member(out, "frames"), known(name).frames, level.frames, write_frame);
    if (!level.bends.empty() || out.find("wires"))
      write_members(member(out, "wires"), known(name).bends, level.bends, write_bends);
  }
  std::erase_if(all.members,
                [&](const JsonMember& m) { return before.levels.contains(m.name) && !levels.contains(m.name); });
  LayoutFile out = read_layout(is_new ? formatted(json) : with_changes(text, json));
  return out;
}

}  // namespace terrazzo
