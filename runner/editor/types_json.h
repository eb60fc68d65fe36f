#pragma once

#include <nlohmann/json.hpp>

#include "graphs/values/parameters.h"

namespace terrazzo {

/// {"types": [...], "graphs": [...], "categories": [...], "uses": {type: {"count", "behind": {type: count}}}}: what
/// nodes can be made of, and how the stock graphs use it.
const nlohmann::ordered_json& types_json();

/// A parameter of a graph as the page knows those of nodes, with its group and its condition.
nlohmann::ordered_json parameter_as_json(const GraphParameter& parameter);

}  // namespace terrazzo
