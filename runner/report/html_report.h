#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "runner/engine/schedule.h"

/// Self-contained HTML pages, which open from the file system: about runs, reports and sweeps.
namespace terrazzo {

/// Writes the page of a run: the material lit, exemplars beside results, the drawn graph, how it was run, figures, uv
/// maps, times, and what each node did and why. `plan`: the one that ran; pictures come from `result.kept` (see
/// nodes_for_report). Throws Error if the file cannot be written.
void write_html_report(const Plan& plan, const RunResult& result, const std::filesystem::path& path);

/// Writes the page of one report: its figures, and large pictures. Throws Error if the file cannot be written.
void write_report_page(const Report& report, const std::filesystem::path& path);

/// Writes the page of many variations of a graph, or of other things of a kind: `table` holds a head and a row for
/// each, with a picture beside it. The table sorts itself, and the pictures with it. Throws Error if the file cannot be
/// written.
void write_variations_page(const std::string& title, const std::vector<std::vector<std::string>>& table,
                           const std::vector<Report::Picture>& pictures, const std::filesystem::path& path);

}  // namespace terrazzo
