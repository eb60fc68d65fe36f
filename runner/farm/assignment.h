#pragma once

#include <filesystem>
#include <string>

namespace terrazzo {

/// Who is to make a job, as the user said last. How far it is, is not stored.
struct Assignment {
  enum class To : uint8_t {
    slurm,
    others,  ///< another scheduler, which alone knows what it is doing
    nobody,  ///< it was cancelled
  };
  To to = To::slurm;
  std::string file{};  ///< the template that was written for another scheduler

  bool operator==(const Assignment&) const = default;
};

/// Slurm's, unless something else is noted in the job's folder. Throws DamagedJob if the note is damaged.
Assignment assignment_of(const std::filesystem::path& folder);
/// Throws FileError.
void write_assignment(const std::filesystem::path& folder, const Assignment& assignment);

}  // namespace terrazzo
