#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/error.h"

/// What a farm's machines share besides the cache, in a folder of it:
///   farm/inputs/<digest>/...       frozen input files, never changed, shared by all jobs
///   farm/costs/<digest>.json       runner/farm/costs.h
///   farm/jobs/<name>/graph.json    runner/farm/frozen_graph.h
///   farm/jobs/<name>/job.json      runner/farm/farm_job.h
///   farm/jobs/<name>/assignment.json  runner/farm/assignment.h
///   farm/jobs/<name>/arrays/       runner/scheduler/job_state.h: which units a task makes; the scripts of Slurm's
///   tasks farm/jobs/<name>/failures/     runner/farm/farm_job.h farm/jobs/<name>/logs/         what tasks print
namespace terrazzo {

/// From a job's folder to the inputs.
inline std::filesystem::path inputs_from_job() {
  return std::filesystem::path("../../inputs");
}

/// The folder itself. Makes nothing.
class FarmFolder {
 public:
  /// Of a cache's folder.
  explicit FarmFolder(const std::filesystem::path& cache);
  /// That a job's folder lies in.
  static FarmFolder of_job(const std::filesystem::path& job);

  const std::filesystem::path& root() const { return root_; }
  std::filesystem::path inputs() const { return root_ / "inputs"; }
  std::filesystem::path costs() const { return root_ / "costs"; }
  std::filesystem::path jobs() const { return root_ / "jobs"; }
  /// The jobs' names, sorted.
  std::vector<std::string> job_names() const;
  /// The folder of the job that this stands for: its name, a beginning of it that no other has, or its folder; also if
  /// its document is lost. Throws Error that says what there is.
  std::filesystem::path find_job(const std::string& which) const;

 private:
  std::filesystem::path root_;  ///< absolute
};

/// Something in a job's folder is not what was written there.
class DamagedJob : public Error {
 public:
  /// `what`: a sentence that names the file.
  explicit DamagedJob(const std::string& what) : Error(what + "; submit the same again, which mends it") {}
};

/// Writes a file unless it holds this text already; returns whether it wrote. Throws FileError.
bool write_if_other(const std::filesystem::path& file, const std::string& text);

}  // namespace terrazzo
