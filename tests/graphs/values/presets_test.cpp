#include "graphs/values/presets.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "graphs/tools/reference.h"
#include "tests/graphs/document/fake_types.h"
#include "tests/run_node.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

/// A graph of two nodes with a parameter `steps`, and `presets` in it.
std::string graph(const std::string& presets) {
  return fmt::format(R"({{"terrazzo": 1,
  "parameters": {{"steps": {{"type": "int", "default": 3, "help": "How often.", "group": "Look"}}}},
  "presets": {{{}}},
  "nodes": {{"a": {{"type": "photo", "file": "a.png"}},
            "b": {{"type": "adjust", "image": "@a", "steps": "$steps"}}}}}})",
                     presets);
}

LoadedGraph load(const fs::path& file, const std::vector<std::string>& presets,
                 const std::vector<fs::path>& settings = {}, const std::vector<std::string>& set = {}) {
  return load_graph(file, overrides_from(set), {.types = fake_types(), .presets = presets, .settings = settings});
}

int64_t steps(const LoadedGraph& loaded) {
  return std::get<int64_t>(loaded.graph.find("b")->params.at("steps"));
}

std::string problems(const fs::path& file, const std::vector<std::string>& presets,
                     const std::vector<fs::path>& settings = {}) {
  try {
    load(file, presets, settings);
  } catch (const GraphError& e) {
    return e.what();
  }
  return "";
}

}  // namespace

TEST_CASE("presets, settings files and overrides count in this order") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "g.json";
  write_text(
      file,
      graph(R"("few": {"help": "hardly", "set": {"steps": 1, "b.amount": 0.25}}, "many": {"set": {"steps": 9}})"));
  write_text(folder.path() / "s.json", R"({"steps": 20, "b.label": "from a file"})");
  CHECK(steps(load(file, {})) == 3);
  CHECK(steps(load(file, {"few"})) == 1);
  CHECK(std::get<double>(load(file, {"few"}).graph.find("b")->params.at("amount")) == 0.25);
  CHECK(steps(load(file, {"few", "many"})) == 9);
  CHECK(steps(load(file, {"many", "few"})) == 1);
  CHECK(steps(load(file, {"many"}, {folder.path() / "s.json"})) == 20);
  CHECK(steps(load(file, {"many"}, {folder.path() / "s.json"}, {"steps=5"})) == 5);
  CHECK(std::get<std::string>(load(file, {}, {folder.path() / "s.json"}).graph.find("b")->params.at("label")) ==
        "from a file");
}

TEST_CASE("presets beside a graph are found; paths of presets and settings lie where they are written") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "g.json";
  write_text(file, graph(R"("here": {"set": {"a.file": "here.png"}})"));
  write_text(folder.path() / "g.presets.json", R"({"beside": {"help": "x", "set": {"steps": "=2 * 4"}}})");
  fs::create_directory(folder.path() / "deeper");
  write_text(folder.path() / "deeper/s.json", R"({"a.file": "there.png"})");
  CHECK(steps(load(file, {"beside"})) == 8);
  const auto path = [](const LoadedGraph& loaded) {
    return std::get<std::string>(loaded.graph.find("a")->params.at("file"));
  };
  CHECK(path(load(file, {"here"})) == folder.path() / "here.png");
  CHECK(path(load(file, {}, {folder.path() / "deeper/s.json"})) == folder.path() / "deeper/there.png");
}

TEST_CASE("what is wrong in presets and settings is said with file, line and column") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "g.json";
  const auto with = [&](const std::string& presets, const std::vector<std::string>& chosen) {
    write_text(file, graph(presets));
    return problems(file, chosen);
  };
  CHECK(with(R"("few": {"set": {"steps": 1}})", {"fwe"})
            .find("--preset fwe: the graph has no preset of that name (did "
                  "you mean \"few\"?)") != std::string::npos);
  CHECK(with("", {"few"}).find("--preset few: the graph has no preset of that name; it has none") != std::string::npos);
  CHECK(with(R"("few": {"set": {"stepps": 1}})", {})
            .find(":3:31: preset \"few\", \"stepps\": the graph has no "
                  "parameter \"stepps\" (did you mean \"steps\"?)") != std::string::npos);
  CHECK(with(R"("few": {"set": {"stepps": 1}})", {"few"}).find("did you mean \"steps\"?") != std::string::npos);
  CHECK(with(R"("few": {"set": {"b.amuont": 1}})", {}).find("adjust has no port or parameter \"amuont\"") !=
        std::string::npos);
  CHECK(with(R"("few": {"set": {"c.amount": 1}})", {}).find("the graph has no node \"c\"") != std::string::npos);
  CHECK(with(R"("few": {"set": {"steps": 0.5}})", {"few"})
            .find(":3:40: preset \"few\", \"steps\": expected an integer") != std::string::npos);
  CHECK(with(R"("few": {"sett": {}})", {}).find("unknown key \"sett\" (did you mean \"set\"?)") != std::string::npos);
  CHECK(with(R"("few": 3)", {}).find("expected an object such as") != std::string::npos);
  write_text(file, graph(""));
  const fs::path settings = folder.path() / "s.json";
  CHECK(problems(file, {}, {settings}).find("s.json: there is no such settings file") != std::string::npos);
  write_text(settings, "{\"steps\": 3,\n \"stepps\": 4}");
  CHECK(problems(file, {}, {settings}).find("s.json:2:2: \"stepps\": the graph has no parameter") != std::string::npos);
  write_text(settings, "[3]");
  CHECK(problems(file, {}, {settings}).find("expected an object such as {\"seed\": 3") != std::string::npos);
  write_text(settings, "{\"steps\" 3}");
  CHECK(problems(file, {}, {settings}).find("s.json:1:10") != std::string::npos);
}

TEST_CASE("a graph's reference lists its parameters by group, and its presets") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "g.json";
  write_text(file, R"({"terrazzo": 1, "summary": "Bricks", "help": "All about bricks.",
    "parameters": {
      "seed": {"type": "int", "default": 1, "min": 0, "help": "Another one."},
      "wear": {"type": "number", "default": "=seed / 2", "unit": "percent", "group": "Look", "visible_if": "=seed > 3"}},
    "presets": {"worn": {"help": "chipped", "set": {"seed": 3}}},
    "nodes": {}})");
  CHECK(graph_reference("g.json", read_interface(file)) ==
        "g.json: Bricks\n"
        "\n"
        "All about bricks.\n"
        "\n"
        "Parameters (--set NAME=VALUE)\n"
        "  seed: an integer of at least 0; default 1\n"
        "      Another one.\n"
        "\n"
        "Look\n"
        "  wear: a number (percent); default \"=seed / 2\"\n"
        "      only if seed > 3\n"
        "\n"
        "Presets (--preset NAME)\n"
        "  worn: chipped\n"
        "      sets seed\n");
}
