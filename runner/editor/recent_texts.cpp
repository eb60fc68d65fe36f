#include "runner/editor/recent_texts.h"

#include <algorithm>
#include <optional>
#include <vector>

#include <nlohmann/json.hpp>

#include "graphs/text/json.h"

namespace terrazzo {

namespace {

constexpr size_t most_texts = 256, most_bytes = size_t{16} << 20;

std::string name_in(const nlohmann::ordered_json& edit, const char* key) {
  const auto at = edit.find(key);
  return at != edit.end() && at->is_string() ? at->get<std::string>() : "";
}

/// The path of the value that an edit replaces; empty if it replaces none.
std::vector<std::string> target_of(const nlohmann::ordered_json& edit) {
  const std::string op = name_in(edit, "op"), level = name_in(edit, "level"), name = name_in(edit, "name");
  std::vector<std::string> out;
  if (!level.empty()) out = {"graphs", level};
  if (op == "set" || op == "unset") {
    if (const std::string node = name_in(edit, "node"); !node.empty()) out.insert(out.end(), {"nodes", node});
    out.push_back(name_in(edit, "key"));
  } else if (op == "value") {
    out.insert(out.end(), {"parameters", name, "default"});
  } else if (op == "parameter") {
    out.insert(out.end(), {"parameters", name});
  } else if (op == "preset") {
    out.insert(out.end(), {"presets", name});
  } else {
    return {};
  }
  return out;
}

const JsonValue* value_at(const JsonValue& document, const std::vector<std::string>& path) {
  const JsonValue* at = &document;
  for (const std::string& name : path)
    if (!(at = at->find(name))) return nullptr;
  return at;
}

}  // namespace

void RecentTexts::add(int64_t revision, const std::string& text) {
  texts_.emplace_back(revision, text);
  bytes_ += text.size();
  while (texts_.size() > 1 && (texts_.size() > most_texts || bytes_ > most_bytes)) {
    bytes_ -= texts_.front().second.size();
    texts_.pop_front();
  }
}

std::string RecentTexts::changed_since(int64_t revision, const std::string& now,
                                       const nlohmann::ordered_json& edits) const {
  const auto after = std::ranges::upper_bound(texts_, revision, {}, [](const auto& t) { return t.first; });
  if (after == texts_.begin() || (after - 1)->second == now) return "";
  const std::optional<JsonValue> then = parse_json((after - 1)->second).value, today = parse_json(now).value;
  if (!then || !today) return "";
  for (const nlohmann::ordered_json& edit : edits) {
    const std::vector<std::string> path = target_of(edit);
    if (path.empty()) continue;
    const JsonValue *a = value_at(*then, path), *b = value_at(*today, path);
    if ((a || b) && (!a || !b || !same_value(*a, *b))) return pointer_of(path);
  }
  return "";
}

}  // namespace terrazzo
