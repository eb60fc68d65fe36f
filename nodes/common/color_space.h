#pragma once

#include "core/node/node.h"

/// What nodes with a parameter that names a colour space share.
namespace terrazzo {

/// For NodeType::check: a message unless the parameter names a colour space of the configuration, or is `keyword`
/// ("auto", "keep").
std::vector<std::string> color_space_problems(const Params& params, const std::string& param,
                                              const std::string& keyword = "", const std::string& config = "");

/// The named colour space, as canonical_color_space calls it. Throws Error about the parameter if there is none.
std::string color_space_of(const NodeContext& node, const std::string& param, const std::string& config = "");

}  // namespace terrazzo
