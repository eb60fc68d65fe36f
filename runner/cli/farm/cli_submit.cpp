#include <algorithm>
#include <filesystem>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/text.h"
#include "core/file/atomic_file.h"
#include "graphs/document/load.h"
#include "runner/api/plugin.h"
#include "runner/api/session.h"
#include "runner/cli/cli_commands.h"
#include "runner/cli/cli_graph.h"
#include "runner/cli/cli_sweep.h"
#include "runner/cli/farm/cli_farm.h"
#include "runner/cli/farm/submit_flags.h"
#include "runner/farm/left_out.h"
#include "runner/plan/preflight.h"
#include "runner/scheduler/openjd.h"
#include "runner/scheduler/submission.h"
#include "runner/terminal/console.h"
#include "runner/terminal/signals.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

void tell(const std::string& text) {
  print_message("{}\n", text);
}

Graph graph_of(const SubmitFlags& flags, std::vector<std::string>& only) {
  const LoadOptions options{.only = flags.only, .keep_going = flags.keep_going, .look_ahead = preflight_of_nodes};
  only = flags.only;
  if (!flags.variations.asked()) {
    LoadedGraph loaded = flags.load(options);
    for (const std::string& w : shown_warnings(flags.graph, loaded.warnings)) tell("warning: " + w);
    return std::move(loaded.graph);
  }
  Sweep sweep(flags.variations);
  Graph graph = sweep.load(flags, options, [](const std::string& text) { tell("warning: " + text); });
  only = sweep.names_of(flags.only);
  return graph;
}

/// The reasons for left-out nodes; at most the first few.
std::string lines_of(const std::map<std::string, std::string>& left_out) {
  std::vector<std::string> lines;
  for (const auto& [node, why] : left_out)
    if (lines.size() < most_problems_shown) lines.push_back("left out: " + why);
  if (const std::string more = problems_not_shown(left_out.size(), "node"); !more.empty()) lines.push_back(more);
  return fmt::format("{}", fmt::join(lines, "\n"));
}

/// The job described by the flags, not written yet. Throws Error if no target can be computed.
PreparedJob prepared_job(const SubmitFlags& flags, Session& session) {
  std::vector<std::string> only;
  Graph graph = graph_of(flags, only);
  RunRequest request{.only = only, .keep_going = flags.keep_going};
  Plan plan = as_usage([&] { return session.plan(graph, request); });
  const LeftOut left_out = left_out_of(plan);
  if (!left_out.nodes.empty()) {
    if (left_out.targets.empty())
      throw Error(fmt::format("{}\nnothing can be made without that", lines_of(left_out.why)));
    take_out(left_out, graph);
    request.only = left_out.targets;
    plan = session.plan(graph, request);
  }
  std::vector<std::string> plugins;
  for (const LoadedPlugin& p : loaded_plugins()) plugins.push_back(fs::absolute(p.file).string());
  return prepared(plan, *session.cache(), plugins, left_out.why);
}

/// The requested resources, "1.5 GiB", "12 s".
Table table_of(const std::vector<TaskArray>& arrays, const std::vector<std::string>& ids) {
  Table table = {{"array", "tasks", "cores", "memory", "after", "expected"}};
  if (!ids.empty()) table.front().push_back("batch job");
  for (size_t i = 0; i < arrays.size(); i++) {
    const TaskArray& a = arrays[i];
    std::vector<std::string> needs;
    for (const size_t n : a.needs) needs.push_back(std::to_string(n + 1));
    table.push_back({fmt::format("{} {}", i + 1, a.label), std::to_string(a.tasks.size()), std::to_string(a.cores),
                     shown_bytes(a.memory), fmt::format("{}", fmt::join(needs, ", ")),
                     a.seconds > 0 ? fmt::format("{:.0f} s", std::max(1.0, a.seconds)) : ""});
    if (!ids.empty()) table.back().push_back(ids[i]);
  }
  return table;
}

