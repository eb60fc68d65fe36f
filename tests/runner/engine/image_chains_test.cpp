#include <csignal>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "tests/runner/fakes.h"
#include "tests/runner/workplace.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

constexpr int many = 10000;

/// A node of category image with one parameter, and which nodes it reads.
struct ImageNode {
  std::string type;
  std::string param;
  double value;
  std::vector<std::pair<std::string, int>> inputs;
};

std::string graph_of(const std::vector<ImageNode>& nodes, int side) {
  std::string text = fmt::format(R"({{"terrazzo": 1, "nodes": {{
  "n0": {{"type": "noise", "size": {}}})",
                                 side);
  for (size_t i = 1; i <= nodes.size(); i++) {
    const ImageNode& node = nodes[i - 1];
    text += fmt::format(",\n  \"n{}\": {{\"type\": \"{}\", \"{}\": {}", i, node.type, node.param, node.value);
    for (const auto& [port, source] : node.inputs) text += fmt::format(", \"{}\": \"@n{}\"", port, source);
    text += "}";
  }
  return text +
         fmt::format(",\n  \"file\": {{\"type\": \"export\", \"material\": \"@n{}\", \"path\": \"out.png\"}}}}}}",
                     nodes.size());
}

/// Writes what the nodes make when each one's pixels are computed before the next one's.
void write_expected(const std::vector<ImageNode>& nodes, int side, const std::filesystem::path& path) {
  std::vector<ImagePtr> images = {run_node("noise", {{"size", Size{side, side}}}).get<Image>("image")};
  for (const ImageNode& node : nodes) {
    std::map<std::string, std::vector<Value>> inputs;
    for (const auto& [port, source] : node.inputs) inputs[port] = {images[size_t(source)]};
    const ParamValue value = node.type == "levels" ? ParamValue(Numbers{node.value}) : ParamValue(node.value);
    images.push_back(materialized(run_node(node.type, {{node.param, value}}, inputs).get<Image>("image")));
  }
  run_node("export", {{"path", path.string()}}, {{"material", {images.back()}}});
}

void check_run(const std::vector<ImageNode>& nodes) {
  const TemporaryFolder folder;
  constexpr int side = 16;
  write_text(folder.path() / "graph.json", graph_of(nodes, side));
  CHECK(run_program(folder.path(), {"check", "graph.json"}).code == 0);
  const ProgramRun run = run_program(folder.path(), {"run", "graph.json", "--no-cache"});
  CHECK_MESSAGE(run.code == 0, run.err.substr(0, 1000));
  write_expected(nodes, side, folder.path() / "expected.png");
  CHECK(read_text(folder.path() / "out.png") == read_text(folder.path() / "expected.png"));
}

}  // namespace

TEST_CASE("a graph of 10,000 image nodes in a chain is run, to the same pixels as node by node") {
  std::vector<ImageNode> nodes;
  for (int i = 0; i < many; i++) {
    if (i % 3)
      nodes.push_back({"blur", "radius", 0.3, {{"image", i}}});
    else
      nodes.push_back({"levels", "in_white", 0.99, {{"image", i}}});
  }
  check_run(nodes);
}

TEST_CASE("a graph of 10,000 image nodes that each read the one before twice is run") {
  std::vector<ImageNode> nodes;
  for (int i = 0; i < many; i++)
    nodes.push_back({"blend", "opacity", i % 2 ? 0.25 : 0.5, {{"base", i}, {"top", i}, {"mask", std::max(0, i - 2)}}});
  check_run(nodes);
}

TEST_CASE("a graph in which thousands of image nodes read one is run") {
  std::vector<ImageNode> nodes = {{"blur", "radius", 1.5, {{"image", 0}}}};
  for (int i = 2; i <= many; i++)
    if (i % 2)
      nodes.push_back({"blend", "opacity", 0.01, {{"base", i - 2}, {"top", i - 1}}});
    else
      nodes.push_back({"levels", "in_black", i * 1e-5, {{"image", 1}}});
  check_run(nodes);
}

TEST_CASE("a run is stopped while the pixels of a long chain of images are computed") {
  const TemporaryFolder folder;
  std::vector<ImageNode> nodes;
  for (int i = 0; i < many; i++) nodes.push_back({"blur", "radius", 5, {{"image", i}}});
  write_text(folder.path() / "graph.json", graph_of(nodes, 2048));
  StartedProgram program(folder.path(), {"run", "graph.json", "--no-cache", "--progress", "json"});
  REQUIRE(program.says("\"start\",\"node\":\"file\""));
  program.signal(SIGINT);
  const ProgramRun run = program.wait();  // of the hours that it would take
  CHECK(run.code == 130);
  CHECK(!std::filesystem::exists(folder.path() / "out.png"));
}
