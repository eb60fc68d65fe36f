#pragma once

#include <string>
#include <vector>

#include "graphs/text/json.h"

namespace terrazzo {

/// What differs between two graph documents, in words, one line each: 'node "layout": quality "draft" -> "best"'. The
/// order of entries, comments and spaces do not count. A node that is only called something else is said to be renamed.
std::vector<std::string> differences(const JsonValue& before, const JsonValue& after);

}  // namespace terrazzo
