#include "runner/cli/cli_run.h"

#include <algorithm>
#include <filesystem>
#include <iostream>

#include <fmt/format.h>
#include <unistd.h>

#include "core/file/read_guard.h"
#include "graphs/document/load.h"
#include "runner/api/session.h"
#include "runner/cache/cache_limit.h"
#include "runner/cli/cli_commands.h"
#include "runner/cli/cli_graph.h"
#include "runner/cli/cli_sweep.h"
#include "runner/cli/watch.h"
#include "runner/engine/checked.h"
#include "runner/engine/sandbox.h"
#include "runner/plan/preflight.h"
#include "runner/report/html_report.h"
#include "runner/report/run_summary.h"
#include "runner/report/shown_nodes.h"
#include "runner/report/trace.h"
#include "runner/terminal/console.h"
#include "runner/terminal/signals.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

void warn(const RunFlags& flags, const std::string& message) {
  write_warning(*progress_mode_from(flags.progress), std::cerr, message);
}

fs::path cache_folder(const RunFlags& flags) {
  return flags.cache.empty() ? Cache::default_folder() : fs::path(flags.cache);
}

/// The cache limit from the command line, else from the environment or the folder's settings; invalid settings do not
/// disable the cache. Nullopt if there is no folder.
std::optional<uint64_t> limit_of_cache(const RunFlags& flags) {
  if (!flags.cache_size.empty()) return parse_bytes(flags.cache_size, "--cache-size");
  fs::path folder;
  try {
    folder = cache_folder(flags);
  } catch (const Error&) {
    return std::nullopt;
  }
  return as_usage([&] { return cache_limit(folder).bytes; });
}

/// The cache to use. An unavailable default folder only costs time; an unavailable requested one is an error.
std::shared_ptr<Cache> open_cache(const RunFlags& flags) {
  if (!flags.keeps()) return nullptr;
  const std::optional<uint64_t> limit = limit_of_cache(flags);
  try {
    return std::make_shared<Cache>(cache_folder(flags), limit.value_or(0));
  } catch (const Error& e) {
    if (!flags.cache.empty()) throw UsageError(fmt::format("--cache {}: {}", flags.cache, e.what()));
    warn(flags, fmt::format("running without a cache: {}", e.what()));
    return nullptr;
  }
}

bool is_terminal() {
  const char* term = std::getenv("TERM");
  return ::isatty(STDERR_FILENO) == 1 && term && std::string_view(term) != "dumb";
}

/// The summary for users; in json mode everything has already been reported.
void print_end(const RunResult& result, ProgressMode mode) {
  for (const Failure& f : result.failures) print_message("error: {}\n", f.message);
  for (const std::string& line : result.skips()) print_message("{}\n", line);
  print_warnings(result);
  if (mode == ProgressMode::none) return;
  for (const StageOutcome& s : result.stages)
    if (s.kind == StageOutcome::Kind::run)
      for (const OutputFile& f : s.files) print_message("wrote {}\n", f.path.string());
  print_message("{}{}\n", result.cancelled ? "cancelled; " : "", result.summary());
}

void summarize(const RunFlags& flags, const RunSummary& summary) {
  if (!flags.summary.empty()) write_run_summary(summary, flags.summary);
}

/// Calls `act`, which plans a graph or prepares that; if it throws, writes the reason to the summary.
template <typename Act>
auto summarizing_failure(const RunFlags& flags, const std::string& graph,
                         const std::map<std::string, std::string>& variations, const Act& act) {
  const auto tell = [&](const std::exception& e, int code) {
    RunSummary summary{graph};
    summary.variations = variations;
    summary.error = &e;
    summary.exit_code = code;
    summarize(flags, summary);
  };
  try {
    return act();
  } catch (const GraphError& e) {
    tell(e, exit_usage);
    throw;
  } catch (const UsageError& e) {
    tell(e, exit_usage);
    throw;
  } catch (const std::exception& e) {
    tell(e, exit_failed);
    throw;
  }
}

/// Files that options write in addition to nodes; contact sheets that are pictures are written by a node.
std::vector<WrittenFile> without_pictures(std::vector<WrittenFile> files) {
  std::erase_if(files, [](const WrittenFile& f) { return f.kind == WrittenKind::picture; });
  return files;
}

