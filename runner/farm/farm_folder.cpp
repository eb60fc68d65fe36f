#include "runner/farm/farm_folder.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/paths.h"
#include "core/base/suggest.h"
#include "core/file/atomic_file.h"
#include "core/file/file_io.h"

namespace terrazzo {

namespace fs = std::filesystem;

FarmFolder::FarmFolder(const fs::path& cache) : root_(without_trailing_slash(fs::absolute(cache)) / "farm") {}

FarmFolder FarmFolder::of_job(const fs::path& job) {
  return FarmFolder(without_trailing_slash(fs::absolute(job)).parent_path().parent_path().parent_path());
}

std::vector<std::string> FarmFolder::job_names() const {
  std::vector<std::string> names;
  std::error_code missing;
  for (const auto& entry : fs::directory_iterator(jobs(), missing))
    if (fs::exists(entry.path() / "job.json", missing)) names.push_back(entry.path().filename().string());
  std::ranges::sort(names);
  return names;
}

fs::path FarmFolder::find_job(const std::string& which) const {
  const auto is_job = [](const fs::path& folder) {
    std::error_code missing;
    const bool is_begun = fs::exists(folder / "graph.json", missing) && fs::is_directory(folder / "logs", missing);
    return !folder.empty() && (is_begun || fs::exists(folder / "job.json", missing));
  };
  if (is_job(which)) return without_trailing_slash(fs::absolute(which));
  if (!which.empty() && fs::path(which).filename() == which && is_job(jobs() / which)) return jobs() / which;
  const std::vector<std::string> names = job_names();
  std::vector<std::string> fitting;
  for (const std::string& n : names)
    if (n.starts_with(which) && !which.empty()) fitting.push_back(n);
  if (fitting.size() == 1) return jobs() / fitting.front();
  if (fitting.size() > 1)
    throw Error(fmt::format("\"{}\" is the beginning of several jobs: {}", which, fmt::join(fitting, ", ")));
  if (names.empty()) throw Error(fmt::format("\"{}\" is not a graph file, and {} has no jobs", which, root_.string()));
  throw Error(
      fmt::format("\"{}\" is neither a graph file nor a job in {}{}", which, root_.string(), suggestion(which, names)));
}

bool write_if_other(const fs::path& file, const std::string& text) {
  try {
    if (read_file(file, text.size()) == text) return false;
  } catch (const FileError&) {
    // Missing, too long or unreadable.
  }
  write_whole_file(file, text);
  return true;
}

}  // namespace terrazzo
