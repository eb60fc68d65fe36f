#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/error.h"

/// Files that a farm's machines share besides the cache, in the cache's folder:
///   farm/inputs/<digest>/...          frozen input files, never changed, shared by all jobs
///   farm/costs/<digest>.json          runner/farm/costs.h
///   farm/jobs/<name>/graph.json       runner/farm/frozen_graph.h
///   farm/jobs/<name>/job.json         runner/farm/farm_job.h
///   farm/jobs/<name>/assignment.json  runner/farm/assignment.h
///   farm/jobs/<name>/arrays/          the units of each task (runner/scheduler/job_state.h), and Slurm's scripts
///   farm/jobs/<name>/failures/        runner/farm/farm_job.h
///   farm/jobs/<name>/logs/            output of tasks
namespace terrazzo {

/// The inputs' folder relative to a job's folder.
inline std::filesystem::path inputs_from_job() {
  return std::filesystem::path("../../inputs");
}

/// The folder `farm`. Creates nothing.
class FarmFolder {
 public:
  /// `cache`: the cache's folder.
  explicit FarmFolder(const std::filesystem::path& cache);
  /// The farm folder that contains a job's folder.
  static FarmFolder of_job(const std::filesystem::path& job);

  const std::filesystem::path& root() const { return root_; }
  std::filesystem::path inputs() const { return root_ / "inputs"; }
  std::filesystem::path costs() const { return root_ / "costs"; }
  std::filesystem::path jobs() const { return root_ / "jobs"; }
  /// The jobs' names, sorted.
  std::vector<std::string> job_names() const;
  /// The folder of the job given by its name, a unique prefix of it, or its folder; works even if its document is lost.
  /// Throws Error that lists the jobs.
  std::filesystem::path find_job(const std::string& which) const;

 private:
  std::filesystem::path root_;  ///< absolute
};

/// A file in a job's folder is damaged or was altered.
class DamagedJob : public Error {
 public:
  /// `what`: a sentence that names the file.
  explicit DamagedJob(const std::string& what) : Error(what + "; submit the same again, which mends it") {}
};

/// Writes a file unless it already holds this text; returns whether it wrote. Throws FileError.
bool write_if_other(const std::filesystem::path& file, const std::string& text);

}  // namespace terrazzo
