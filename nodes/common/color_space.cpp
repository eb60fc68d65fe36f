#include "nodes/common/color_space.h"

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/image_io/color.h"

namespace terrazzo {

std::vector<std::string> color_space_problems(const Params& params, const std::string& param,
                                              const std::string& keyword, const std::string& config) {
  const std::string& name = std::get<std::string>(params.at(param));
  if (name == keyword) return {};
  try {
    canonical_color_space(name, config);
    return {};
  } catch (const Error& e) {
    const std::string instead = keyword.empty() ? "" : fmt::format("expected \"{}\" or a colour space; ", keyword);
    return {fmt::format("\"{}\": {}{}", param, instead, e.what())};
  }
}

std::string color_space_of(const NodeContext& node, const std::string& param, const std::string& config) {
  try {
    return canonical_color_space(node.text(param), config);
  } catch (const Error& e) {
    throw Error(param, e.what());
  }
}

}  // namespace terrazzo
