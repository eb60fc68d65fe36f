#pragma once

#include "core/node/node.h"

/// Helpers for nodes with a colour space parameter.
namespace terrazzo {

/// For NodeType::check: a message unless the parameter names a colour space of the configuration, or is `keyword`
/// ("auto", "keep").
std::vector<std::string> color_space_problems(const Params& params, const std::string& param,
                                              const std::string& keyword = "", const std::string& config = "");

/// The named colour space, resolved by canonical_color_space. Throws Error about the parameter if it is unknown.
std::string color_space_of(const NodeContext& node, const std::string& param, const std::string& config = "");

}  // namespace terrazzo