/// The flags with Slurm's limits: tasks that request more would wait forever.
ArrayOptions options_for(const SubmitFlags& flags, const Slurm& slurm) {
  ArrayOptions options = flags.arrays;
  const FarmLimits& limits = options.limits = slurm.limits(flags.slurm);
  if (limits.cores > 0 && options.cores > limits.cores)
    throw UsageError(fmt::format("--cores {}: the largest node that Slurm can give has {}; ask for at most that many",
                                 options.cores, counted(limits.cores, "core")));
  if (limits.memory > 0 && options.memory > limits.memory)
    throw UsageError(fmt::format("--memory {}: the largest node that Slurm can give has {}; ask for at most that much",
                                 flags.memory, shown_bytes(limits.memory)));
  return options;
}

/// The arrays that would be submitted if the queue is empty.
std::vector<TaskArray> arrays_of_job(const PreparedJob& prepared, const ArrayOptions& options) {
  return arrays_of(prepared.job.units, prepared.due, FarmFolder::of_job(prepared.folder).costs(), {}, options);
}

void tell_all_is_made(const PreparedJob& prepared) {
  print_result("nothing to do: all {} has been made\n", prepared.job.left_out.empty() ? "of it" : "else");
}

/// Writes the job and reports damaged files.
void write_and_tell(const PreparedJob& prepared, Cache& cache) {
  std::vector<std::string> names;
  for (const fs::path& file : write_job(prepared, cache))
    names.push_back(file.lexically_relative(FarmFolder::of_job(prepared.folder).root()).string());
  if (!names.empty())
    tell(fmt::format("mended in {}: {}", FarmFolder::of_job(prepared.folder).root().string(), fmt::join(names, ", ")));
}

/// Nothing needs to run; only repairs the job if it exists.
int leave_as_made(const PreparedJob& prepared, Cache& cache) {
  std::error_code missing;
  if (fs::exists(prepared.folder, missing)) write_and_tell(prepared, cache);
  tell_all_is_made(prepared);
  return exit_done;
}

int print_scripts(const PreparedJob& prepared, const SubmitFlags& flags, const Slurm& slurm) {
  const std::vector<TaskArray> arrays = arrays_of_job(prepared, options_for(flags, slurm));
  for (size_t i = 0; i < arrays.size(); i++) {
    std::vector<std::string> after;
    for (const size_t n : arrays[i].needs) after.push_back(fmt::format("<job of array {}>", n + 1));
    print_result("# array {}\n{}\n", i + 1, slurm_script(prepared.job, arrays[i], prepared.folder, after, flags.slurm));
  }
  if (arrays.empty()) tell_all_is_made(prepared);
  return exit_done;
}

int write_openjd(const PreparedJob& prepared, const SubmitFlags& flags, Cache& cache) {
  const std::vector<TaskArray> arrays = arrays_of_job(prepared, flags.arrays);
  if (arrays.empty()) return leave_as_made(prepared, cache);
  write_and_tell(prepared, cache);
  for (const TaskArray& a : arrays) write_array(prepared.folder, a);
  write_whole_file(flags.openjd, openjd_template(prepared.job, arrays, prepared.folder, flags.slurm.program));
  write_assignment(prepared.folder, {Assignment::To::others, fs::absolute(flags.openjd).string()});
  tell("wrote " + flags.openjd);
  return exit_done;
}

int code_of(const JobState& state) {
  return state.is_complete() || state.is_moving() ? exit_done : exit_failed;
}

void show(const fs::path& folder, const FarmJob& job, const JobState& state, bool as_json) {
  if (as_json) {
    print_result("{}\n", state_json(folder, job, state));
    return;
  }
  print_result("job     {}\ngraph   {}\nfolder  {}\nunits   {}\n", job.name, job.graph, folder.string(),
               state_line(state));
  Table table = {{"unit", "state", "task", "where or why"}};
  for (size_t i = 0; i < job.units.size(); i++) {
    const std::string& name = job.units[i].name;
    if (state.units[i] == UnitState::done || state.units[i] == UnitState::unneeded) continue;
    const auto task = state.tasks.find(name);
    const auto failure = state.failures.find(name);
    table.push_back({name, std::string(name_of(state.units[i])), task == state.tasks.end() ? "" : task->second.id,
                     failure != state.failures.end() ? failure->second
                     : task == state.tasks.end()     ? ""
                                                     : task->second.reason});
  }
  for (const auto& [node, why] : job.left_out) table.push_back({node, "left out", "", why});
  if (table.size() > 1) print_result("\n{}", aligned(table));
  if (!job.left_out.empty())
    print_result("\nsubmit the same again once the errors are mended, for the nodes left out\n");
  if (state.count(UnitState::elsewhere) > 0)
    print_result("\nwritten to {} for another scheduler, which alone knows what is running\n", state.assignment.file);
  else if (!state.is_moving() && !state.is_complete())
    print_result("\nlogs are in {}; submit the same again to make missing results\n", (folder / "logs").string());
}

