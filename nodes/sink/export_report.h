#pragma once

#include <string>

#include "core/node/report.h"

namespace terrazzo {

/// A report as JSON: {"title": ..., "figures": [{"name": ..., "value": ..., "help": ...}], "pictures": ["name"]}.
std::string report_as_json(const Report& report);
/// A figure's value as text; numbers in their shortest spelling.
std::string value_text(const Report::Figure& figure);
/// A cell of a CSV file, quoted if necessary (RFC 4180).
std::string csv_field(const std::string& text);
/// A report as CSV with the columns name, value, help.
std::string report_as_csv(const Report& report);

}  // namespace terrazzo