/// The files that a run's options write.
std::vector<WrittenFile> files_of(const CommandRun& run, const RunFlags& flags) {
  std::vector<WrittenFile> out = run.writes;
  out.push_back({"--report", flags.report, WrittenKind::page});
  out.push_back({"--trace", flags.trace, WrittenKind::trace});
  out.push_back({"--summary", flags.summary, WrittenKind::summary});
  return out;
}

/// Nullopt if no sandbox is requested. Paths in `readable` may be read too. Throws UsageError.
std::optional<Sandbox> sandbox_of(const CommandRun& run, const RunFlags& flags, const std::vector<fs::path>& readable) {
  if (flags.sandbox.empty()) return std::nullopt;
  std::error_code missing;
  if (!fs::is_directory(flags.sandbox, missing))
    throw UsageError(fmt::format("--sandbox {}: there is no such folder; make it first", flags.sandbox));
  Sandbox out(flags.sandbox);
  for (const std::string& file : run.files) out.open(file);
  for (const fs::path& path : readable) out.open_to_read(path);
  return out;
}

/// Throws GraphError, before a plan reads any of the graph's files.
void check_sandbox(const Graph& graph, const std::optional<Sandbox>& sandbox) {
  if (!sandbox) return;
  if (std::vector<Problem> problems = sandbox_problems(graph.nodes, *sandbox); !problems.empty())
    throw GraphError(graph.file.string(), std::move(problems));
}

/// A graph and its sandbox.
struct Guarded {
  GraphToRun what;
  std::optional<Sandbox> sandbox;
};

/// Loads a graph that reads only files its sandbox allows.
Guarded load_guarded(const CommandRun& run, const RunFlags& flags) {
  Guarded out{{}, sandbox_of(run, flags, run.unpack ? run.unpack() : std::vector<fs::path>())};
  std::optional<ReadGuard> guard;
  if (out.sandbox)
    guard.emplace([&](const fs::path& path) { out.sandbox->check("read", path); },
                  [&](const fs::path& path) { out.sandbox->open(path); });
  const auto look_ahead = [&](const std::vector<GraphNode>& nodes) {
    std::vector<Problem> problems;
    if (out.sandbox) problems = sandbox_problems(nodes, *out.sandbox);
    return problems.empty() ? preflight_of_nodes(nodes) : problems;
  };
  out.what = run.load({.only = flags.only, .keep_going = flags.keep_going, .look_ahead = look_ahead});
  return out;
}

int run_once(const Guarded& guarded, const CommandRun& run, const RunFlags& flags, Session& session,
             const std::atomic<bool>& cancelled) {
  const GraphToRun& what = guarded.what;
  const Graph& graph = what.graph;
  const std::optional<Sandbox>& sandbox = guarded.sandbox;
  RunRequest request{.only = what.only,
                     .keep = what.keep,
                     .keep_going = flags.keep_going,
                     .sandbox = sandbox ? &*sandbox : nullptr,
                     .cancelled = &cancelled};
  const Plan plan = summarizing_failure(flags, run.graph, what.variations, [&] {
    check_sandbox(graph, sandbox);
    try {
      if (!flags.report.empty())
        for (std::string& name : nodes_for_report(graph, what.only, session)) request.keep.push_back(std::move(name));
      return session.plan(graph, request);
    } catch (const GraphError&) {
      throw;
    } catch (const Error& e) {
      throw UsageError(fmt::format("--only: {}", e.what()));
    }
  });
  const std::vector<WrittenFile> written = files_of(run, flags);
  check_protected(written, inputs_of(graph));
  check_protected(without_pictures(written), outputs_of(plan));
  if (flags.dry_run) {
    print_result("{}", plan.table());
    return exit_done;
  }
  const ProgressMode mode = *progress_mode_from(flags.progress);
  const std::unique_ptr<Progress> progress = make_progress(mode, std::cerr, is_terminal());
  request.observer = progress.get();
  const RunResult result = session.run(plan, request);
  std::vector<std::string> warnings = session.take_warnings();
  for (const std::string& w : warnings) progress->warned(w);
  progress->closed(result);
  if (mode != ProgressMode::json) print_end(result, mode);
  RunSummary summary{graph.file, &plan, &result, session.cache(), std::move(warnings)};
  summary.variations = what.variations;
  summary.exit_code = result.cancelled ? exit_cancelled : result.ok() ? exit_done : exit_failed;
  try {
    check_protected(without_pictures(written), outputs_of(result));  // checks names that were unknown before the run
    if (run.after) run.after(result);
    if (!flags.trace.empty()) write_trace(result, flags.trace);
    if (!flags.report.empty()) write_html_report(plan, result, flags.report);
  } catch (const std::exception& e) {
    summary.error = &e;
    summary.exit_code = exit_failed;
    summarize(flags, summary);
    throw;
  }
  summarize(flags, summary);
  return summary.exit_code;
}

