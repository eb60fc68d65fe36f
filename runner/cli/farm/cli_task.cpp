#include <csignal>
#include <filesystem>
#include <iostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/prctl.h>

#include "core/base/suggest.h"
#include "core/file/atomic_file.h"
#include "runner/api/session.h"
#include "runner/cli/cli_commands.h"
#include "runner/cli/farm/cli_farm.h"
#include "runner/farm/farm_folder.h"
#include "runner/farm/unit_run.h"
#include "runner/report/progress.h"
#include "runner/scheduler/supervisor.h"
#include "runner/terminal/console.h"
#include "runner/terminal/signals.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

struct TaskFlags {
  std::string job, array, cache, memory, stamp;
  std::vector<std::string> units;
  int index = 0, threads = 0;
  bool list = false, in_process = false;

  fs::path folder() const {
    return as_usage([&] { return FarmFolder(Cache::default_folder()).find_job(job); });
  }
  /// The job's folder is inside the cache that it uses.
  fs::path cache_of(const fs::path& folder) const {
    return cache.empty() ? FarmFolder::of_job(folder).root().parent_path() : fs::path(cache);
  }
};

using Json = nlohmann::ordered_json;

/// Lists results by content only, so that a repeated task writes the same.
void write_stamp(const fs::path& path, const Unit& unit, const UnitResult& result) {
  Json made = Json::object();
  for (const auto& [node, record] : result.made) {
    Json outputs = Json::object(), files = Json::array();
    for (const auto& [port, value] : record.outputs) outputs[port] = value.hex();
    for (const OutputFile& f : record.files)
      files.push_back({{"path", f.path.string()}, {"bytes", f.bytes}, {"digest", f.content.hex()}});
    made[node] = {{"outputs", outputs}, {"files", files}};
  }
  write_whole_file(path, Json{{"unit", unit.name}, {"made", made}}.dump(1) + "\n");
}

/// Runs one unit in this process, under a supervisor process.
int run_here(const TaskFlags& flags, const fs::path& folder, const FarmJob& job) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // it must not outlive its supervisor
  const Unit& unit = *job.find(flags.units.front());
  const CancelOnSignal signals;
  const std::unique_ptr<Progress> progress = make_progress(ProgressMode::plain, std::cerr, false);
  UnitRunOptions options{.cache = flags.cache_of(folder), .threads = flags.threads};
  options.memory = flags.memory.empty() ? 0 : parse_bytes(flags.memory, "--memory");
  options.cancelled = &signals.flag();
  options.observer = progress.get();
  try {
    const UnitResult result = run_unit(folder, job, unit, options);
    progress->closed(result.run);
    if (result.run.cancelled) return exit_cancelled;
    if (!result.run.ok()) throw Error(result.run.failures.front().message);
    if (!flags.stamp.empty()) write_stamp(flags.stamp, unit, result);
    return exit_done;
  } catch (const Error& e) {
    const std::string message = with_original_names(e.what(), job, folder);
    write_failure(folder, unit.name, {message, 0});
    throw Error(message);
  }
}

/// The command line of a process that runs one unit.
std::vector<std::string> words_for_unit(const TaskFlags& flags, const fs::path& cache, const FarmJob& job) {
  std::vector<std::string> words = {fs::read_symlink("/proc/self/exe").string()};
  for (const std::string& p : job.plugins) words.insert(words.end(), {"--plugin", p});
  words.insert(words.end(), {"task", "--in-process", "--cache", cache.string()});
  if (flags.threads > 0) words.insert(words.end(), {"--threads", std::to_string(flags.threads)});
  if (!flags.memory.empty()) words.insert(words.end(), {"--memory", flags.memory});
  if (!flags.stamp.empty()) words.insert(words.end(), {"--stamp", flags.stamp});
  return words;
}

/// Slurm's memory limit of the task in bytes; 0 if unknown.
uint64_t memory_given() {
  const char* megabytes = std::getenv("SLURM_MEM_PER_NODE");
  return megabytes ? std::strtoull(megabytes, nullptr, 10) << 20 : 0;
}

