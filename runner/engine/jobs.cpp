#include "runner/engine/jobs.h"

#include <algorithm>
#include <chrono>
#include <new>

#include <fcntl.h>
#include <fmt/format.h>
#include <tbb/task_arena.h>

#include "core/file/atomic_file.h"
#include "core/file/file_io.h"
#include "core/file/read_guard.h"
#include "core/file/write_guard.h"
#include "core/image/pixel_maker.h"
#include "graphs/text/problem.h"
#include "runner/engine/checked.h"
#include "runner/engine/sandbox.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

void remove_staged(const NodeContext& context) {
  std::error_code ignored;
  for (const StagedFile& f : context.staged()) fs::remove(f.temporary, ignored);
}

/// The final path of a file, in the same folder as its temporary file.
fs::path place_of(const StagedFile& f) {
  return f.temporary.parent_path() / f.target.filename();
}

bool describes_others(const fs::path& file) {
  const std::string ending = file.extension().string();
  return ending == ".json" || ending == ".gltf" || ending == ".mtlx" || ending == ".usda" || ending == ".py";
}

/// While files are being replaced, an old description of them would claim that an inconsistent set is valid.
void remove_descriptions(const std::vector<StagedFile>& staged) {
  const auto is_description = [](const StagedFile& f) { return describes_others(f.target); };
  if (std::ranges::all_of(staged, is_description)) return;
  std::error_code not_there;
  for (const StagedFile& f : staged)
    if (is_description(f)) fs::remove(place_of(f), not_there);
}

/// Removes a node's temporary files unless they have been renamed to their targets.
class StagedFiles {
 public:
  explicit StagedFiles(const NodeContext& context) : context_(context) {}
  ~StagedFiles() { remove_staged(context_); }
  StagedFiles(const StagedFiles&) = delete;
  StagedFiles& operator=(const StagedFiles&) = delete;

  /// Syncs all files before renaming the first, so that only a crash during the renaming leaves an inconsistent set.
  /// Old descriptions are removed first and new ones renamed last: if there is one, the set is complete. The next run
  /// rewrites an inconsistent set.
  std::vector<OutputFile> put_in_place(Cache* cache, const Sandbox* sandbox) {
    std::vector<StagedFile> staged = context_.staged();
    for (const StagedFile& f : staged) {
      if (sandbox) sandbox->check("write", f.target);
      File file = File::open(f.temporary, O_RDONLY);
      if (!file.ok())
        throw std::logic_error(
            fmt::format("{} announced the file {} and did not write it", context_.type().name, f.target.string()));
      file.sync_and_close(f.target);
    }
    std::stable_partition(staged.begin(), staged.end(),
                          [](const StagedFile& f) { return !describes_others(f.target); });
    remove_descriptions(staged);
    for (const StagedFile& f : staged) publish_file(f.temporary, place_of(f));
    std::vector<OutputFile> files;
    for (const StagedFile& f : context_.staged())
      files.push_back({f.target, fs::file_size(f.target), digest_of_file(cache, f.target)});
    return files;
  }

 private:
  const NodeContext& context_;
};

void check_outputs(NodeContext& context) {
  for (const Port& p : context.type().outputs)
    if (!context.outputs().count(p.name))
      throw std::logic_error(fmt::format("{} did not set its output {}", context.type().name, p.name));
}

bool is_read(const Ingredient& i) {
  return i.what.starts_with("file ") || i.what.starts_with("variable ");
}

/// The files must still match the key; otherwise the result would be stored under the wrong key.
void check_files_unchanged(const Stage& stage, Cache* cache) {
  if (!cache) return;
  InputNames inputs;
  for (const auto& [port, wires] : stage.node->inputs) inputs[port].resize(wires.size());
  const std::vector<Ingredient> now =
      ingredients_of(*stage.node, inputs, [&](const fs::path& file) { return cache->file_digest(file); });
  const std::vector<Ingredient>& before = stage.known->ingredients;
  bool same = now.size() == before.size();
  for (size_t i = 0; same && i < now.size(); i++)
    same = now[i].what == before[i].what && (!is_read(now[i]) || now[i].digest == before[i].digest);
  if (!same) throw Error("the files it reads were changed while it was reading them; run the graph again");
}