int watch(const CommandRun& run, const RunFlags& flags, Session& session, const std::atomic<bool>& cancelled) {
  Watch watched;
  const ProgressMode mode = *progress_mode_from(flags.progress);
  Guarded guarded;
  guarded.what.graph.file = run.graph;
  watched.look_at(guarded.what.graph);
  for (;;) {
    int code = exit_usage;
    watched.look_again();  // if loading fails, a change of the previous files may fix it
    try {
      guarded = summarizing_failure(flags, run.graph, {}, [&] { return load_guarded(run, flags); });
      watched.look_at(guarded.what.graph);
      watched.until_change(cancelled,
                           [&](const std::atomic<bool>& stop) { code = run_once(guarded, run, flags, session, stop); });
    } catch (const Error& e) {
      write_error(mode, std::cerr, e);
    }
    if (cancelled && code == exit_cancelled) return code;
    if (watched.has_changed()) continue;
    write_watching(mode, std::cerr, watched.count());
    if (!watched.wait_for_change(cancelled)) return code;
  }
}

}  // namespace

void print_warnings(const RunResult& result) {
  for (const StageOutcome& s : result.stages)
    for (const std::string& note : s.notes)
      if (is_warning(note))
        print_message("{}node \"{}\": {}\n", warning_mark, s.node, note.substr(warning_mark.size()));
}

void add_run_flags(Command& command, RunFlags& flags) {
  command.add_option("--only", &flags.only, "Run only this node and what it needs; may be given several times")
      .takes("NODE")
      .repeated();
  command.add_option("--cache", &flags.cache, "Folder of the cache, if not the default").takes("DIR");
  command
      .add_option(
          "--cache-size", &flags.cache_size,
          "How large the cache may become, such as 20G; if not given, $TERRAZZO_CACHE_SIZE, or as settings.txt in the "
          "cache's folder says, or 10G")
      .takes("SIZE");
  command.add_flag("--no-cache", &flags.no_cache, "Reuse nothing and keep nothing")
      .not_with("--cache")
      .not_with("--cache-size");
  command.add_option("--threads", &flags.threads, "Threads to use; one per core if not given")
      .takes("N")
      .from_to(1, 1024);
  add_limit_flags(command, flags.limits);
  add_checked_flag(command, flags.checked);
  command.add_flag("--dry-run", &flags.dry_run, "Print what would run, and why; run nothing");
  command
      .add_flag("--watch", &flags.watch,
                "Run again whenever the graph file or a file that it reads changes; a change while it runs starts it "
                "anew. Ctrl-C ends it, with the exit "
                "code of the last run, or 130 if it interrupts one")
      .not_with("--dry-run");
  command.add_option("--report", &flags.report, "Write a report with pictures").takes("FILE.html");
  command
      .add_option("--summary", &flags.summary,
                  "Write what was done as JSON, also if the run fails or is cancelled: stages, times, files with "
                  "digests, failures")
      .takes("FILE.json");
  command.add_flag(
      "--keep-going", &flags.keep_going,
      "After a failure, go on with everything that does not need the failed node; the exit code is 1 nevertheless");
  command
      .add_option(
          "--sandbox", &flags.sandbox,
          "Let nodes read and write only in this folder and at paths that --set names; links count as their targets")
      .takes("DIR");
  command.add_option("--trace", &flags.trace, "Write a timeline for chrome://tracing").takes("FILE.json");
  command.add_flag("--force", &flags.force, force_help);
  command.add_option("--progress", &flags.progress, "auto, bar, plain, json, or none: nothing but warnings and errors")
      .takes("MODE")
      .one_of({progress_mode_names.begin(), progress_mode_names.end()})
      .any_case();
}

