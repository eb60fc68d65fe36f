#include "graphs/document/pack_settings.h"

#include <algorithm>
#include <map>
#include <string_view>

#include <fmt/format.h>

#include "core/file/path_relation.h"
#include "graphs/text/read_document.h"

namespace terrazzo {

namespace fs = std::filesystem;

namespace {

/// Whether a name in an override means this node. Names may omit iterations: "walls/brick" means "walls[red]/brick".
bool names_node(std::string_view given, std::string_view node) {
  while (!given.empty() || !node.empty()) {
    const std::string_view wanted = given.substr(0, given.find('/'));
    const std::string_view step = node.substr(0, node.find('/'));
    const bool is_iteration = wanted.substr(0, wanted.find('[')) == step;
    if (wanted != step && !is_iteration && wanted != step.substr(0, step.find('['))) return false;
    given.remove_prefix(std::min(given.size(), wanted.size() + 1));
    node.remove_prefix(std::min(node.size(), step.size() + 1));
  }
  return true;
}

bool sets(const Override& o, std::string_view node, std::string_view name) {
  return names_node(o.node, node) && (o.name == name || o.name.starts_with(std::string(name) + "."));
}

bool is_set(const std::vector<Override>& given, std::string_view node, std::string_view name) {
  return std::ranges::any_of(given, [&](const Override& o) { return sets(o, node, name); });
}

/// Whether all paths of a file name pattern lie in the folder: "/a/b{map}.png" lies in "/a".
bool is_in(const fs::path& folder, const std::string& pattern) {
  const size_t open = pattern.find('{');
  return lies_in(folder,
                 open == std::string::npos ? fs::path(pattern) : fs::path(pattern.substr(0, open)).parent_path());
}

/// The same for a path that was set, which may also be a prefix of file names.
bool is_at(const fs::path& place, const std::string& pattern) {
  if (is_in(place, pattern)) return true;
  const bool begins = pattern.starts_with(place.string());
  return begins && pattern.find('/', place.string().size()) == std::string::npos;
}

/// The first invalid part of a pack's sources; null if all are valid.
const JsonValue* no_sources(const JsonValue& sources) {
  if (!sources.is_object()) return &sources;
  for (const JsonMember& m : sources.members) {
    if (m.value.kind != JsonValue::Kind::list) return &m.value;
    for (const JsonValue& name : m.value.items)
      if (name.kind != JsonValue::Kind::text) return &name;
  }
  return nullptr;
}

/// Without sources.json the inputs cannot follow the parameters they were derived from, so only the names in
/// settings.json can be set.
void refuse_others(const std::vector<Override>& settings, const std::vector<Override>& others,
                   std::vector<Problem>& problems) {
  for (const Override& o : others) {
    const auto is_own = [&](const Override& s) { return !s.node.empty() && s.node == o.node && s.name == o.name; };
    if (std::ranges::any_of(settings, is_own)) continue;
    o.diagnostics(problems).add(
        o.place,
        "the pack has no sources.json, which says which of its inputs belong to which settings: an older version made "
        "it, or it is damaged. Pack it again (terrazzo pack), or run it unchanged");
  }
}

}  // namespace

std::vector<Override> pack_settings(const fs::path& pack, const std::vector<Override>& others,
                                    std::vector<Problem>& problems) {
  std::vector<Override> out = read_settings(pack / "settings.json", problems);
  const fs::path file = pack / "sources.json";
  std::error_code missing;
  if (!fs::exists(file, missing)) {
    refuse_others(out, others, problems);
    return out;
  }
  const std::optional<JsonValue> sources = read_json_document(file, "file of a pack", problems);
  if (!sources) return out;
  if (const JsonValue* wrong = no_sources(*sources)) {
    problems.push_back({{},
                        "sources.json",
                        fmt::format("expected an object of lists of names such as {{\"wall.path\": [\"scan\"]}}, found "
                                    "{}: the pack is damaged, pack it again (terrazzo pack)",
                                    found(*wrong))});
    return out;
  }
  std::map<std::string_view, const JsonValue*> by_target;
  for (const JsonMember& m : sources->members) by_target.emplace(m.name, &m.value);
  std::erase_if(out, [&](const Override& o) {
    const auto names = by_target.find(o.node.empty() ? o.name : o.node + "." + o.name);
    return names != by_target.end() && std::ranges::any_of(names->second->items, [&](const JsonValue& name) {
             const size_t dot = name.text.rfind('.');
             return dot == std::string::npos ? is_set(others, "", name.text)
                                             : is_set(others, name.text.substr(0, dot), name.text.substr(dot + 1));
           });
  });
  return out;
}

std::vector<Problem> writes_elsewhere(const Drafts& drafts, const fs::path& folder,
                                      const std::vector<Override>& given) {
  std::vector<Problem> out;
  for (const NodeDraft& d : drafts) {
    const GraphNode& node = d.node;
    if (!node.type || !node.type->is_sink()) continue;
    for (const Param& param : node.type->params) {
      const auto value = node.params.find(param.name);
      if (param.type != ParamType::path || value == node.params.end()) continue;
      const std::string& path = std::get<std::string>(value->second);
      if (path.empty() || is_in(folder, path) || is_set(given, node.name, param.name)) continue;
      const auto by = d.set_by.find(param.name);
      const auto allows = [&](const Settable& s) {
        return !s.path.empty() && is_at(s.path, path) && is_set(given, s.node, s.name);
      };
      if (by != d.set_by.end() && std::ranges::any_of(by->second, allows)) continue;
      out.push_back(problem_of(
          node, param.name,
          fmt::format("may not write {}: a pack writes only into its own folder, {}, and where --set or --params says",
                      path, folder.string())));
    }
  }
  return out;
}

}  // namespace terrazzo
