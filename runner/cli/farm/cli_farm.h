#pragma once

#include <filesystem>
#include <string>

#include "runner/cli/cli_commands.h"
#include "runner/scheduler/job_state.h"

/// Helpers for the farm commands.
namespace terrazzo {

void add_submit_command(Command& program);
void add_task_command(Command& program);

/// "41 of 65 done, 4 running, 20 waiting".
std::string state_line(const JobState& state);
/// The same and all units, as compact JSON.
std::string state_json(const std::filesystem::path& folder, const FarmJob& job, const JobState& state);

}  // namespace terrazzo