/// A recomputed stage must give the values that its readers' keys depend on.
void check_repeatable(const Stage& stage, const std::map<std::string, Digest>& names) {
  if (!stage.known->record || names == stage.known->record->outputs) return;
  throw Error(fmt::format(
      "the same inputs and parameters gave a different result than before. The program was changed without raising the "
      "version of the node type {}, or the node is faulty. `terrazzo cache clear` starts afresh",
      stage.type().name));
}

/// Checks again: links may have changed since planning, and may change while the node runs.
void check_files_in_sandbox(const Stage& stage, const Sandbox* sandbox) {
  if (!sandbox || !stage.type().files_read) return;
  for (const fs::path& file : stage.type().files_read(stage.node->params)) sandbox->check("read", file);
}

void compute(StageJob& job, const Stage& stage, const RunOptions& options) {
  NodeContext& context = *job.context;
  std::optional<NodeContext> again;
  if (options.checked) again.emplace(context);
  WriteGuard::Check may_write;
  if (options.sandbox) may_write = [&](const fs::path& target) { options.sandbox->check("write", target); };
  const WriteGuard guard(std::move(may_write));
  std::optional<ReadGuard> reading;
  if (options.sandbox) reading.emplace([&](const fs::path& path) { options.sandbox->check("read", path); });
  const PixelMaker maker(stage.node->name);
  StagedFiles staged(context);
  const auto start = std::chrono::steady_clock::now();
  context.task().check();
  if (options.observer) options.observer->started(stage);
  check_files_in_sandbox(stage, options.sandbox);
  // Isolated: a thread that waits for this node's inner loops must not pick up another node meanwhile.
  {
    std::optional<WatchedReads> reads;
    if (options.checked) reads.emplace();
    tbb::this_task_arena::isolate([&] { context.compute(); });
    context.task().check();
    check_outputs(context);
    if (reads) {
      reads->stop();
      check_node(stage, context, *again, *reads);
    }
  }
  check_files_in_sandbox(stage, options.sandbox);
  if (stage.type().files_read) check_files_unchanged(stage, options.cache);
  StageRecord record;
  record.outputs = names_of(stage.type(), stage.known->key, context.outputs());
  check_repeatable(stage, record.outputs);
  record.notes = context.notes();
  record.files = staged.put_in_place(options.cache, options.sandbox);
  record.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  job.values = std::move(context.outputs());
  job.record = std::move(record);
}

void load(StageJob& job, const Stage& stage, const std::map<std::string, Digest>& names, Cache* cache) {
  for (const std::string& port : stage.used_outputs) {
    std::optional<Value> value = cache->load_value(names.at(port));
    if (!value || type_of(*value) != stage.type().find_output(port)->type) {
      job.values.clear();
      return;
    }
    job.values.emplace(port, std::move(*value));
  }
}

/// Whether a stage's values, or at least their names, are stored in the cache.
bool is_worth_a_lease(const Stage& stage, const Resolution& known, const RunOptions& options) {
  if (!options.cache || stage.type().is_sink()) return false;
  return stage.type().persist == Persist::payload || (stage.type().persist == Persist::digest && known.names.empty());
}

/// Another process is computing it.
void defer_to_lease_holder(StageJob& job, const Stage& stage, const RunOptions& options) {
  if (!job.waited && options.observer) options.observer->waits(stage);
  job.waited = job.busy = true;
}

/// Whether this job should compute the stage now: no other process is computing it, this is unknown, or its values
/// would have to be computed here anyway. Does not wait.
bool claim(StageJob& job, const Stage& stage, const RunOptions& options) {
  if (!is_worth_a_lease(stage, *stage.known, options)) return true;
  LeaseAttempt attempt = options.cache->try_lease(stage.known->key);
  job.lease = std::move(attempt.lease);
  if (!attempt.taken || stage.type().persist != Persist::payload) return true;
  defer_to_lease_holder(job, stage, options);
  return false;
}

/// Looks up the stage once no other process is computing it: then its names are known, and its inputs may not be
/// needed.
void look_up(StageJob& job, const Plan& plan, const RunOptions& options) {
  const Stage& stage = plan.stages[job.stage];
  job.resolution = resolve(plan, job.stage, options.cache, nullptr);
  if (is_being_made(stage, *job.resolution, options)) defer_to_lease_holder(job, stage, options);
}

