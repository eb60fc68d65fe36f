#include "graphs/text/migrate.h"

#include <fmt/format.h>

#include "core/base/suggest.h"
#include "graphs/text/format.h"

namespace terrazzo {

const std::vector<Migration>& document_migrations() {
  static const std::vector<Migration> none;
  return none;
}

bool migrate(JsonValue& document, const std::vector<Migration>& migrations, std::vector<Problem>& problems) {
  const auto current = static_cast<int64_t>(migrations.size()) + 1;
  if (!document.is_object()) {
    problems.push_back({document.place, "", "expected a graph, which begins with {, found " + found(document)});
    return false;
  }
  JsonValue* version = document.find("terrazzo");
  if (!version) {
    std::vector<std::string> names;
    for (const JsonMember& m : document.members) names.push_back(m.name);
    const std::string meant = nearest("terrazzo", names);
    problems.push_back({document.place, "",
                        fmt::format("expected \"terrazzo\": {} in the graph, the format's version{}", current,
                                    meant.empty() ? "" : "; found " + in_quotes(meant))});
    return false;
  }
  if (version->kind != JsonValue::Kind::integer || version->integer < 1) {
    problems.push_back(
        {version->place, "\"terrazzo\"",
         fmt::format("expected the format's version, at present {}, found {}", current, found(*version))});
    return false;
  }
  if (version->integer > current) {
    problems.push_back({version->place, "\"terrazzo\"",
                        fmt::format("the file has format {}, this terrazzo reads up to {}; use a newer terrazzo",
                                    version->integer, current)});
    return false;
  }
  for (int64_t v = version->integer; v < current; v++) migrations[v - 1](document);
  if (JsonValue* after = document.find("terrazzo"); after->integer < current) {
    after->integer = current;
    after->text = std::to_string(current);
  }
  return true;
}

JsonValue current_document(std::string_view text, const std::string& file, const std::vector<Migration>& migrations) {
  ParsedJson parsed = parse_json(text);
  if (parsed.problems.empty() && migrate(*parsed.value, migrations, parsed.problems)) return std::move(*parsed.value);
  throw GraphError(file, std::move(parsed.problems));
}

std::string upgraded(std::string_view text, const std::string& file, const std::vector<Migration>& migrations) {
  return formatted(current_document(text, file, migrations));
}

}  // namespace terrazzo
