#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/node/node.h"
#include "graphs/text/json.h"

namespace terrazzo {

/// Replaces the document's declared inputs by nodes, with the types given by input name, so that the graph can run on
/// its own. Ignores unknown names and returns the used ones.
std::vector<std::string> give_inputs(JsonValue& document, const std::map<std::string, const NodeType*>& types);

}  // namespace terrazzo
