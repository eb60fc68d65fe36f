#pragma once

#include <string>
#include <vector>

#include "graphs/text/json.h"

namespace terrazzo {

/// Describes the differences between two graph documents, one line each: 'node "layout": quality "draft" -> "best"'.
/// Ignores the order of entries, comments and spaces. Detects renamed nodes.
std::vector<std::string> differences(const JsonValue& before, const JsonValue& after);

}  // namespace terrazzo