int wait_until_done(const fs::path& folder, const FarmJob& job, const SubmitFlags& flags, Cache& cache,
                    const Slurm& slurm, const std::atomic<bool>& cancelled) {
  std::string line;
  if (const Assignment to = assignment_of(folder); to.to == Assignment::To::others)
    tell(fmt::format("{} was written to {} for another scheduler; waiting until that has made it", job.name, to.file));
  const auto looked = [&](const JobState& state) {
    if (const std::string now = state_line(state); now != line) tell(line = now);
  };
  try {
    const auto again = [&] {
      read_farm_job(folder);  // tasks that cannot read it would be lost again
      hand_over(folder, job, cache, slurm, options_for(flags, slurm), flags.slurm);
    };
    const JobState state =
        wait_for(folder, job, cache, slurm, again,
                 {.retries = flags.retries, .cancelled = &cancelled, .looked = looked, .told = tell});
    if (state.is_complete()) {
      tell("done: " + job.name);
      return exit_done;
    }
    show(folder, job, state, flags.json);
    return exit_failed;
  } catch (const Cancelled&) {
    tell(fmt::format("the job goes on; `terrazzo submit --wait {0}` waits again, `--cancel` ends it", job.name));
    return exit_cancelled;
  }
}

int submit_graph(const PreparedJob& prepared, const SubmitFlags& flags, Cache& cache, const Slurm& slurm,
                 const std::atomic<bool>& cancelled) {
  if (std::ranges::none_of(prepared.due, [](bool is_due) { return is_due; })) return leave_as_made(prepared, cache);
  const ArrayOptions arrays = options_for(flags, slurm);
  if (const std::vector<std::string> ignored = ignored_slurm_settings(); !ignored.empty())
    tell(
        fmt::format("{}{} in the environment {} ignored; ask with --partition, --account, --time or --sbatch=OPTION, "
                    "and choose the cluster by SLURM_CONF",
                    warning_mark, fmt::join(ignored, ", "), ignored.size() == 1 ? "is" : "are"));
  write_and_tell(prepared, cache);
  const FarmJob job = read_farm_job(prepared.folder);
  write_assignment(prepared.folder, {.to = Assignment::To::slurm});
  const std::vector<HandedOver> handed = hand_over(prepared.folder, job, cache, slurm, arrays, flags.slurm);
  print_result("job {}\n", job.name);
  if (handed.empty()) {
    print_result("handed over before; nothing was added\n");
  } else {
    std::vector<TaskArray> given;
    std::vector<std::string> ids;
    for (const HandedOver& h : handed) {
      given.push_back(h.array);
      ids.push_back(h.id);
    }
    print_result("{}", aligned(table_of(given, ids)));
  }
  return flags.wait ? wait_until_done(prepared.folder, job, flags, cache, slurm, cancelled) : exit_done;
}

int list_jobs(const FarmFolder& farm, Cache& cache, const Slurm& slurm) {
  Table table = {{"job", "units"}};
  int code = exit_done;
  for (const std::string& name : farm.job_names()) {
    try {
      const FarmJob job = read_farm_job(farm.jobs() / name);
      table.push_back({name, state_line(look_at_job(farm.jobs() / name, job, cache, slurm))});
    } catch (const DamagedJob& e) {
      table.push_back({name, e.what()});
      code = exit_failed;
    }
  }
  if (table.size() == 1)
    print_result("no jobs in {}\n", farm.root().string());
  else
    print_result("{}", aligned(table));
  return code;
}

int cancel(const fs::path& folder, Cache& cache, const Slurm& slurm) {
  const std::string job = folder.filename().string();
  try {
    if (const Assignment to = assignment_of(folder); to.to == Assignment::To::others)
      throw UsageError(fmt::format(
          "{} is not Slurm's to cancel: it was written to {} for another scheduler; cancel it there", job, to.file));
  } catch (const DamagedJob&) {
    // Slurm's queue has the tasks.
  }
  cancel_job(folder, cache, slurm);
  print_result("cancelled {}; what has been made stays in the cache\n", job);
  return exit_done;
}

