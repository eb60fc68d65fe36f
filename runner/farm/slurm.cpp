#include "runner/farm/slurm.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <sstream>
#include <thread>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/shell_words.h"
#include "core/base/task.h"
#include "runner/farm/run_tool.h"

namespace terrazzo {

namespace {

/// How the tools say that asking again may help.
bool is_transient(const std::string& message) {
  constexpr std::string_view signs[] = {"Unable to contact slurm controller",
                                        "Socket timed out",
                                        "Connection refused",
                                        "Connection reset",
                                        "Connection timed out",
                                        "temporarily un",
                                        "Slurm controller not responding",
                                        "Transport endpoint is not connected",
                                        "Zero Bytes were transmitted"};
  return std::ranges::any_of(signs, [&](std::string_view s) { return message.find(s) != message.npos; });
}

std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

std::vector<std::string> split(const std::string& line, char at) {
  std::vector<std::string> parts;
  std::istringstream stream(line);
  for (std::string part; std::getline(stream, part, at);) parts.push_back(part);
  return parts;
}

int number_in(const std::string& text, int otherwise) {
  int value = otherwise;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

constexpr std::string_view comment_mark = "terrazzo:";

}  // namespace

std::string slurm_script(const FarmJob& job, const TaskArray& array, const std::filesystem::path& folder,
                         const std::vector<std::string>& after, const SlurmOptions& options) {
  const std::string id = array.id().hex();
  std::string out = fmt::format("#!/bin/bash\n# {}: {}\n", job.graph, array.label);
  const auto option = [&](const std::string& text) { out += "#SBATCH " + text + "\n"; };
  option("--job-name=" + job.name);
  option(fmt::format("--comment={}{}", comment_mark, id));
  option(fmt::format("--array=0-{}", array.tasks.size() - 1));
  option(fmt::format("--ntasks=1 --cpus-per-task={}", array.cores));
  option(fmt::format("--mem={}M", (array.memory + (uint64_t{1} << 20) - 1) >> 20));
  // A node that is lost gives its tasks back; they find what has been made in the cache.
  option("--requeue --open-mode=append");
  option("--output=" + shell_word((folder / "logs" / (id.substr(0, 12) + ".%A_%a.log")).string()));
  if (!options.partition.empty()) option("--partition=" + options.partition);
  if (!options.account.empty()) option("--account=" + options.account);
  if (!options.time.empty()) option("--time=" + options.time);
  for (const std::string& m : options.more) option(m);
  // Tasks whose units need one that failed say so and end; the others go on.
  if (!after.empty()) option(fmt::format("--dependency=afterany:{}", fmt::join(after, ":")));
  out += fmt::format("exec {} task {} --array {} --index \"$SLURM_ARRAY_TASK_ID\" --threads \"$SLURM_CPUS_PER_TASK\"\n",
                     shell_word(options.program.string()), shell_word(folder.string()), id);
  return out;
}

Slurm::Slurm(std::function<void(const std::string&)> told, const std::atomic<bool>* cancelled)
    : told_(std::move(told)), cancelled_(cancelled) {}

/// Asks until there is an answer. What `is_done_already` returns counts as one, unless it is empty.
std::string Slurm::ask(const std::vector<std::string>& words,
                       const std::function<std::string()>& is_done_already) const {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::minutes patience{5};
  constexpr std::chrono::seconds first_pause{1}, longest_pause{30};
  const auto last = Clock::now() + patience;
  for (auto pause = first_pause;; pause = std::min(pause * 2, longest_pause)) {
    const ToolResult result = run_tool(words);
    if (result.ok()) return result.out;
    const std::string message = fmt::format("{}: {}", words.front(), first_line(result.err));
    if (result.exit_code == 127)
      throw Error(message + ". Slurm's tools must be on $PATH; --print shows the scripts without them");
    if (!is_transient(result.err) || Clock::now() + pause > last) throw Error(message);
    if (told_ && pause == first_pause) told_(message + "; asking again for some minutes");
    for (const auto until = Clock::now() + pause; Clock::now() < until;) {
      if (cancelled_ && *cancelled_) throw Cancelled();
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    if (is_done_already)
      if (std::string answer = is_done_already(); !answer.empty()) return answer;
  }
}

int Slurm::max_array_size() const {
  constexpr int usual = 1001;  // Slurm's default; the highest index is one less
  const ToolResult probe = run_tool({"scontrol", "--version"});
  if (!probe.ok()) return usual;
  std::istringstream lines(ask({"scontrol", "show", "config"}));
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with("MaxArraySize")) {
      const size_t equals = line.find_first_of("0123456789");
      if (equals != line.npos) return std::max(1, number_in(line.substr(equals), usual));
    }
  return usual;
}

std::vector<QueuedTask> Slurm::queued(const std::string& job) const {
  std::vector<QueuedTask> tasks;
  std::istringstream lines(ask({"squeue", "--array", "--noheader", "--name=" + job, "--format=%i|%K|%t|%k|%N|%r"}));
  for (std::string line; std::getline(lines, line);) {
    const std::vector<std::string> parts = split(line, '|');
    if (parts.size() < 6 || !parts[3].starts_with(comment_mark)) continue;
    const bool is_running = parts[2] == "R" || parts[2] == "CG" || parts[2] == "CF";
    tasks.push_back({parts[0], parts[3].substr(comment_mark.size()), number_in(parts[1], 0), is_running,
                     is_running ? parts[4] : parts[5]});
  }
  return tasks;
}

std::string Slurm::submit(const std::filesystem::path& script, const std::string& job, const std::string& array) const {
  const auto taken = [&]() -> std::string {
    for (const QueuedTask& t : queued(job))
      if (t.array == array) return t.id.substr(0, t.id.find('_'));
    return "";
  };
  const std::string answer = ask({"sbatch", "--parsable", script.string()}, taken);
  return answer.substr(0, answer.find_first_of(";\n"));
}

void Slurm::cancel(const std::string& job) const {
  ask({"scancel", "--name=" + job});
}

}  // namespace terrazzo
