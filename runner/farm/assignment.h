#pragma once

#include <filesystem>
#include <string>

namespace terrazzo {

/// The scheduler that a job is assigned to, by the user's last command. Does not store the job's progress.
struct Assignment {
  enum class To : uint8_t {
    slurm,
    others,  ///< another scheduler, whose state is unknown here
    nobody,  ///< cancelled
  };
  To to = To::slurm;
  std::string file{};  ///< template written for another scheduler

  bool operator==(const Assignment&) const = default;
};

/// Reads the assignment from the job's folder; Slurm if there is none. Throws DamagedJob if the file is damaged.
Assignment assignment_of(const std::filesystem::path& folder);
/// Throws FileError.
void write_assignment(const std::filesystem::path& folder, const Assignment& assignment);

}  // namespace terrazzo