int work_on_job(const fs::path& folder, const SubmitFlags& flags, Cache& cache, const Slurm& slurm,
                const std::atomic<bool>& cancelled) {
  if (flags.cancel) return cancel(folder, cache, slurm);
  const FarmJob job = read_farm_job(folder);
  if (flags.wait) return wait_until_done(folder, job, flags, cache, slurm, cancelled);
  const JobState state = look_at_job(folder, job, cache, slurm);
  show(folder, job, state, flags.json);
  return code_of(state);
}

int submit(SubmitFlags& flags) {
  const CancelOnSignal signals;
  Session session = as_usage([&] { return Session({.cache = flags.cache}); });
  Cache& cache = *session.cache();
  const Slurm slurm(tell, &signals.flag());
  const FarmFolder farm(cache.folder());
  if (!flags.memory.empty()) flags.arrays.memory = parse_bytes(flags.memory, "--memory");
  flags.slurm.program = flags.program.empty() ? fs::read_symlink("/proc/self/exe") : fs::path(flags.program);
  std::error_code missing;
  const bool names_a_graph = fs::is_regular_file(flags.graph, missing);
  const bool is_about_a_job = flags.status || flags.cancel || (flags.wait && !names_a_graph);
  if (flags.openjd.empty() && !flags.status && !flags.cancel)
    as_usage([&] { check_slurm_options(flags.slurm, farm.jobs()); });
  if (flags.graph.empty()) {
    if (!flags.status) throw UsageError("which graph? `terrazzo submit GRAPH`; --status alone lists the jobs");
    return list_jobs(farm, cache, slurm);
  }
  if (!is_about_a_job && !names_a_graph && flags.graph.find('.') == std::string::npos)
    if (const auto names = farm.job_names(); std::ranges::find(names, flags.graph) != names.end())
      throw UsageError(
          fmt::format("\"{}\" is a job: add --status, --wait or --cancel; or submit its graph again", flags.graph));
  if (is_about_a_job && !names_a_graph)
    return work_on_job(as_usage([&] { return farm.find_job(flags.graph); }), flags, cache, slurm, signals.flag());
  flags.open_pack(cache.folder());
  const PreparedJob job = prepared_job(flags, session);
  if (is_about_a_job) {
    if (!fs::exists(job.folder / "job.json", missing))
      throw UsageError(fmt::format("{} has not been submitted with these values", flags.graph));
    return work_on_job(job.folder, flags, cache, slurm, signals.flag());
  }
  if (const std::string stem = fs::path(flags.graph).stem().string(); !job.job.name.starts_with(stem + "-"))
    tell(fmt::format("note: the job of \"{}\" is called {}", stem, job.job.name));
  const std::map<std::string, std::string>& left_out = job.job.left_out;
  if (!left_out.empty()) tell(lines_of(left_out));
  const int code = flags.print             ? print_scripts(job, flags, slurm)
                   : !flags.openjd.empty() ? write_openjd(job, flags, cache)
                                           : submit_graph(job, flags, cache, slurm, signals.flag());
  return code == exit_done && !left_out.empty() ? exit_failed : code;
}

}  // namespace

void add_submit_command(Command& program) {
  Command& command = program.add_command("submit", "Hands a graph to a farm: Slurm, or an Open Job Description");
  const auto flags = std::make_shared<SubmitFlags>();
  add_submit_flags(command, *flags);
  command.footer =
      "Examples:\n"
      "  terrazzo submit bricks.json --sweep seed=1..64 --set \"out=='/projects/bricks/' + seed\" --wait\n"
      "  terrazzo submit bricks.json --print            the scripts, without Slurm\n"
      "  terrazzo submit --status                       all jobs\n"
      "  terrazzo submit bricks-1a2b --cancel           a job by the beginning of its name";
  command.run = [flags] { return submit(*flags); };
}

void add_farm_commands(Command& program) {
  add_submit_command(program);
  add_task_command(program);
}

}  // namespace terrazzo
