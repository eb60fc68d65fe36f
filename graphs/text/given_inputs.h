#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/node/node.h"
#include "graphs/text/json.h"

namespace terrazzo {

/// Makes a node of these types of each input that the document declares, by the inputs' names, so that the graph runs
/// by itself. Other names are left alone. Returns those that were used.
std::vector<std::string> give_inputs(JsonValue& document, const std::map<std::string, const NodeType*>& types);

}  // namespace terrazzo
