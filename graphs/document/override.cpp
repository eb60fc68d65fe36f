#include "graphs/document/override.h"

#include "graphs/document/json.h"

namespace terrazzo {

Diagnostics Override::diagnostics(std::vector<Problem>& all) const {
  return Diagnostics(all, where_of_override(spelled)).from_command_line();
}

std::string where_of_override(const std::string& spelled) {
  return "override " + in_quotes(spelled);
}

std::vector<Override> read_overrides(const std::vector<std::string>& texts, std::vector<Problem>& problems) {
  std::vector<Override> out;
  for (const std::string& text : texts) {
    Override o{.spelled = text, .node = "", .name = "", .value = ""};
    const size_t equals = text.find('=');
    const std::string target = text.substr(0, equals);
    const size_t dot = target.find('.');
    if (dot != target.npos) o.node = target.substr(0, dot);
    o.name = dot == target.npos ? target : target.substr(dot + 1);
    if (equals == text.npos || o.name.empty() || (dot != target.npos && o.node.empty())) {
      o.diagnostics(problems).add({}, "expected name=value for a graph's parameter, or node.parameter=value");
      continue;
    }
    o.value = text.substr(equals + 1);
    out.push_back(std::move(o));
  }
  return out;
}

}  // namespace terrazzo
