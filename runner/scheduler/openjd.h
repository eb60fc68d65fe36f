#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "runner/farm/arrays.h"
#include "runner/farm/farm_job.h"

namespace terrazzo {

/// A job as an Open Job Description template in JSON, for Deadline Cloud and other schedulers that support it (Open Job
/// Description specification, "2023-09 Template Schemas"). Each array is a step, each of its members a task.
std::string openjd_template(const FarmJob& job, const std::vector<TaskArray>& arrays,
                            const std::filesystem::path& folder, const std::filesystem::path& program);

}  // namespace terrazzo
