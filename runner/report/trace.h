#pragma once

#include <filesystem>

#include "runner/engine/schedule.h"

namespace terrazzo {

/// Writes a timeline of all workers in the Chrome trace format (chrome://tracing, ui.perfetto.dev). Throws Error if the
/// file cannot be written.
void write_trace(const RunResult& result, const std::filesystem::path& path);

}  // namespace terrazzo
