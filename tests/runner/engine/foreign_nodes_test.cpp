#include <stdexcept>

#include <doctest/doctest.h>

#include "core/base/variables_read.h"
#include "graphs/text/problem.h"
#include "runner/plan/key.h"
#include "tests/runner/fakes.h"

/// What nodes that others have written may do.
using namespace terrazzo;
using namespace terrazzo::test;

namespace {

Digest key(const NodeType& type) {
  const GraphNode node{"a", &type, {{"value", 1.0}}, {}, {}, {}};
  return key_of(ingredients_of(node, {}, [](const auto&) { return Digest(); }));
}

}  // namespace

TEST_CASE("variables of the environment that a node notes are in its key, with their values") {
  FakeTypes t;
  NodeType type = t.number;
  std::map<std::string, std::string> noted;
  type.files_read = [&](const Params&) {
    for (const auto& [name, value] : noted) VariablesRead::note(name, value);
    return std::vector<std::filesystem::path>();
  };
  const Digest none = key(type);
  CHECK(none == key(t.number));
  noted = {{"SHOT", "010"}};
  const Digest first = key(type);
  CHECK(first != none);
  noted = {{"SHOT", "020"}};
  CHECK(key(type) != first);
  noted = {{"SHOT", "010"}};
  CHECK(key(type) == first);
}

TEST_CASE("a node that cannot say which files it reads fails by name") {
  FakeTypes t;
  NodeType type = t.number;
  type.files_read = [](const Params&) -> std::vector<std::filesystem::path> { throw Error("out of luck"); };
  try {
    key(type);
    FAIL("nothing was thrown");
  } catch (const GraphError& e) {
    REQUIRE(e.problems().size() == 1);
    CHECK(e.problems()[0].node == "a");
    CHECK(e.problems()[0].message.find("out of luck") != std::string::npos);
  }
}

TEST_CASE("pixels that cannot be made are a failure of the node that makes them, told once") {
  for (const bool is_exception : {true, false}) {
    FakeTypes t;
    NodeType late = t.number;
    late.persist = Persist::derived;
    late.compute = [=](NodeContext& n) {
      const auto fail = [=](const Rect&, float*) {
        if (is_exception) throw std::runtime_error("out of luck");
        throw 3;
      };
      n.output("out", Image::computed(number_image(1)->info(), n.key(), fail));
    };
    Graph g;
    add(g, "maker", late, {{"value", 1.0}});
    add(g, "first", t.sum, {}, {"maker"});
    add(g, "second", t.sum, {{"plus", 1.0}}, {"maker"});
    RunOptions options;
    options.targets.keep_going = true;
    const RunResult r = run_graph(g, options);
    REQUIRE(r.failures.size() == 1);
    CHECK(r.failures[0].node == "maker");
    const std::string says =
        is_exception ? "out of luck" : "what makes its pixels threw something other than a std::exception";
    CHECK_MESSAGE(r.failures[0].message.find(says) != std::string::npos, r.failures[0].message);
  }
}

TEST_CASE("what a node throws that is no exception is its failure, and so is an output that is null") {
  FakeTypes t;
  Graph g;
  NodeType odd = t.number, empty = t.number;
  odd.compute = [](NodeContext&) { throw 3; };
  empty.compute = [](NodeContext& n) { n.output("out", ImagePtr()); };
  add(g, "odd", odd, {{"value", 1.0}});
  add(g, "empty", empty, {{"value", 1.0}});
  RunOptions options;
  options.targets.keep_going = true;
  const RunResult r = run_graph(g, options);
  CHECK(r.failures.size() == 2);
}