int run_with_flags(const CommandRun& run, const RunFlags& flags) {
  flags.limits.apply();
  const std::string ending = fs::path(flags.report).extension().string();
  std::error_code missing;
  const bool is_device = fs::exists(flags.report, missing) && !fs::is_regular_file(flags.report, missing);
  if (!flags.report.empty() && !is_device && ending != ".html" && ending != ".htm")
    throw UsageError(fmt::format("--report takes a file that ends in .html; \"{}\" does not", flags.report));
  check_protected(files_of(run, flags), run.reads);
  check_replaced(files_of(run, flags), flags.force);
  if (flags.is_checked() && !is_watching())
    warn(flags, "the files that nodes read are not watched: " + why_not_watching());
  const CancelOnSignal signals;
  Session session(open_cache(flags), {.threads = flags.threads, .checked = flags.is_checked()});
  if (flags.watch) return watch(run, flags, session, signals.flag());
  const Guarded guarded = summarizing_failure(flags, run.graph, {}, [&] { return load_guarded(run, flags); });
  return run_once(guarded, run, flags, session, signals.flag());
}

namespace {

struct RunCommandFlags : RunFlags {
  GraphFlags values;
  SweepFlags variations;
};

/// Makes the variations' graph the one to run, and reports on them.
void run_variations(CommandRun& run, Sweep& sweep, const RunCommandFlags& flags) {
  const SweepFlags& asked = flags.variations;
  run.writes = {{"--sheet", asked.sheet, is_page(asked.sheet) ? WrittenKind::page : WrittenKind::picture},
                {"--figures", asked.figures, WrittenKind::table}};
  if (!asked.table.empty()) run.reads.push_back({asked.table, "it is the table of --table"});
  run.after = [&](const RunResult& result) { sweep.report(result); };
  run.load = [&](const LoadOptions& options) {
    GraphToRun out{sweep.load(flags.values, options, [&](const std::string& text) { warn(flags, text); })};
    out.only = sweep.names_of(options.only);
    if (!out.only.empty()) out.only.insert(out.only.end(), sweep.targets().begin(), sweep.targets().end());
    out.keep = sweep.kept();
    out.variations = sweep.of_one_variation();
    return out;
  };
}

int run_command(RunCommandFlags& flags) {
  GraphFlags& values = flags.values;
  const SweepFlags& asked = flags.variations;
  CommandRun run{.graph = values.graph, .reads = values.files()};
  if (!asked.sheet.empty()) run.files.push_back(asked.sheet);
  run.unpack = [&] { return values.unpack_for_run(flags.keeps(), flags.cache); };
  if (asked.asked()) {
    Sweep sweep(asked);
    run_variations(run, sweep, flags);
    return run_with_flags(run, flags);
  }
  for (const std::string* left : {&asked.sheet, &asked.figures, &asked.best})
    if (!left->empty()) throw UsageError("--sheet, --figures and --best go with --sweep or --table");
  run.load = [&](const LoadOptions& options) {
    LoadedGraph loaded = values.load(options);
    for (const std::string& w : shown_warnings(values.graph, loaded.warnings)) warn(flags, w);
    return GraphToRun{std::move(loaded.graph), options.only};
  };
  return run_with_flags(run, flags);
}

}  // namespace

void add_run_command(Command& program) {
  Command& run = program.add_command("run", "Runs a graph: only what has changed since it last ran");
  const auto flags = std::make_shared<RunCommandFlags>();
  add_graph_argument(run, flags->values);
  add_value_flags(run, flags->values);
  add_sweep_flags(run, flags->variations);
  add_run_flags(run, *flags);
  run.footer =
      "Examples:\n"
      "  terrazzo run bricks.json --set seed=7 --set size=2048x2048\n"
      "  terrazzo run bricks.json --only layout --dry-run\n"
      "  terrazzo run bricks.json --sweep seed=1..8 --set \"out=='out/' + seed\" --sheet sheet.png --best swd";
  run.run = [flags] { return run_command(*flags); };
}

}  // namespace terrazzo