int list_units(const fs::path& folder, const FarmJob& job, const fs::path& cache_folder) {
  Session session({.cache = cache_folder});
  const LoadedGraph loaded = load_frozen(folder, job.document);
  const Plan plan = session.plan(loaded.graph, {.only = job.targets, .look_ahead = false});
  print_result("{}\n", state_json(folder, job, state_of(folder, job, plan, {})));
  return exit_done;
}

std::vector<std::string> units_meant(const TaskFlags& flags, const fs::path& folder, const FarmJob& job) {
  std::vector<std::string> units = flags.units;
  if (!flags.array.empty()) {
    const auto tasks = read_array(folder, flags.array);
    if (tasks.empty())
      throw UsageError(
          fmt::format("{} has no array {}, or its file is damaged; submit the same again, which writes it anew",
                      folder.string(), flags.array));
    if (size_t(flags.index) >= tasks.size())
      throw UsageError(fmt::format("--index {}: the array has tasks 0 to {}", flags.index, tasks.size() - 1));
    units = tasks[size_t(flags.index)];
  }
  if (units.empty()) throw UsageError("which unit? `terrazzo task JOB --list` lists them");
  std::vector<std::string> names;
  for (const Unit& u : job.units) names.push_back(u.name);
  for (const std::string& u : units)
    if (!job.find(u)) throw UsageError(fmt::format("job {} has no unit \"{}\"{}", job.name, u, suggestion(u, names)));
  if (!flags.stamp.empty() && units.size() != 1) throw UsageError("--stamp needs exactly one unit");
  return units;
}

int run_task(const TaskFlags& flags) {
  const fs::path folder = flags.folder();
  const FarmJob job = read_farm_job(folder);
  const fs::path cache = flags.cache_of(folder);
  if (flags.list) return list_units(folder, job, cache);
  const std::vector<std::string> units = units_meant(flags, folder, job);
  if (flags.in_process) return run_here(flags, folder, job);
  const CancelOnSignal signals;
  Supervision how{.words = words_for_unit(flags, cache, job), .costs = FarmFolder::of_job(folder).costs()};
  how.memory = memory_given();
  how.cancelled = &signals.flag();
  how.told = [](const std::string& text) { print_message("{}\n", text); };
  return run_units(folder, job, units, how);
}

}  // namespace

void add_task_command(Command& program) {
  Command& command =
      program.add_command("task", "Makes a unit of a job that `submit` has frozen; called by schedulers");
  const auto flags = std::make_shared<TaskFlags>();
  command.add_option("JOB", &flags->job, "The job's folder or name").required().takes("JOB");
  command.add_option("UNIT", &flags->units, "The units to make; --list shows all units and what they need")
      .takes("UNIT");
  command.add_option("--array", &flags->array, "What to make, as a task of one of the job's arrays")
      .takes("ID")
      .not_with("UNIT");
  command.add_option("--index", &flags->index, "The number of the task in the array")
      .takes("N")
      .only_with("--array")
      .not_negative();
  command.add_flag("--list", &flags->list, "Print the job's units, what they need and their states, as JSON");
  command
      .add_option("--stamp", &flags->stamp,
                  "Write the digests of the unit's results here when they are made, for Snakemake or Nextflow")
      .takes("FILE.json");
  command.add_option("--cache", &flags->cache, "Folder of the cache, if not the one that contains the job")
      .takes("DIR");
  command.add_option("--threads", &flags->threads, "Threads to use; one per core if not given")
      .takes("N")
      .from_to(1, 1024);
  command
      .add_option("--memory", &flags->memory,
                  "Memory for running nodes, such as 2G; half of the machine's if not given")
      .takes("SIZE");
  command.add_flag("--in-process", &flags->in_process, "").hidden();
  command.footer =
      "Examples:\n"
      "  terrazzo task bricks-1a2b3c4d5e6f --list\n"
      "  terrazzo task bricks-1a2b3c4d5e6f index --stamp done/index.json";
  command.run = [flags] { return run_task(*flags); };
}

}  // namespace terrazzo
