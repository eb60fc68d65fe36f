#include "runner/scheduler/slurm.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <sstream>
#include <thread>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include "core/base/error.h"
#include "core/base/task.h"
#include "core/base/text.h"
#include "runner/scheduler/run_tool.h"

namespace terrazzo {

namespace {

/// Messages of the tools after which a retry may help.
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

/// Output of `scontrol ping` that tells whether a controller answers.
constexpr std::string_view mark_of_up = " is UP", mark_of_down = " is DOWN";

/// Slurm's default. The highest index is one less.
constexpr int usual_array_size = 1001;

/// Variables for users' own calls of Slurm's tools: filters for listing and cancelling, options that override those of
/// batch scripts, and variables of an enclosing job.
bool is_setting_of_tools(std::string_view variable) {
  constexpr std::string_view beginnings[] = {"SLURM",  "_SLURM", "SBATCH_", "SQUEUE_", "SCANCEL_", "SCONTROL_",
                                             "SINFO_", "SACCT_", "SALLOC_", "SRUN_",   "SPANK_"};
  return std::ranges::any_of(beginnings, [&](std::string_view b) { return variable.starts_with(b); });
}

/// Variables for the choice of cluster and for authentication.
bool leads_to_cluster(std::string_view variable) {
  constexpr std::string_view names[] = {"SLURM_CONF", "SLURM_CONF_SERVER", "SLURM_JWT"};
  return std::ranges::find(names, variable) != std::end(names);
}

/// All calls of Slurm's tools.
ToolResult run_slurm(const std::vector<std::string>& words) {
  return run_tool(words, [](std::string_view v) { return leads_to_cluster(v) || !is_setting_of_tools(v); });
}

bool is_number(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == text.npos;
}

}  // namespace

Slurm::Slurm(std::function<void(const std::string&)> told, const std::atomic<bool>* cancelled)
    : told_(std::move(told)), cancelled_(cancelled) {}

/// Empty if the controller has answered, before or now.
std::string Slurm::why_unreachable() const {
  if (has_answered_) return "";
  const char* configuration = std::getenv("SLURM_CONF");
  std::error_code missing;
  if (configuration && !std::filesystem::is_regular_file(configuration, missing))
    return fmt::format("SLURM_CONF names {}, which does not exist. Set it to the cluster's slurm.conf", configuration);
  const ToolResult ping = run_slurm({"scontrol", "ping"});
  if (ping.exit_code == 127) return first_line(ping.err) + ". Slurm's tools must be on $PATH";
  has_answered_ = ping.out.find(mark_of_up) != ping.out.npos;
  if (has_answered_) return "";
  const std::string message = ping.out.empty() ? last_line(ping.err) : first_line(ping.out);
  if (!configuration)
    return message + ". SLURM_CONF is not set: set it to the cluster's slurm.conf, unless Slurm finds it without";
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

/// Retries until there is an answer. A non-empty result of `is_done_already` counts as one.
std::string Slurm::ask(const std::vector<std::string>& words,
                       const std::function<std::string()>& is_done_already) const {
  require_reachable();
  constexpr std::chrono::minutes patience{5};
  constexpr std::chrono::seconds first_pause{1}, longest_pause{30};
  const auto last = Clock::now() + patience;
  for (auto time = first_pause;; time = std::min(time * 2, longest_pause)) {
    const ToolResult result = run_slurm(words);
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
  std::vector<std::string> words = {"sinfo", "--all", "--noheader", "--Node", "--format=%c|%m|%P"};
  if (!options.partition.empty()) words.push_back("--partition=" + options.partition);
  const bool is_the_default = options.partition.empty() && options.more.empty();
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
  // Includes hidden partitions.
  std::istringstream lines(
      ask({"squeue", "--all", "--array", "--noheader", "--name=" + job, "--format=%i|%K|%t|%k|%N|%r|%u"}));
  for (std::string line; std::getline(lines, line);) {
    const std::vector<std::string> parts = split(line, '|');
    if (parts.size() < 7 || !parts[3].starts_with(slurm_comment_mark)) continue;
    const bool is_running = parts[2] == "R" || parts[2] == "CG" || parts[2] == "CF";
    tasks.push_back({.id = parts[0],
                     .array = parts[3].substr(slurm_comment_mark.size()),
                     .index = number_in(parts[1], 0),
                     .is_running = is_running,
                     .is_ending = parts[2] == "CG",
                     .reason = is_running ? parts[4] : parts[5],
                     .user = parts[6]});
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
  const std::string id = answer.substr(0, answer.find_first_of(";\n"));
  if (!is_number(id))
    throw Error(
        fmt::format("sbatch: expected the number of the batch job, found \"{}\"; whether it was taken is shown "
                    "by `terrazzo submit {} --status`",
                    first_line(answer), job));
  return id;
}

void Slurm::cancel(const std::string& job) const {
  constexpr std::chrono::seconds patience{10};
  constexpr size_t most_shown = 5;
  const auto last = Clock::now() + patience;
  for (;;) {
    std::string said;
    try {
      ask({"scancel", "--name=" + job});
    } catch (const Error& e) {
      said = fmt::format("; {}", e.what());
    }
    // The exit code of scancel is no evidence: it also succeeds if it cancels nothing.
    std::vector<std::string> left;
    for (const QueuedTask& t : queued(job))
      if (!t.is_ending) left.push_back(fmt::format("{} of {}", t.id, t.user));
    if (left.empty()) return;
    if (Clock::now() > last) {
      const size_t count = left.size();
      if (count > most_shown) left.resize(most_shown);
      throw Error(fmt::format("{} of {} still in the queue after {} seconds: {}{}{}", counted(int64_t(count), "task"),
                              job + (count == 1 ? " is" : " are"), patience.count(), fmt::join(left, ", "),
                              count > most_shown ? ", ..." : "", said));
    }
    pause(std::chrono::seconds(1));
  }
}

std::vector<std::string> ignored_slurm_settings() {
  std::vector<std::string> out;
  for (char** v = environ; *v; v++) {
    const std::string_view text = *v, name = text.substr(0, text.find('='));
    if (name.starts_with("SBATCH_") || name == "SLURM_CLUSTERS") out.emplace_back(name);
  }
  std::ranges::sort(out);
  return out;
}

}  // namespace terrazzo
