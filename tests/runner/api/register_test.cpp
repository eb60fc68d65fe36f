#include <doctest/doctest.h>

#include "core/base/error.h"
#include "nodes/common/registry.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

NodeType sample(const std::string& name, const std::string& summary = "") {
  NodeType t;
  t.name = name;
  t.category = "image";
  t.summary = summary;
  t.outputs = {{.name = "image"}};
  t.origin.name = "the tests";
  t.compute = [](NodeContext&) {};
  return t;
}

std::string error(NodeType t) {
  try {
    register_node_type(std::move(t));
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

}  // namespace

TEST_CASE("a node type that is registered is found, and one of the same origin replaces it") {
  const std::vector<NodeType>& before = node_types();
  const size_t count = before.size();
  CHECK(error(sample("registered_one", "first")).empty());
  const NodeType* first = find_node_type("registered_one");
  REQUIRE(first);
  CHECK(error(sample("registered_one", "second")).empty());
  CHECK(find_node_type("registered_one")->summary == "second");
  CHECK(first->summary == "first");  // graphs that hold it keep it
  CHECK(before.size() == count);
  CHECK(node_types().size() == count + 1);
  NodeType other = sample("registered_one");
  other.origin.name = "others";
  CHECK(contains(error(other), "already exists, from the tests"));
}

TEST_CASE("descriptors that cannot work, and names that are taken, are refused") {
  const auto changed = [](auto change) {
    NodeType t = sample("registered_two");
    change(t);
    return error(std::move(t));
  };
  CHECK(contains(error(sample("blur")), "the node type \"blur\" of the tests already exists, from terrazzo"));
  CHECK(contains(changed([](NodeType& t) { t.name = "2 words"; }), "must begin with a letter"));
  CHECK(contains(changed([](NodeType& t) { t.compute = nullptr; }), "no compute function"));
  CHECK(contains(changed([](NodeType& t) { t.category = "images"; }), "its category is \"images\""));
  CHECK(contains(changed([](NodeType& t) { t.outputs.clear(); }), "no output"));
  CHECK(contains(changed([](NodeType& t) { t.origin.name.clear(); }), "where it comes from"));
  CHECK(contains(changed([](NodeType& t) { t.params = {{.name = "type"}}; }), "parameter \"type\""));
  CHECK(contains(changed([](NodeType& t) { t.inputs = {{.name = "a"}, {.name = "a"}}; }), "input \"a\""));
  CHECK_FALSE(find_node_type("registered_two"));
}
