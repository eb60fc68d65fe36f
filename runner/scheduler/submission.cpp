#include "runner/scheduler/submission.h"

#include <algorithm>
#include <cstdlib>
#include <set>
#include <thread>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/variables_read.h"
#include "core/file/atomic_file.h"
#include "runner/farm/unit_run.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

void rename(std::vector<std::string>& names, const std::map<std::string, std::string>& now) {
  for (std::string& n : names) n = now.at(n);
}

Plan plan_of(const Graph& graph, const FarmJob& job, Cache& cache) {
  return make_plan(graph, &cache, {.only = job.targets, .look_ahead = false});
}

/// While it lives, prevents other processes from submitting the same job.
std::shared_ptr<Lease> lease_of(const std::string& job, Cache& cache) {
  constexpr std::chrono::milliseconds pause{100};
  constexpr int looks = 3000;  // five minutes: as long as a busy controller is retried
  const Digest key = Hasher().add("farm job").add(job).digest();
  for (int look = 0; look < looks; look++) {
    LeaseAttempt attempt = cache.try_lease(key);
    if (!attempt.taken) return attempt.lease;
    std::this_thread::sleep_for(pause);
  }
  throw Error(fmt::format("job {} is still being submitted by another process", job));
}

std::string batch_job_of(const QueuedTask& task) {
  return task.id.substr(0, task.id.find('_'));
}

/// Part of the id: jobs with different left-out nodes are different jobs.
Digest id_of(const FrozenGraph& graph, const std::map<std::string, std::string>& left_out) {
  if (left_out.empty()) return graph.id;
  Hasher h;
  h.add(graph.id.hex());
  for (const auto& [node, why] : left_out) h.add(node).add(why);
  return h.digest();
}

using Needs = std::map<std::string, const std::vector<std::string>*>;  // by unit

/// Batch jobs that must end before this array can start: earlier arrays, and queued tasks.
std::vector<std::string> jobs_before(const TaskArray& array, const std::vector<HandedOver>& done, const Needs& needs,
                                     const JobState& state) {
  std::set<std::string> ids;
  for (const size_t n : array.needs) ids.insert(done[n].id);
  for (const auto& task : array.tasks)
    for (const std::string& unit : task)
      for (const std::string& need : *needs.at(unit))
        if (const auto queued = state.tasks.find(need); queued != state.tasks.end())
          ids.insert(batch_job_of(queued->second));
  return {ids.begin(), ids.end()};
}

}  // namespace

PreparedJob prepared(const Plan& plan, Cache& cache, const std::vector<std::string>& plugins,
                     const std::map<std::string, std::string>& left_out) {
  PreparedJob out;
  out.graph = frozen(plan, &cache);
  FarmJob& job = out.job;
  job.name = job_name(plan.graph->file, id_of(out.graph, left_out));
  job.graph = fs::absolute(plan.graph->file).string();
  job.program = std::string("terrazzo ") + TERRAZZO_VERSION;
  job.document = out.graph.document();
  for (const FrozenInput& f : out.graph.inputs) job.inputs.emplace(f.to.generic_string(), f.content);
  job.targets = out.graph.targets;
  job.origins = out.graph.origins;
  job.plugins = plugins;
  job.left_out = left_out;
  // The only environment variable that results depend on. It names a file or a built-in configuration such as
  // "ocio://default".
  if (const char* config = std::getenv("OCIO")) {
    std::error_code missing;
    job.variables.emplace("OCIO", fs::exists(config, missing) ? fs::absolute(config).string() : config);
  }
  const VariablesRead variables;
  for (const Stage& s : plan.stages)
    if (s.type().files_read) s.type().files_read(s.node->params);
  job.variables.insert(variables.all().begin(), variables.all().end());
  job.units = units_of(plan);
  out.due = due(job.units, plan);
  for (Unit& u : job.units) {
    u.name = out.graph.names.at(u.name);
    rename(u.nodes, out.graph.names);
    rename(u.targets, out.graph.names);
    rename(u.needs, out.graph.names);
  }
  out.folder = FarmFolder(cache.folder()).jobs() / job.name;
  return out;
}

