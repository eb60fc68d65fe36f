#pragma once

#include <string>

#include "core/node/report.h"

namespace terrazzo {

/// A report as JSON: {"title": ..., "figures": [{"name": ..., "value": ..., "help": ...}], "pictures": ["name"]}.
std::string report_as_json(const Report& report);
/// A report as CSV with the columns name, value, help.
std::string report_as_csv(const Report& report);

}  // namespace terrazzo
