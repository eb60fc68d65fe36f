#include "tests/golden/documents.h"

#include <algorithm>
#include <bit>
#include <cstdlib>

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <hwy/targets.h>

#include "graphs/document/forecasts.h"
#include "runner/engine/schedule.h"
#include "test_paths.h"
#include "tests/golden/inputs.h"

namespace terrazzo::test {

namespace {

namespace fs = std::filesystem;

const fs::path source_folder = TERRAZZO_SOURCE_DIR;

GoldenDocument own(const std::string& name) {
  return {name, source_folder / "tests" / "golden" / "cases" / (name + ".json"), {}, false};
}

GoldenDocument stock(const std::string& graph, std::vector<std::string> settings, const std::string& variant = "") {
  const std::string name = variant.empty() ? graph : graph + "-" + variant;
  settings.push_back("out={out}");
  return {name, source_folder / "graphs" / (graph + ".json"), std::move(settings), true};
}

std::vector<GoldenDocument> stock_documents() {
  const std::string wall = "material={in}/wall", small = "size=72x60", square = "size=64x64";
  return {
      stock("generate-exemplar", {"type=tiles", square}),
      stock("texture", {"image={in}/photo/base_color.png", small, "blend=1.5", "tileable=xy"}),
      stock("texture", {"image={in}/photo/base_color.png", "size=49x37", "quality=best", "format=exr"}, "best"),
      stock("material", {wall, small, "seed=3"}),
      stock("material", {wall, small, "quality=draft", "tileable=x", "format=tif", "blend=2"}, "draft"),
      stock("masked", {wall, "mask={in}/mask.png", small}),
      stock("inpaint", {wall, "mask={in}/holes.png"}),
      stock("inpaint", {wall, "mask={in}/holes.png", "quality=best", "margin=0", "join=6"}, "best"),
      stock("make_tileable", {wall, "tiles=no"}),
      stock("make_tileable", {"material={in}/photo", "fit=size", "directions=x", "border=9"}, "photo"),
      stock("extend", {wall, "kept=48x40", "size=80x72", "at=[20, 12]"}),
      stock("variants", {"material={in}/photo", small, "scales=[0.8]", "rotations=[90]", "mirror=x"}),
      stock("several", {"first={in}/wall", "second={in}/wall2", small}),
      stock("mix", {"first={in}/wall", "second={in}/wall2", "mix={in}/ramp.png", small, "leeway=4"}),
      stock("mix", {"first={in}/wall", "second={in}/wall2", "mix={in}/ramp.png", small, "border=height", "width=20"},
            "height"),
      stock("labels", {wall, "labels={in}/labels.png", "target={in}/layout.png", small, "leeway=3"}),
      stock("progression", {"material={in}/blend", "target={in}/ramp.png", small}),
      stock("transfer", {"material={in}/blend", "target={in}/ramp.png", small, "strength=3"}),
      stock("magnify", {wall, "analysed=0.5", "size=40x36"}),
      stock("engine", {wall, "engine=unity_hdrp", "scale=1.2"}),
      stock("engine", {"material={in}/photo", "make=tileable", "engine=godot"}, "tileable"),
      stock("noise", {"material={in}/blend", small, "tileable=xy"}),
      stock("layered", {"base={in}/wall", "top={in}/wall2", small}),
      stock("analyse", {wall}),
      stock("from_analysis", {"analysis={in}/../out/analyse.analysis", wall, small}),
  };
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

GoldenLine line_of(const std::string& name, const NodeType& type, const std::string& port, const Content& content) {
  return {name, type.name, type.version, port, content};
}

}  // namespace

std::vector<std::string> golden_groups() {
  return {"image", "analysis", "synthesis", "masonry", "sink", "graphs"};
}

std::vector<GoldenDocument> documents_of(const std::string& group) {
  if (group == "graphs") return stock_documents();
  if (group == "image") return {own("source"), own("image"), own("color"), own("picture")};
  if (group == "analysis") return {own("analysis"), own("steering")};
  if (group == "synthesis")
    return {own("synthesis"), own("controls"), own("kept"), own("resolve"), own("noise_by_example")};
  if (group == "masonry") return {own("lattice"), own("masonry")};
  return {own("sink"), own("read_back")};
}

std::string file_of(const GoldenDocument& document, const NodeType& type) {
  return document.stock ? "graphs" : type.category;
}

GoldenSession::GoldenSession() {
  ::unsetenv("OCIO");  // the built-in colour configuration, whatever the user works with
  if (std::getenv("TERRAZZO_GOLDEN_OLDEST"))
    hwy::SetSupportedTargetsForTest(int64_t(std::bit_floor(uint64_t(hwy::SupportedTargets()))));
  write_golden_inputs(folder_.path() / "in");
}

fs::path GoldenSession::out_of(const GoldenDocument& document) const {
  const fs::path out = folder_.path() / "out" / document.name;
  return document.stock && document.graph.stem() == "analyse" ? fs::path(out.string() + ".analysis") : out;
}

LoadedGraph GoldenSession::load(const GoldenDocument& document) const {
  std::vector<std::string> settings = document.settings;
  if (!document.stock) {
    settings = {"in={in}", "out={out}"};
    // Not every document reads, or writes, files.
    const auto parameters = read_interface(document.graph).parameters;
    std::erase_if(settings, [&](const std::string& s) {
      return std::none_of(parameters.begin(), parameters.end(),
                          [&](const GraphParameter& p) { return s.starts_with(p.param.name + "="); });
    });
  }
  for (std::string& s : settings) {
    s = replaced(s, "{in}", (folder_.path() / "in").string());
    s = replaced(s, "{out}", out_of(document).string());
  }
  return load_graph(document.graph, overrides_from(settings));
}

std::vector<GoldenCase> GoldenSession::run(const GoldenDocument& document) const {
  const LoadedGraph loaded = load(document);
  RunOptions options;
  for (const GraphNode& n : loaded.graph.nodes) options.targets.keep.push_back(n.name);
  const RunResult result = run_graph(loaded.graph, options);
  for (const Failure& f : result.failures) FAIL_CHECK(f.message);
  REQUIRE(result.ok());

  std::vector<GoldenCase> out;
  std::map<std::string, bool> decided;
  Forecasts forecasts;
  for (size_t i = 0; i < loaded.graph.nodes.size(); i++) {
    const GraphNode& node = loaded.graph.nodes[i];
    const NodeType& type = *node.type;
    GoldenCase c;
    c.file = file_of(document, type);
    c.decided = type.category == "analysis" || type.category == "synthesis";
    for (const auto& [port, wires] : node.inputs)
      for (const Wire& w : wires) {
        c.sources.push_back({document.name + "/" + w.node, w.port});
        c.decided = c.decided || decided.at(w.node);
      }
    decided[node.name] = c.decided;
    if (type.files_read) c.files_in = type.files_read(node.params);
    const std::string name = document.name + "/" + node.name;
    forecasts.add(node);
    for (const Port& p : type.outputs)
      if (const Forecast* known = forecasts.find_output({node.name, p.name}))
        CHECK_MESSAGE(contradiction(*known, result.kept.at(node.name).at(p.name)) == "", name << "." << p.name);
    for (const Port& p : type.outputs)
      c.lines.push_back(line_of(name, type, p.name, content_of(result.kept.at(node.name).at(p.name))));
    for (const OutputFile& f : result.stages[i].files) {
      c.files_out.push_back(f.path);
      const fs::path place = f.path.lexically_relative(folder_.path() / "out");
      c.lines.push_back(line_of(name, type, place.generic_string(), content_of_file(f.path)));
    }
    REQUIRE_MESSAGE(!c.lines.empty(), name);
    out.push_back(std::move(c));
  }
  return out;
}

}  // namespace terrazzo::test
