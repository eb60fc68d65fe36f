#include <filesystem>

#include <fmt/format.h>

#include "core/stochastic/method.h"
#include "graphs/document/load.h"
#include "graphs/text/stock_graphs.h"
#include "graphs/values/override.h"
#include "runner/cli/cli_commands.h"
#include "runner/cli/cli_run.h"
#include "runner/cli/exemplar/exemplar_inspection.h"
#include "runner/terminal/console.h"

namespace terrazzo {

namespace {

/// An argument of `synth`, and the parameter of the stock graph that it sets.
struct Argument {
  std::string name, parameter, value;
};

/// The values of the arguments, then those of --set.
std::vector<Override> overrides_of(const std::vector<Argument>& arguments, const std::vector<std::string>& set) {
  std::vector<Override> out;
  for (const Argument& a : arguments) out.push_back(override_of(a.parameter, a.value));
  for (Override& o : overrides_from(set)) out.push_back(std::move(o));
  for (Override& o : out) o.allows_reading = true;
  return out;
}

/// Reports problems in terms of the arguments of `synth`, the folder first, instead of the stock graph.
GraphError about_arguments(const GraphError& error, const std::vector<Argument>& arguments) {
  std::vector<Problem> problems;
  for (const Problem& p : error.problems()) {
    const bool is_source = p.node == "exemplar" || p.node == "weighted";  // the latter checks the maps' shapes
    if (const size_t at = p.override_position.value_or(arguments.size()); at < arguments.size())
      problems.push_back({{}, arguments[at].name + " " + arguments[at].value, p.message});
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

struct SynthFlags : RunFlags {
  ExemplarFlags exemplar;
  std::string out, scale, size, seed, quality, blend, join, tones, format, tileable, method = "layout";
  std::vector<std::string> set;

  /// The first of the given options that only a layout has; empty if there is none.
  std::string layout_option() const {
    return !quality.empty() ? "--quality"
           : !blend.empty() ? "--blend"
           : !join.empty()  ? "--join"
           : !tones.empty() ? "--tones"
                            : "";
  }
};

/// The stock graph to run; null, with an exit code, if the inspection of the exemplar failed, which has been reported.
struct ChosenGraph {
  const char* name = nullptr;
  int code = exit_done;
};

/// Inspects the exemplar, using the run's cache, and recommends a stock graph.
ChosenGraph suitable_graph(const SynthFlags& flags) {
  RunFlags looking;
  looking.cache = flags.cache;
  looking.cache_size = flags.cache_size;
  looking.no_cache = flags.no_cache;
  looking.threads = flags.threads;
  looking.limits = flags.limits;
  looking.sandbox = flags.sandbox;
  looking.progress = "none";
  FeaturesPtr features;
  CommandRun run{.files = {flags.exemplar.folder}};
  run.load = [&](const LoadOptions&) {
    return GraphToRun{.graph = inspection_graph(flags.exemplar), .keep = {"elements"}};
  };
  run.after = [&](const RunResult& result) {
    if (result.ok()) features = std::get<FeaturesPtr>(result.kept.at("elements").at("features"));
  };
  const int code = run_with_flags(run, looking);
  if (!features) return {nullptr, code};
  const MethodChoice choice = suitable_method(*features, Task());
  print_message("{}\n", choice.sentence());
  return {choice.method == Method::noise ? "noise" : "material"};
}

ChosenGraph chosen_graph(const SynthFlags& flags) {
  const std::string of_layout = flags.layout_option();
  if (flags.method == "layout") return {"material"};
  if (flags.method == "noise") {
    if (of_layout.empty()) return {"noise"};
    throw UsageError(of_layout + ": noise by example has no layout; leave it out, or name --method layout");
  }
  if (flags.dry_run)
    throw UsageError("--method auto: it has to look at the exemplar; name layout or noise for a --dry-run");
  if (of_layout.empty()) return suitable_graph(flags);
  print_message("a layout is made: {} asks for one\n", of_layout);
  return {"material"};
}

}  // namespace

void add_synth_command(Command& program) {
  Command& synth = program.add_command("synth", "Makes a larger material from a folder of maps, without a graph file");
  const auto flags = std::make_shared<SynthFlags>();
  add_exemplar_flags(synth, flags->exemplar);
  synth
      .add_option("-o,--out", &flags->out,
                  "The folder to write to; {material}, {width}, {height} and {map} are replaced")
      .required()
      .takes("DIR");
  synth
      .add_option("--scale", &flags->scale,
                  "The size of the result: how many times the exemplar in each direction; 2 if not given")
      .takes("FACTOR");
  synth.add_option("--size", &flags->size, "The size of the result in pixels").takes("WxH").not_with("--scale");
  synth.add_option("--seed", &flags->seed, "Another number gives another arrangement").takes("N");
  synth.add_option("--quality", &flags->quality, "draft, normal or best: draft is quick, best takes its time")
      .takes("LEVEL");
  synth
      .add_option(
          "--blend", &flags->blend,
          "How far from a seam pixels are blended, 0 to 8; more is softer, 2 to 3 hides most seams. 0 if not given")
      .takes("PIXELS");
  synth
      .add_option("--join", &flags->join,
                  "How far from a seam heights change so that pieces meet: below 1 a share of the exemplar's shorter "
                  "side, else pixels; 0 keeps heights exact. 0.03 if not given")
      .takes("REACH");
  synth
      .add_option("--tones", &flags->tones,
                  "How far from a seam slow changes of tone meet, such as stains, in maps that have them: below 1 a "
                  "share of the exemplar's shorter side, else pixels; 0 keeps every pixel exact. 0.0625 if not given")
      .takes("REACH");
  synth
      .add_option("--method", &flags->method,
                  "layout, noise (noise by example, for exemplars without structure), or auto: the one that suits the "
                  "exemplar; layout if not given")
      .takes("METHOD")
      .one_of({"auto", "layout", "noise"});
  synth
      .add_option("--format", &flags->format,
                  "png, tif, exr or jpg, also spelled tiff or jpeg; png if not given. Float maps need exr or tif")
      .takes("FORMAT");
  synth
      .add_option("--set", &flags->set,
                  "Sets a parameter of the stock graph (graphs/material.json or graphs/noise.json) or of one of its "
                  "nodes, as for run; may be given several times")
      .takes("NAME=VALUE")
      .repeated();
  synth
      .add_flag("--tileable", &flags->tileable,
                "The result wraps around; --tileable=x or --tileable=y in one direction only")
      .implies("xy");
  add_run_flags(synth, *flags);
  synth.footer = "Example:\n  terrazzo synth bricks/ -o out --size 2048x2048 --seed 7";
  synth.run = [flags] {
    std::vector<Argument> arguments = {{"FOLDER", "material", flags->exemplar.folder}, {"-o", "out", flags->out}};
    const auto set_if_given = [&](const char* name, const char* parameter, const std::string& value) {
      if (!value.empty()) arguments.push_back({name, parameter, value});
    };
    set_if_given("--name", "name", flags->exemplar.name);
    for (const auto& [map, how] : flags->exemplar.interpretations())
      set_if_given("--interpret", ("exemplar.interpret." + map).c_str(), how);
    set_if_given("--scale", "scale", flags->scale);
    set_if_given("--size", "size", flags->size);
    set_if_given("--seed", "seed", flags->seed);
    set_if_given("--quality", "quality", flags->quality);
    set_if_given("--blend", "blend", flags->blend);
    set_if_given("--join", "join", flags->join);
    set_if_given("--tones", "tones", flags->tones);
    set_if_given("--format", "format", flags->format);
    set_if_given("--tileable", "tileable", flags->tileable);
    if (same_folder(flags->exemplar.folder, flags->out))
      throw UsageError(fmt::format("-o {}: the result would overwrite the exemplar; name another folder", flags->out));
    try {
      const ChosenGraph graph = chosen_graph(*flags);
      if (!graph.name) return graph.code;
      const std::string file = fmt::format("stock graph {}.json", graph.name);
      const auto load = [&](const LoadOptions& options) {
        const std::vector<Override> set = overrides_of(arguments, flags->set);
        return GraphToRun{load_graph_text(stock_graph(graph.name), file, set, options).graph, options.only};
      };
      return run_with_flags({.load = load}, *flags);
    } catch (const GraphError& e) {
      throw about_arguments(e, arguments);
    }
  };
}

}  // namespace terrazzo
