#include "runner/cli/cli_run.h"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <set>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <unistd.h>

#include "core/image/image_limits.h"
#include "graphs/document/load.h"
#include "graphs/document/override.h"
#include "graphs/document/stock_graphs.h"
#include "runner/cli/cli_commands.h"
#include "runner/cli/cli_graph.h"
#include "runner/cli/cli_sweep.h"
#include "runner/cli/console.h"
#include "runner/cli/signals.h"
#include "runner/cli/watch.h"
#include "runner/engine/history.h"
#include "runner/engine/preflight.h"
#include "runner/report/html_report.h"
#include "runner/report/shown_nodes.h"
#include "runner/report/trace.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

void warn(const RunFlags& flags, const std::string& message) {
  write_warning(*progress_mode_from(flags.progress), std::cerr, message);
}

/// The cache to use. The usual folder may be out of reach, which costs time; one that was asked for may not.
std::unique_ptr<Cache> open_cache(const RunFlags& flags) {
  if (flags.no_cache) return nullptr;
  try {
    return std::make_unique<Cache>(flags.cache.empty() ? Cache::default_folder() : fs::path(flags.cache));
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

/// What people read at the end; programs that asked for json have had it all.
void print_end(const RunResult& result, ProgressMode mode) {
  for (const Failure& f : result.failures) say("error: {}\n", f.message);
  for (const StageOutcome& s : result.stages)
    for (const std::string& note : s.notes)
      if (is_warning(note)) say("{}node \"{}\": {}\n", warning_mark, s.node, note.substr(warning_mark.size()));
  if (mode == ProgressMode::none) return;
  for (const StageOutcome& s : result.stages)
    if (s.kind == StageOutcome::Kind::run)
      for (const OutputFile& f : s.files) say("wrote {}\n", f.path.string());
  say("{}{}\n", result.cancelled ? "cancelled; " : "", result.summary());
}

/// What options write besides the nodes: contact sheets that are pictures are a node's.
std::vector<WrittenFile> without_pictures(std::vector<WrittenFile> files) {
  std::erase_if(files, [](const WrittenFile& f) { return f.kind == WrittenKind::picture; });
  return files;
}

/// What the options of a run write.
std::vector<WrittenFile> files_of(const RunFlags& flags) {
  std::vector<WrittenFile> out = flags.writes;
  out.push_back({"--report", flags.report, WrittenKind::page});
  out.push_back({"--trace", flags.trace, WrittenKind::trace});
  return out;
}

int run_once(const Graph& graph, const RunFlags& flags, Cache* cache, const std::atomic<bool>& cancelled) {
  std::optional<History> history;
  if (cache && !graph.file.empty()) history.emplace(cache->folder(), graph.file);
  RunOptions options;
  options.targets.only = nodes_meant(graph, flags.only);
  options.cache = cache;
  options.history = history ? &*history : nullptr;
  options.threads = flags.threads;
  options.memory = flags.memory.empty() ? 0 : parse_bytes(flags.memory, "--memory");
  options.cancelled = &cancelled;
  options.targets.keep = flags.keep;

  const Plan plan = [&] {
    try {
      if (!flags.report.empty())
        for (std::string& name : nodes_for_report(graph, flags.only, cache))
          options.targets.keep.push_back(std::move(name));
      return make_plan(graph, cache, options.targets, options.history);
    } catch (const GraphError&) {
      throw;
    } catch (const Error& e) {
      throw UsageError(fmt::format("--only: {}", e.what()));
    }
  }();
  const std::vector<WrittenFile> written = files_of(flags);
  check_kept(written, inputs_of(graph));
  check_kept(without_pictures(written), outputs_of(plan));
  if (flags.dry_run) {
    answer("{}", plan.table());
    return exit_done;
  }
  const ProgressMode mode = *progress_mode_from(flags.progress);
  const std::unique_ptr<Progress> progress = make_progress(mode, std::cerr, is_terminal());
  options.observer = progress.get();
  const RunResult result = run_plan(plan, options);
  if (cache) {
    cache->collect();
    for (const std::string& w : cache->take_warnings()) progress->warned(w);
  }
  progress->closed(result);
  if (mode != ProgressMode::json) print_end(result, mode);
  check_kept(without_pictures(written), outputs_of(result));  // names that nobody knew before
  if (flags.after) flags.after(result);
  if (!flags.trace.empty()) write_trace(result, flags.trace);
  if (!flags.report.empty()) write_html_report(plan, result, flags.report);
  return result.cancelled ? exit_cancelled : result.ok() ? exit_done : exit_failed;
}

int watch(const std::function<Graph()>& load, const RunFlags& flags, Cache* cache, const std::atomic<bool>& cancelled) {
  Watch watched;
  const ProgressMode mode = *progress_mode_from(flags.progress);
  Graph graph;
  graph.file = flags.graph;
  watched.look_at(graph);
  for (;;) {
    int code = exit_usage;
    watched.look_again();  // if the graph cannot be loaded, its files of before are what may mend it
    try {
      graph = load();
      watched.look_at(graph);
      watched.until_change(cancelled,
                           [&](const std::atomic<bool>& stop) { code = run_once(graph, flags, cache, stop); });
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

void add_run_flags(CLI::App& command, RunFlags& flags) {
  command.add_option("--only", flags.only, "Run only this node and what it needs; may be given several times")
      ->type_name("NODE")
      ->take_all()
      ->expected(1);
  CLI::Option* cache = command.add_option("--cache", flags.cache, "Folder of the cache, if not the usual one");
  cache->type_name("DIR");
  command.add_flag("--no-cache", flags.no_cache, "Reuse nothing and keep nothing")->excludes(cache);
  command.add_option("--threads", flags.threads, "Threads to use; one per core if not given")
      ->type_name("N")
      ->check(CLI::Range(1, 1024));
  command
      .add_option("--memory", flags.memory, "Memory for running nodes, such as 2G; half of the machine's if not given")
      ->type_name("SIZE");
  command
      .add_option("--max-pixels", flags.max_pixels,
                  "Read no image of more pixels; as many as fit into half of the machine's memory if not given")
      ->type_name("N")
      ->check(CLI::PositiveNumber);
  command.add_flag("--dry-run", flags.dry_run, "Print what would run, and why; run nothing");
  command.add_flag(
      "--watch", flags.watch,
      "Run again whenever the graph file or a file that it reads changes; a change while it runs starts it "
      "anew. Ctrl-C ends it, with the exit "
      "code of the last run, or 130 if it interrupts one");
  command.add_option("--report", flags.report, "Write a report with pictures")->type_name("FILE.html");
  command.add_option("--trace", flags.trace, "Write a timeline for chrome://tracing")->type_name("FILE.json");
  command.add_flag("--force", flags.force, force_help);
  command.add_option("--progress", flags.progress, "auto, bar, plain, json, or none: nothing but warnings and errors")
      ->type_name("MODE")
      ->check(CLI::IsMember(std::vector<std::string>(progress_mode_names.begin(), progress_mode_names.end()),
                            CLI::ignore_case));
}

int run_with_flags(const std::function<Graph()>& load, const RunFlags& flags) {
  if (!flags.memory.empty()) parse_bytes(flags.memory, "--memory");
  const std::string ending = fs::path(flags.report).extension().string();
  std::error_code missing;
  const bool is_device = fs::exists(flags.report, missing) && !fs::is_regular_file(flags.report, missing);
  if (!flags.report.empty() && !is_device && ending != ".html" && ending != ".htm")
    throw UsageError(fmt::format("--report takes a file that ends in .html; \"{}\" does not", flags.report));
  if (flags.max_pixels > 0) set_most_pixels(flags.max_pixels);
  check_kept(files_of(flags), flags.reads);
  check_replaced(files_of(flags), flags.force);
  const CancelOnSignal signals;
  const std::unique_ptr<Cache> cache = open_cache(flags);
  if (flags.watch) return watch(load, flags, cache.get(), signals.flag());
  return run_once(load(), flags, cache.get(), signals.flag());
}

namespace {

int run_sweep(const GraphFlags& values, const SweepFlags& asked, const RunFlags& given) {
  Sweep sweep(asked);
  RunFlags flags = given;
  flags.writes = {{"--sheet", asked.sheet, is_page(asked.sheet) ? WrittenKind::page : WrittenKind::picture},
                  {"--figures", asked.figures, WrittenKind::table}};
  if (!asked.table.empty()) flags.reads.push_back({asked.table, "it is the table of --table"});
  flags.after = [&](const RunResult& result) { sweep.report(result); };
  return run_with_flags(
      [&] {
        std::set<std::string> warned;
        Graph graph = sweep.load([&](const std::vector<std::string>& overrides) {
          GraphFlags variation = values;
          variation.set.insert(variation.set.end(), overrides.begin(), overrides.end());
          LoadedGraph loaded = variation.load({.only = given.only, .look_ahead = preflight_of_nodes});
          for (const Problem& w : loaded.warnings)
            if (const std::string text = describe(values.graph, w); warned.insert(text).second) warn(flags, text);
          return std::move(loaded.graph);
        });
        flags.keep = sweep.kept();
        flags.only = sweep.names_of(given.only);
        if (!flags.only.empty()) flags.only.insert(flags.only.end(), sweep.targets().begin(), sweep.targets().end());
        return graph;
      },
      flags);
}

}  // namespace

void add_run_command(CLI::App& app, Chosen& chosen) {
  CLI::App* run = app.add_subcommand("run", "Runs a graph: only what has changed since it last ran");
  struct Flags : RunFlags {
    GraphFlags values;
    SweepFlags variations;
  };
  const auto flags = std::make_shared<Flags>();
  add_graph_argument(*run, flags->values);
  add_value_flags(*run, flags->values);
  add_sweep_flags(*run, flags->variations);
  add_run_flags(*run, *flags);
  run->footer(
      "Examples:\n"
      "  terrazzo run bricks.json --set seed=7 --set size=2048x2048\n"
      "  terrazzo run bricks.json --only layout --dry-run\n"
      "  terrazzo run bricks.json --sweep seed=1..8 --set \"out=='out/' + seed\" --sheet sheet.png --best swd");
  run->callback([&chosen, flags] {
    chosen = [flags] {
      flags->graph = flags->values.graph;
      flags->reads = flags->values.files();
      if (flags->variations.asked()) return run_sweep(flags->values, flags->variations, *flags);
      for (const std::string* left : {&flags->variations.sheet, &flags->variations.figures, &flags->variations.best})
        if (!left->empty()) throw UsageError("--sheet, --figures and --best go with --sweep or --table");
      return run_with_flags(
          [&] {
            LoadedGraph loaded = flags->values.load({.only = flags->only, .look_ahead = preflight_of_nodes});
            for (const Problem& w : loaded.warnings) warn(*flags, describe(flags->graph, w));
            return std::move(loaded.graph);
          },
          *flags);
    };
  });
}

/// An argument of `synth`, and the parameter of the stock graph that it sets.
struct Argument {
  std::string name, parameter, value;

  std::string override_text() const { return parameter + "=" + value; }
};

/// What is wrong, said of the arguments of `synth`, the folder first, instead of the graph that they stand for.
GraphError about_arguments(const GraphError& error, const std::vector<Argument>& arguments) {
  std::vector<Problem> problems;
  for (const Problem& p : error.problems()) {
    const bool is_source = p.node == "exemplar" || p.node == "weighted";  // the latter looks at the maps' shapes
    const auto argument = std::find_if(arguments.begin(), arguments.end(), [&](const Argument& a) {
      return p.where == where_of_override(a.override_text());
    });
    if (argument != arguments.end())
      problems.push_back({{}, argument->name + " " + argument->value, p.message});
    else if (is_source || p.node == "files")
      problems.push_back({{}, is_source ? "FOLDER" : "-o", for_command_line(p.message, arguments.front().value)});
    else
      return error;
  }
  return GraphError("", std::move(problems));
}

bool same_folder(const std::string& a, const std::string& b) {
  std::error_code missing;
  return std::filesystem::equivalent(a, b, missing);
}

void add_synth_command(CLI::App& app, Chosen& chosen) {
  CLI::App* synth = app.add_subcommand("synth", "Makes a larger material from a folder of maps, without a graph file");
  struct Flags : RunFlags {
    std::string folder, out, name, scale, size, seed, quality, blend, join, format, tileable;
    std::vector<std::string> set;
  };
  const auto flags = std::make_shared<Flags>();
  synth->add_option("FOLDER", flags->folder, "The folder of the exemplar's maps")->required()->type_name("DIR");
  synth
      ->add_option("-o,--out", flags->out,
                   "The folder to write to; {material}, {width}, {height} and {map} are replaced")
      ->required()
      ->type_name("DIR");
  synth
      ->add_option("--name", flags->name,
                   "Which material of a folder that holds several: what the names of its files begin with; '*' takes "
                   "all files as one")
      ->type_name("STEM");
  synth
      ->add_option("--scale", flags->scale,
                   "The size of the result: how many times the exemplar in each direction; 2 if not given")
      ->type_name("FACTOR");
  synth->add_option("--size", flags->size, "The size of the result in pixels")->type_name("WxH")->excludes("--scale");
  synth->add_option("--seed", flags->seed, "Another number gives another arrangement")->type_name("N");
  synth->add_option("--quality", flags->quality, "draft, normal or best: draft is quick, best takes its time")
      ->type_name("LEVEL");
  synth
      ->add_option(
          "--blend", flags->blend,
          "How far from a seam pixels are blended, 0 to 8; more is softer, 2 to 3 hides most seams. 0 if not given")
      ->type_name("PIXELS");
  synth
      ->add_option("--join", flags->join,
                   "How far from a seam heights change so that pieces meet: below 1 a share of the exemplar's shorter "
                   "side, else pixels; 0 keeps heights exact. 0.03 if not given")
      ->type_name("REACH");
  synth
      ->add_option("--format", flags->format,
                   "png, tif, exr or jpg, also spelled tiff or jpeg; png if not given. Float maps need exr or tif")
      ->type_name("FORMAT");
  synth
      ->add_option("--set", flags->set,
                   "Sets a parameter of the graph that this stands for (graphs/material.json), or of one of its nodes, "
                   "as for run; may be given several times")
      ->type_name("NAME=VALUE")
      ->take_all()
      ->expected(1);
  synth->add_flag("--tileable{xy}", flags->tileable,
                  "The result wraps around; --tileable=x or --tileable=y in one direction only");
  add_run_flags(*synth, *flags);
  synth->footer("Example:\n  terrazzo synth bricks/ -o out --size 2048x2048 --seed 7");
  synth->callback([&chosen, flags] {
    chosen = [flags] {
      std::vector<Argument> arguments = {{"FOLDER", "material", flags->folder}, {"-o", "out", flags->out}};
      const auto set_if_given = [&](const char* name, const char* parameter, const std::string& value) {
        if (!value.empty()) arguments.push_back({name, parameter, value});
      };
      set_if_given("--name", "name", flags->name);
      set_if_given("--scale", "scale", flags->scale);
      set_if_given("--size", "size", flags->size);
      set_if_given("--seed", "seed", flags->seed);
      set_if_given("--quality", "quality", flags->quality);
      set_if_given("--blend", "blend", flags->blend);
      set_if_given("--join", "join", flags->join);
      set_if_given("--format", "format", flags->format);
      set_if_given("--tileable", "tileable", flags->tileable);
      std::vector<std::string> set;
      for (const Argument& a : arguments) set.push_back(a.override_text());
      set.insert(set.end(), flags->set.begin(), flags->set.end());
      if (same_folder(flags->folder, flags->out))
        throw UsageError(
            fmt::format("-o {}: the result would overwrite the exemplar; name another folder", flags->out));
      try {
        return run_with_flags(
            [&] { return load_graph_text(stock_graph("material"), "stock graph material.json", set).graph; }, *flags);
      } catch (const GraphError& e) {
        throw about_arguments(e, arguments);
      }
    };
  });
}

}  // namespace terrazzo