/// Loads what another process has computed since the stage was looked up.
bool find_elsewhere(StageJob& job, const Stage& stage, Cache* cache) {
  if (!job.lease || stage.type().persist != Persist::payload) return false;
  std::optional<StageRecord> record = cache->find_stage(stage.known->key);
  if (!record || !is_complete(*record, stage.type())) return false;
  for (const std::string& port : stage.used_outputs)
    if (!cache->has_value(record->outputs.at(port))) return false;
  load(job, stage, record->outputs, cache);
  if (job.values.size() < stage.used_outputs.size()) return false;
  job.record = std::move(record);
  job.computed_remotely = true;
  job.lease.reset();
  return true;
}

void store(StageJob& job, const Stage& stage, const RunOptions& options) {
  const Task task(options.cancelled, {});
  if (stage.type().persist == Persist::payload)
    for (const auto& [port, value] : job.values) options.cache->store_value(value, job.record->seconds, task);
  options.cache->store_stage(stage.known->key, *job.record);
  job.stored = !job.values.empty() && std::all_of(job.values.begin(), job.values.end(), [&](const auto& value) {
    return options.cache->has_value(job.record->outputs.at(value.first));
  });
}

/// Replaces temporary names in the message by their target names.
std::string of_targets(const NodeContext& context, std::string message) {
  const auto replace = [&](const std::string& name, const std::string& target) {
    for (size_t at; name != target && (at = message.find(name)) != std::string::npos;)
      message.replace(at, name.size(), target);
  };
  for (const StagedFile& f : context.staged()) {
    replace(f.temporary.native(), f.target.native());
    if (f.temporary.parent_path() != f.target.parent_path()) replace(place_of(f).native(), f.target.native());
  }
  return message;
}

void perform_kind(StageJob& job, const Plan& plan, const RunOptions& options) {
  const Task pulls(options.cancelled, {});
  const CurrentTask scope(pulls);
  const Stage& stage = plan.stages[job.stage];
  switch (job.kind) {
    case StageJob::Kind::begin:
      break;
    case StageJob::Kind::look_up:
      look_up(job, plan, options);
      break;
    case StageJob::Kind::load:
      load(job, stage, stage.known->names, options.cache);
      break;
    case StageJob::Kind::compute:
      if (claim(job, stage, options) && !find_elsewhere(job, stage, options.cache)) compute(job, stage, options);
      break;
    case StageJob::Kind::store:
      store(job, stage, options);
      break;
  }
}

}  // namespace

bool is_being_made(const Stage& stage, const Resolution& known, const RunOptions& options) {
  const bool computes = !known.must_run.empty() && !known.record;
  return computes && is_worth_a_lease(stage, known, options) && options.cache->is_leased(known.key);
}

void perform(StageJob& job, const Plan& plan, const RunOptions& options) {
  const GraphNode& node = *plan.stages[job.stage].node;
  const auto fail = [&](const std::string& about, const std::string& reason) {
    const std::string message = job.context ? of_targets(*job.context, reason) : reason;
    if (node.type->find_input(about)) job.blames_input = message;
    job.failure = describe(plan.graph->file.string(), problem_of(node, about, message));
  };
  // All readers of the pixels fail in the same way; blames the node that computes them, once.
  const auto blame = [&](const PixelError& e) {
    const GraphNode* maker = e.maker() == node.name ? nullptr : plan.graph->find(e.maker());
    if (!maker) return fail(e.about(), e.what());
    job.blames_node = maker->name;
    job.blames_input = e.what();
    job.failure = describe(plan.graph->file.string(), problem_of(*maker, "", e.what()));
  };
  try {
    perform_kind(job, plan, options);
  } catch (const Cancelled&) {
    job.cancelled = true;
  } catch (const PixelError& e) {
    blame(e);
  } catch (const Error& e) {
    fail(e.about(), e.what());
  } catch (const fs::filesystem_error& e) {
    fail("", fmt::format("{}: {}", e.path1().string(), e.code().message()));
  } catch (const std::bad_alloc&) {
    fail("", "this machine does not have enough memory for it");
  } catch (const std::exception& e) {
    fail("", fmt::format("internal error: {}", e.what()));
  } catch (...) {
    fail("", "internal error: it threw something other than a std::exception");
  }
  if (job.busy) return;
  if (job.context) job.made_folders = job.context->made_folders();
  if (job.kind == StageJob::Kind::store) job.lease.reset();
  job.context.reset();  // releases the inputs
}

}  // namespace terrazzo
