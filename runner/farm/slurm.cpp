#include "runner/farm/slurm.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdlib>
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

std::string last_line(const std::string& text) {
  const std::vector<std::string> lines = split(text, '\n');
  return lines.empty() ? "" : lines.back();
}

int number_in(const std::string& text, int otherwise) {
  int value = otherwise;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

using Clock = std::chrono::steady_clock;

/// How `scontrol ping` says whether a controller answers.
constexpr std::string_view mark_of_up = " is UP", mark_of_down = " is DOWN";

/// Slurm's default. The highest index is one less.
constexpr int usual_array_size = 1001;

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

/// Empty if the controller has answered, before or now.
std::string Slurm::why_unreachable() const {
  if (has_answered_) return "";
  const char* configuration = std::getenv("SLURM_CONF");
  std::error_code missing;
  if (configuration && !std::filesystem::is_regular_file(configuration, missing))
    return fmt::format("SLURM_CONF names {}, which is not there. Set it to the cluster's slurm.conf", configuration);
  const ToolResult ping = run_tool({"scontrol", "ping"});
  if (ping.exit_code == 127) return first_line(ping.err) + ". Slurm's tools must be on $PATH";
  has_answered_ = ping.out.find(mark_of_up) != ping.out.npos;
  if (has_answered_) return "";
  const std::string message = ping.out.empty() ? last_line(ping.err) : first_line(ping.out);
  if (!configuration)
    return message + ". SLURM_CONF is not set: set it to the cluster's slurm.conf, unless Slurm finds that by itself";
  return fmt::format("{}. SLURM_CONF is {}: it must be the cluster's slurm.conf, and slurmctld must run there", message,
                     configuration);
}

void Slurm::require_reachable() const {
  constexpr std::chrono::seconds patience{4};
  const auto last = Clock::now() + patience;
  for (std::string trouble = why_unreachable(); !trouble.empty(); trouble = why_unreachable()) {
    const bool may_come_back = trouble.find(mark_of_down) != trouble.npos;
    if (!may_come_back || Clock::now() > last)
      throw Error(fmt::format("cannot reach Slurm: {}. --print and --openjd need no Slurm", trouble));
    pause(std::chrono::seconds(1));
  }
}

void Slurm::pause(std::chrono::milliseconds time) const {
  for (const auto until = Clock::now() + time; Clock::now() < until;) {
    if (cancelled_ && *cancelled_) throw Cancelled();
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
}

/// Asks until there is an answer. What `is_done_already` returns counts as one, unless it is empty.
std::string Slurm::ask(const std::vector<std::string>& words,
                       const std::function<std::string()>& is_done_already) const {
  require_reachable();
  constexpr std::chrono::minutes patience{5};
  constexpr std::chrono::seconds first_pause{1}, longest_pause{30};
  const auto last = Clock::now() + patience;
  for (auto time = first_pause;; time = std::min(time * 2, longest_pause)) {
    const ToolResult result = run_tool(words);
    if (result.ok()) return result.out;
    const std::string message = fmt::format("{}: {}", words.front(), first_line(result.err));
    if (!is_transient(result.err) || Clock::now() + time > last) throw Error(message);
    if (told_ && time == first_pause) told_(message + "; asking again for some minutes");
    pause(time);
    if (is_done_already)
      if (std::string answer = is_done_already(); !answer.empty()) return answer;
  }
}

FarmLimits Slurm::limits(const SlurmOptions& options) const {
  FarmLimits limits{.tasks = usual_array_size};
  if (!why_unreachable().empty()) return limits;
  limits.tasks = max_array_size();
  std::vector<std::string> words = {"sinfo", "--noheader", "--Node", "--format=%c|%m|%P"};
  if (!options.partition.empty()) words.push_back("--partition=" + options.partition);
  const bool is_the_default = options.partition.empty() && options.more.empty() && !std::getenv("SBATCH_PARTITION");
  std::istringstream lines(ask(words));
  for (std::string line; std::getline(lines, line);) {
    const std::vector<std::string> parts = split(line, '|');
    if (parts.size() < 3 || (is_the_default && !parts[2].ends_with('*'))) continue;
    limits.cores = std::max(limits.cores, number_in(parts[0], 0));
    limits.memory = std::max(limits.memory, uint64_t(number_in(parts[1], 0)) << 20);
  }
  return limits;
}

int Slurm::max_array_size() const {
  std::istringstream lines(ask({"scontrol", "show", "config"}));
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with("MaxArraySize")) {
      const size_t equals = line.find_first_of("0123456789");
      if (equals != line.npos) return std::max(1, number_in(line.substr(equals), usual_array_size));
    }
  return usual_array_size;
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
