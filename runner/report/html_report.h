#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "runner/engine/schedule.h"

/// A run told on one page that needs no other file: what ran and why, how long it took, notes, figures and pictures.
namespace terrazzo {

/// The nodes whose values a report shows: the targets (sinks, or `only`) and what sinks read. To be kept by the run.
std::vector<std::string> nodes_for_report(const Graph& graph, const std::vector<std::string>& only);

/// Writes the page. `plan` is the one that was run; pictures are those of `result.kept`. Throws Error if the file
/// cannot be written.
void write_html_report(const Plan& plan, const RunResult& result, const std::filesystem::path& path);

/// Writes one report as such a page: its figures, and its pictures large. Throws Error if the file cannot be written.
void write_report_page(const Report& report, const std::filesystem::path& path);

}  // namespace terrazzo
