#include "runner/scheduler/slurm_script.h"

#include <algorithm>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/error.h"
#include "core/base/shell_words.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

/// An option of sbatch that the submission sets itself, or that would break it.
struct Reserved {
  std::string_view name, letter, why;
};

constexpr std::string_view found_by = "the job's tasks are found in the queue by it";
constexpr Reserved reserved_options[] = {
    {"--job-name", "-J", found_by},
    {"--comment", "", found_by},
    {"--array", "-a", "which tasks there are depends on the graph"},
    {"--clusters", "-M", "the queue of another cluster is not queried; set SLURM_CONF to that cluster's slurm.conf"},
    {"--wait", "-W", "sbatch would not return; `terrazzo submit --wait` waits"},
    {"--wrap", "", "the script is written already"},
    {"--test-only", "", "nothing would be submitted; --print shows the scripts"},
};

/// Parses a word like sbatch, which accepts unique prefixes of long names, and values directly after a letter.
bool is_option(std::string_view word, const Reserved& option) {
  constexpr size_t least = 4;  // shorter ones are ambiguous, and sbatch rejects them
  const std::string_view name = word.substr(0, word.find('='));
  if (name.starts_with("--")) return name.size() >= least && option.name.starts_with(name);
  return !option.letter.empty() && name.starts_with(option.letter);
}

bool has_control_character(std::string_view text) {
  return std::ranges::any_of(text, [](unsigned char c) { return c < ' '; });
}

/// Escapes patterns such as %j in a path for Slurm.
std::string without_patterns(const std::string& path) {
  std::string out;
  for (const char c : path) out += c == '%' ? "%%" : std::string(1, c);
  return out;
}

}  // namespace

void check_slurm_options(const SlurmOptions& options, const fs::path& jobs) {
  // Slurm expands nothing in a path that has a backslash, so all tasks of an array would write to one name.
  const std::string place = jobs.string();
  if (place.find('\\') != place.npos || has_control_character(place))
    throw Error(fmt::format(
        "Slurm cannot write logs into {}: it takes no backslash, line break or control character in their path; "
        "name a cache elsewhere with --cache",
        place));
  for (const auto& [name, value] : {std::pair("--partition", options.partition),
                                    std::pair("--account", options.account), std::pair("--time", options.time)})
    if (has_control_character(value)) throw Error(fmt::format("{}: expected one line, found several", name));
  for (const std::string& text : options.more) {
    if (!text.starts_with('-') || has_control_character(text))
      throw Error(
          fmt::format("--sbatch: expected an option of sbatch, such as --sbatch=--nice=100, found \"{}\"", text));
    std::istringstream words(text);
    for (std::string word; words >> word;)
      for (const Reserved& r : reserved_options)
        if (is_option(word, r)) throw Error(fmt::format("--sbatch={}: {} cannot be set: {}", text, r.name, r.why));
  }
}

std::string slurm_script(const FarmJob& job, const TaskArray& array, const fs::path& folder,
                         const std::vector<std::string>& after, const SlurmOptions& options) {
  const std::string id = array.id().hex();
  std::string graph = job.graph;
  std::ranges::replace(graph, '\n', ' ');  // a path may have several lines, and a comment has one
  std::string out = fmt::format("#!/bin/bash\n# {}: {}\n", graph, array.label);
  const auto option = [&](const std::string& text) { out += "#SBATCH " + text + "\n"; };
  option("--job-name=" + job.name);
  option(fmt::format("--comment={}{}", slurm_comment_mark, id));
  option(fmt::format("--array=0-{}", array.tasks.size() - 1));
  option(fmt::format("--ntasks=1 --cpus-per-task={}", array.cores));
  option(fmt::format("--mem={}M", (array.memory + (uint64_t{1} << 20) - 1) >> 20));
  // Tasks of a lost node are requeued; they find finished results in the cache.
  option("--requeue --open-mode=append");
  option("--output=" + shell_word(without_patterns((folder / "logs" / id.substr(0, 12)).string()) + ".%A_%a.log"));
  if (!options.partition.empty()) option("--partition=" + shell_word(options.partition));
  if (!options.account.empty()) option("--account=" + shell_word(options.account));
  if (!options.time.empty()) option("--time=" + shell_word(options.time));
  for (const std::string& m : options.more) option(m);
  // Not afterok: a failed job never satisfies it, and a job that the controller has forgotten always does. Tasks whose
  // units need a failed one report that and end; the others continue.
  if (!after.empty()) option(fmt::format("--dependency=afterany:{}", fmt::join(after, ":")));
  out += fmt::format("exec {} task {} --array {} --index \"$SLURM_ARRAY_TASK_ID\" --threads \"$SLURM_CPUS_PER_TASK\"\n",
                     shell_word(options.program.string()), shell_word(folder.string()), id);
  return out;
}

}  // namespace terrazzo
