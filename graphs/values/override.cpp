#include "graphs/values/override.h"

#include <fmt/format.h>

#include "core/node/node.h"
#include "graphs/text/read_document.h"
#include "graphs/values/convert.h"

namespace terrazzo {

namespace fs = std::filesystem;

namespace {

/// Splits "node.name" or "name". False if a part is missing.
bool split_target(const std::string& target, Override& out) {
  const size_t dot = target.find('.', target.rfind(']') == target.npos ? 0 : target.rfind(']'));
  if (dot != target.npos) out.node = target.substr(0, dot);
  out.name = dot == target.npos ? target : target.substr(dot + 1);
  return !out.name.empty() && (dot == target.npos || !out.node.empty());
}

}  // namespace

Diagnostics Override::diagnostics(std::vector<Problem>& all) const {
  Diagnostics out(all, {source.place, where, source.advice, "", source.file, "", name, position});
  if (place.line == 0) out.at_one_place();
  return out;
}

JsonValue Override::json_for(const Param& param) const {
  return json ? *json : read_command_line(value, param);
}

std::optional<JsonValue> with_member(JsonValue map, const std::string& member, const Override& by,
                                     std::vector<Problem>& problems) {
  if (!map.is_object()) {
    by.diagnostics(problems).add(by.place, fmt::format("the value is {}, of which no single member can be set; set it "
                                                       "as a whole",
                                                       found(map)));
    return std::nullopt;
  }
  const JsonValue value = by.json_for({.name = member, .type = ParamType::numbers});
  if (JsonValue* old = map.find(member)) {
    *old = value;
  } else {
    map.members.push_back({member, by.place, value});
  }
  return map;
}

Override override_of(const std::string& target, const std::string& value) {
  Override out{.value = value, .where = "override " + in_quotes(target + "=" + value)};
  if (!split_target(target, out)) out.name.clear();
  return out;
}

std::vector<Override> overrides_from(const std::vector<std::string>& texts) {
  std::vector<Override> out;
  for (const std::string& text : texts) {
    const size_t equals = text.find('=');
    if (equals == text.npos)
      out.push_back({.where = "override " + in_quotes(text)});
    else
      out.push_back(override_of(text.substr(0, equals), text.substr(equals + 1)));
  }
  return out;
}

std::vector<Override> read_override_object(const JsonValue& object, const fs::path& base, const std::string& where,
                                           bool in_graph, std::vector<Problem>& problems) {
  std::vector<Override> out;
  if (!object.is_object()) {
    const Place place = in_graph ? object.place : Place{};
    problems.push_back(
        {place, where, "expected an object such as {\"seed\": 3, \"node.parameter\": 0.5}, found " + found(object)});
    return out;
  }
  for (const JsonMember& m : object.members) {
    Override o{.json = m.value, .base = base};
    if (in_graph) {
      o.place = m.place;
      o.where = fmt::format("{}, {}", where, in_quotes(m.name));
    } else {
      o.where = fmt::format("{}:{}:{}: {}", where, m.place.line, m.place.column, in_quotes(m.name));
    }
    if (split_target(m.name, o)) {
      out.push_back(std::move(o));
    } else {
      o.diagnostics(problems).add(m.place, "expected the name of a graph's parameter, or node.parameter");
    }
  }
  return out;
}

std::vector<Override> read_settings(const fs::path& file, std::vector<Problem>& problems) {
  const std::optional<JsonValue> json = read_json_document(file, "settings file", problems);
  if (!json) return {};
  return read_override_object(*json, fs::absolute(file).parent_path(), file.string(), false, problems);
}

}  // namespace terrazzo
