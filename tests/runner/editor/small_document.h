#pragma once

#include <string>

#include <nlohmann/json.hpp>

/// A document to edit, and edits of it.
namespace terrazzo::test {

inline const std::string small =
    "{\n  \"terrazzo\": 1,\n  \"nodes\": {\n    \"a\": {\"type\": \"pattern\"}, // first\n    \"b\": {\"type\": "
    "\"weight\", \"material\": \"@a\"}\n  }\n}\n";

inline constexpr const char* add_crop = R"({"op": "add", "type": "crop", "behind": {"node": "a"}})";

/// `edits`: one or several, with commas between them.
inline nlohmann::ordered_json request(const std::string& edits, const std::string& label = "") {
  nlohmann::ordered_json out = {{"edits", nlohmann::ordered_json::parse("[" + edits + "]")}};
  if (!label.empty()) out["label"] = label;
  return out;
}

}  // namespace terrazzo::test
