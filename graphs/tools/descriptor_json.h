#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "core/node/node.h"
#include "graphs/text/json.h"

/// The descriptors of node types as JSON, for programs. Their order of members is fixed.
namespace terrazzo {

nlohmann::ordered_json json_of_port(const Port& port);
nlohmann::ordered_json json_of_param(const Param& param);
nlohmann::ordered_json json_of_type(const NodeType& type);

/// A value of a document.
nlohmann::ordered_json json_of_value(const JsonValue& value);

/// In the order of the workflow; other categories come last.
std::vector<std::string> categories_of(const std::vector<NodeType>& types);

}  // namespace terrazzo
