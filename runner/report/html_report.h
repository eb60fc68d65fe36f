#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "runner/engine/schedule.h"

/// Self-contained HTML pages about runs, reports and sweeps, which open from the file system.
namespace terrazzo {

/// Writes the page of a run: the lit material, exemplars beside results, the graph, settings, figures, uv maps, times,
/// and what each node did and why. `plan`: the one that ran; pictures come from `result.kept` (see nodes_for_report).
/// Throws Error if the file cannot be written.
void write_html_report(const Plan& plan, const RunResult& result, const std::filesystem::path& path);

/// Writes the page of one report: its figures, and large pictures. Throws Error if the file cannot be written.
void write_report_page(const Report& report, const std::filesystem::path& path);

/// Writes a page about variations of a graph or similar items: `table` holds a header and one row per item, each with a
/// picture. The table and its pictures can be sorted. Throws Error if the file cannot be written.
void write_variations_page(const std::string& title, const std::vector<std::vector<std::string>>& table,
                           const std::vector<Report::Picture>& pictures, const std::filesystem::path& path);

}  // namespace terrazzo