std::vector<fs::path> write_job(const PreparedJob& prepared, Cache& cache) {
  std::error_code missing;
  const fs::path& folder = prepared.folder;
  const std::shared_ptr<Lease> lease =
      lease_of(prepared.job.name, cache);  // a job that another process is writing is not damaged
  const bool is_new = !fs::exists(folder, missing);
  fs::create_directories(folder / "logs");
  std::vector<fs::path> mended = write_frozen(prepared.graph, folder);
  FarmJob job = prepared.job;
  const LoadedGraph loaded = load_frozen(folder, job.document);
  for (const GraphNode& n : loaded.graph.nodes) job.keys.emplace(n.name, key_on_farm(n, cache));
  try {
    job.units = read_farm_job(folder).units;  // tasks in the queue go by their names
  } catch (const Error&) {
    // There is no usable job.
  }
  if (write_farm_job(job, folder)) mended.push_back(folder / "job.json");
  return is_new ? std::vector<fs::path>() : mended;
}

JobState look_at_job(const fs::path& folder, const FarmJob& job, Cache& cache, const Slurm& slurm) {
  const bool may_be_queued = assignment_of(folder).to != Assignment::To::others;
  const std::vector<QueuedTask> tasks = may_be_queued ? slurm.queued(job.name) : std::vector<QueuedTask>();
  const LoadedGraph loaded = load_frozen(folder, job.document);
  return state_of(folder, job, plan_of(loaded.graph, job, cache), tasks);
}

std::vector<HandedOver> hand_over(const fs::path& folder, const FarmJob& job, Cache& cache, const Slurm& slurm,
                                  const ArrayOptions& arrays, const SlurmOptions& options) {
  const std::shared_ptr<Lease> lease = lease_of(job.name, cache);
  const JobState state = look_at_job(folder, job, cache, slurm);
  if (state.assignment.to != Assignment::To::slurm) return {};
  std::vector<bool> wanted;
  Needs needs;
  std::map<std::string, uint64_t> too_little;
  for (size_t i = 0; i < job.units.size(); i++) {
    const bool is_wanted = state.units[i] == UnitState::lost || state.units[i] == UnitState::failed;
    wanted.push_back(is_wanted);
    needs.emplace(job.units[i].name, &job.units[i].needs);
    if (!is_wanted) continue;
    const std::string& name = job.units[i].name;
    if (const auto failure = failure_of(folder, name); failure && failure->memory > 0)
      too_little[name] = failure->memory;
    forget_failure(folder, name);
  }
  std::vector<HandedOver> out;
  fs::create_directories(folder / "logs");  // without it, tasks fail immediately
  for (TaskArray& array : arrays_of(job.units, wanted, FarmFolder::of_job(folder).costs(), too_little, arrays)) {
    write_array(folder, array);
    const std::string id = array.id().hex();
    const fs::path script = folder / "arrays" / (id + ".sh");
    write_whole_file(script, slurm_script(job, array, folder, jobs_before(array, out, needs, state), options));
    std::string batch_job = slurm.submit(script, job.name, id);
    out.push_back({std::move(array), std::move(batch_job)});
  }
  return out;
}

void cancel_job(const fs::path& folder, Cache& cache, const Slurm& slurm) {
  const std::string job = folder.filename().string();
  const std::shared_ptr<Lease> lease = lease_of(job, cache);
  write_assignment(folder, {.to = Assignment::To::nobody});
  slurm.cancel(job);
}

JobState wait_for(const fs::path& folder, const FarmJob& job, Cache& cache, const Slurm& slurm,
                  const std::function<void()>& again, const WaitOptions& options) {
  int retries = options.retries;
  auto pause = options.first_pause;
  for (;;) {
    JobState state = look_at_job(folder, job, cache, slurm);
    if (options.looked) options.looked(state);
    if (!state.is_moving()) {
      // Results of a task that has just ended may not be visible in the cache yet.
      const int lost = state.count(UnitState::lost);
      if (lost == 0 || retries-- == 0) return state;
      if (options.told)
        options.told(
            fmt::format("{} got lost; handed over again", lost == 1 ? "1 unit" : fmt::format("{} units", lost)));
      again();
      pause = options.first_pause;
    }
    for (auto waited = std::chrono::milliseconds(0); waited < pause; waited += std::chrono::milliseconds(50)) {
      if (options.cancelled && *options.cancelled) throw Cancelled();
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    pause = std::min(pause + pause / 4, options.longest_pause);
  }
}

}  // namespace terrazzo
