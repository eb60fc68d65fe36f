#include <algorithm>
#include <filesystem>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/text.h"
#include "core/stochastic/method.h"
#include "graphs/document/load.h"
#include "graphs/text/json.h"
#include "graphs/values/override.h"
#include "nodes/source/maps/material_folder.h"
#include "runner/cli/cli_commands.h"
#include "runner/cli/cli_run.h"
#include "runner/cli/exemplar/exemplar_inspection.h"
#include "runner/cli/exemplar/synth_graph.h"
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

/// The argument that sets the parameter of the graph that has the same name as this one of the node that writes.
const Argument* argument_for(const std::vector<Argument>& arguments, const std::string& parameter) {
  const auto found = std::ranges::find(arguments, parameter, &Argument::parameter);
  return found == arguments.end() || parameter == "name" ? nullptr : &*found;
}

/// A message less the quoted name that it begins with: `"format": gltf takes ...`.
std::string without_subject(const std::string& message) {
  const size_t end = message.find("\": ");
  return message.starts_with('"') && end != message.npos ? message.substr(end + 3) : message;
}

/// Reports problems in terms of the arguments of `synth`, the folder first, instead of the stock graph.
GraphError about_arguments(const GraphError& error, const std::vector<Argument>& arguments) {
  std::vector<Problem> problems;
  for (const Problem& p : error.problems()) {
    const bool is_source = p.node == "exemplar" || p.node == "weighted";  // the latter checks the maps' shapes
    if (const size_t at = p.override_position.value_or(arguments.size()); at < arguments.size())
      problems.push_back({{}, arguments[at].name + " " + arguments[at].value, p.message});
    else if (const Argument* of = p.node == "files" ? argument_for(arguments, p.parameter) : nullptr)
      problems.push_back({{}, of->name + " " + of->value, without_subject(p.message)});
    else if (is_source || p.node == "files")
      problems.push_back({{},
                          p.parameter == "interpret"        ? "--interpret"
                          : is_source                       ? "FOLDER"
                          : p.parameter.starts_with("maps") ? "--maps"
                                                            : "-o",
                          for_command_line(p.message, arguments.front().value)});
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
  std::string out, scale, size, seed, quality, blend, join, tones, engine, maps, format, tileable, method = "layout";
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

/// The value of the parameter `maps` of export: "normal, height" as a list.
std::string list_of_maps(const std::string& maps) {
  std::vector<std::string> quoted;
  for (size_t from = 0; from <= maps.size();) {
    const size_t comma = std::min(maps.find(',', from), maps.size());
    std::string name = maps.substr(from, comma - from);
    std::erase(name, ' ');
    quoted.push_back(in_quotes(name));
    from = comma + 1;
  }
  return fmt::format("[{}]", fmt::join(quoted, ", "));
}

std::vector<Argument> arguments_of(const SynthFlags& flags) {
  std::vector<Argument> out = {{"FOLDER", "material", flags.exemplar.folder}, {"-o", "out", flags.out}};
  const auto add = [&](const char* name, const std::string& parameter, const std::string& value) {
    if (!value.empty()) out.push_back({name, parameter, value});
  };
  add("--name", "name", flags.exemplar.name);
  for (const auto& [map, how] : flags.exemplar.interpretations())
    add("--interpret", flags.exemplar.is_picture() ? "exemplar.interpret" : "exemplar.interpret." + map, how);
  add("--scale", "scale", flags.scale);
  add("--size", "size", flags.size);
  add("--seed", "seed", flags.seed);
  add("--quality", "quality", flags.quality);
  add("--blend", "blend", flags.blend);
  add("--join", "join", flags.join);
  add("--tones", "tones", flags.tones);
  add("--format", "format", flags.format);
  add("--tileable", "tileable", flags.tileable);
  if (!flags.maps.empty()) add("--maps", "files.maps", list_of_maps(flags.maps));
  return out;
}

int make(const SynthFlags& flags) {
  const std::vector<Argument> arguments = arguments_of(flags);
  if (same_folder(flags.exemplar.folder, flags.out))
    throw UsageError(fmt::format("-o {}: the result would overwrite the exemplar; name another folder", flags.out));
  try {
    const ChosenGraph graph = chosen_graph(flags);
    if (!graph.name) return graph.code;
    const std::string file = fmt::format("stock graph {}.json", graph.name);
    const std::string text = synth_graph(graph.name, flags.exemplar, flags.engine);
    const auto load = [&](const LoadOptions& options) {
      const std::vector<Override> set = overrides_of(arguments, flags.set);
      return GraphToRun{load_graph_text(text, file, set, options).graph, options.only};
    };
    return run_with_flags({.load = load}, flags);
  } catch (const GraphError& e) {
    throw about_arguments(e, arguments);
  }
}

/// The names of a folder's materials, if it holds several and --name picks none. What has no name cannot be picked.
std::vector<std::string> materials_to_make(const ExemplarFlags& exemplar) {
  std::error_code failure;
  if (!exemplar.name.empty() || !std::filesystem::is_directory(exemplar.folder, failure)) return {};
  std::vector<std::string> names;
  try {
    names = several_materials(exemplar.folder);
  } catch (const Error&) {
    return {};  // what makes it says why
  }
  if (std::erase(names, "") > 0)
    print_message(
        "warning: {} has maps whose names name no material; they are left out: --name '*' takes all files "
        "as one material\n",
        exemplar.folder);
  return names;
}

/// Makes one after another, each into a folder of its name. The exit code is that of the first that failed.
int make_all(const SynthFlags& flags, const std::vector<std::string>& names) {
  for (const auto& [option, value] :
       {std::pair{"--report", flags.report}, std::pair{"--summary", flags.summary}, std::pair{"--trace", flags.trace},
        std::pair{"--watch", std::string(flags.watch ? " " : "")}})
    if (!value.empty())
      throw UsageError(fmt::format("{}: {} holds {} materials ({}), and it is for one; --name NAME picks one", option,
                                   flags.exemplar.folder, names.size(), fmt::join(names, ", ")));
  print_message("{} materials; --name NAME makes one of them\n", names.size());
  int code = exit_done;
  for (const std::string& name : names) {
    SynthFlags one = flags;
    one.exemplar.name = name;
    if (flags.out.find("{material}") == std::string::npos) one.out = (std::filesystem::path(flags.out) / name).string();
    print_message("\n{}:\n", name);
    int made = exit_failed;
    try {
      made = make(one);
    } catch (const GraphError& e) {
      for (const Problem& p : e.problems()) print_message("error: {}: {}\n", name, p.message);
    }
    if (made == exit_cancelled) return made;
    if (code == exit_done) code = made;
  }
  return code;
}

}  // namespace

void add_synth_command(Command& program) {
  Command& synth =
      program.add_command("synth", "Makes a larger material from a folder of maps or a picture, without a graph file");
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
      .takes("LEVEL")
      .suggests({"draft", "normal", "best"});
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
      .add_option("--engine", &flags->engine,
                  fmt::format("Writes what an engine or a renderer reads, with its names, packing of channels and "
                              "direction of normals: {}; if not given, every map in a file of its own",
                              fmt::join(engine_names(), ", ")))
      .takes("NAME")
      .one_of(engine_names());
  synth.add_option("--maps", &flags->maps, "Which maps to write, such as normal,height; all of them if not given")
      .takes("NAMES")
      .suggests({semantic_names.begin(), semantic_names.end()})
      .not_with("--engine");
  synth
      .add_option("--format", &flags->format,
                  "png, tif, exr or jpg, also spelled tiff or jpeg; png if not given. Float maps need exr or tif")
      .takes("FORMAT")
      .suggests({"png", "tif", "exr", "jpg"});
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
  synth.footer =
      "A folder of several materials makes all of them, each in a folder of its name.\n"
      "Examples:\n"
      "  terrazzo synth bricks/ -o out --size 2048x2048 --seed 7\n"
      "  terrazzo synth photo.jpg -o out --scale 3 --tileable\n"
      "  terrazzo synth bricks/ -o Content/Bricks --engine unreal";
  synth.run = [flags] {
    check_picture_flags(flags->exemplar);
    const std::vector<std::string> names = materials_to_make(flags->exemplar);
    return names.empty() ? make(*flags) : make_all(*flags, names);
  };
}

}  // namespace terrazzo
