#include "runner/report/problem_json.h"

#include <nlohmann/json.hpp>

#include "graphs/text/read_document.h"
#include "graphs/tools/pack.h"

namespace terrazzo {

std::string ProblemsAsJson::pointer(const std::string& file, Place place) {
  const auto [at, is_new] = documents_.try_emplace(file);
  if (is_new) {
    try {
      at->second = parse_json(is_pack(file) ? graph_in_pack(file) : read_document(file)).value;
    } catch (const Error&) {
      // a graph that comes with the program
    }
  }
  return at->second ? pointer_to(*at->second, place) : "";
}

nlohmann::ordered_json ProblemsAsJson::entry(const Problem& p, std::string_view severity) {
  const std::string& file = p.file.empty() ? graph_ : p.file;
  nlohmann::ordered_json out = {{"severity", severity}, {"code", p.code}, {"file", file}};
  if (p.place.line > 0) {
    out["line"] = p.place.line;
    out["column"] = p.place.column;
    out["pointer"] = pointer(file, p.place);
  }
  if (!p.node.empty()) out["node"] = p.node;
  out["message"] = p.where.empty() ? p.message : p.where + ": " + p.message;
  return out;
}

}  // namespace terrazzo
