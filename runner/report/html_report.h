#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "runner/engine/schedule.h"

/// Self-contained HTML pages: what ran and why, times, notes, figures and pictures.
namespace terrazzo {

/// The nodes whose values a report shows: the targets (sinks, or `only`) and what sinks read. Pass them as
/// PlanOptions::keep.
std::vector<std::string> nodes_for_report(const Graph& graph, const std::vector<std::string>& only);

/// Writes the page of a run. `plan`: the one that ran; pictures come from `result.kept`. Throws Error if the file
/// cannot be written.
void write_html_report(const Plan& plan, const RunResult& result, const std::filesystem::path& path);

/// Writes the page of one report: its figures, and large pictures. Throws Error if the file cannot be written.
void write_report_page(const Report& report, const std::filesystem::path& path);

}  // namespace terrazzo
