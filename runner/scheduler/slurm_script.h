#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "runner/farm/arrays.h"
#include "runner/farm/farm_job.h"

/// Batch scripts for sbatch.
namespace terrazzo {

struct SlurmOptions {
  std::string partition{}, account{}, time{};  ///< as for sbatch; empty: the cluster's default
  std::vector<std::string> more{};             ///< further options of sbatch, such as --constraint=avx2
  std::filesystem::path program{};             ///< executed by tasks; absolute
};

/// Throws Error if an option would break the submission, such as --array, or if Slurm cannot write logs to jobs in
/// `jobs`.
void check_slurm_options(const SlurmOptions& options, const std::filesystem::path& jobs);

/// Prefix of the array's id in a batch job's comment.
inline constexpr std::string_view slurm_comment_mark = "terrazzo:";

/// The batch script of an array. `after`: ids of jobs that must end first.
std::string slurm_script(const FarmJob& job, const TaskArray& array, const std::filesystem::path& folder,
                         const std::vector<std::string>& after, const SlurmOptions& options);

}  // namespace terrazzo
