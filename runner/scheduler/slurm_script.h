#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "runner/farm/arrays.h"
#include "runner/farm/farm_job.h"

/// The batch scripts that sbatch gets.
namespace terrazzo {

struct SlurmOptions {
  std::string partition{}, account{}, time{};  ///< as sbatch takes them; empty: as the cluster has it
  std::vector<std::string> more{};             ///< further options of sbatch, such as --constraint=avx2
  std::filesystem::path program{};             ///< of tasks; absolute
};

/// Throws Error if an option would break the submission, such as --array, or if Slurm cannot write logs into jobs that
/// lie in `jobs`.
void check_slurm_options(const SlurmOptions& options, const std::filesystem::path& jobs);

/// Before the array's id in a batch job's comment.
inline constexpr std::string_view slurm_comment_mark = "terrazzo:";

/// What a batch job of this array runs. `after`: ids of jobs that must have ended before.
std::string slurm_script(const FarmJob& job, const TaskArray& array, const std::filesystem::path& folder,
                         const std::vector<std::string>& after, const SlurmOptions& options);

}  // namespace terrazzo
