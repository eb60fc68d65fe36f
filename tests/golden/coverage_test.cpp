#include <set>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "graphs/document/load.h"
#include "nodes/common/registry.h"
#include "test_paths.h"
#include "tests/golden/documents.h"

/// The golden cases leave out no node type, no choice and no parameter.
using namespace terrazzo;
using namespace terrazzo::test;

namespace {

/// How the golden cases use a node type.
struct Use {
  std::map<std::string, std::vector<ParamValue>> values;  ///< different ones, by parameter
  std::set<std::string> inputs;
  int cases = 0;
};

std::map<std::string, Use> uses() {
  std::map<std::string, Use> out;
  const GoldenSession session;
  for (const std::string& group : golden_groups())
    for (const GoldenDocument& document : documents_of(group)) {
      if (document.stock) continue;  // those are to be free to change
      for (const GraphNode& n : session.load(document).graph.nodes) {
        Use& use = out[n.type->name];
        use.cases++;
        for (const auto& [port, wires] : n.inputs) use.inputs.insert(port);
        for (const auto& [name, value] : n.params) {
          std::vector<ParamValue>& values = use.values[name];
          if (std::find(values.begin(), values.end(), value) == values.end()) values.push_back(value);
        }
      }
    }
  return out;
}

}  // namespace

TEST_SUITE_BEGIN("golden");

TEST_CASE("every node type, input and parameter has golden cases") {
  std::map<std::string, Use> all = uses();
  for (const NodeType& type : node_types()) {
    CAPTURE(type.name);
    const Use& use = all[type.name];
    CHECK_MESSAGE(use.cases > 0, type.name, ": no case in tests/golden/cases");
    for (const Port& p : type.inputs)
      CHECK_MESSAGE(use.inputs.count(p.name), type.name, ": no golden case connects ", p.name);
    for (const Param& p : type.params) {
      const auto found = use.values.find(p.name);
      const std::vector<ParamValue> values = found == use.values.end() ? std::vector<ParamValue>() : found->second;
      if (p.type == ParamType::choice) {
        for (const std::string& choice : p.choices)
          CHECK_MESSAGE(std::find(values.begin(), values.end(), ParamValue(choice)) != values.end(), type.name,
                        ": no golden case has ", p.name, " = ", choice);
      } else {
        CHECK_MESSAGE(values.size() >= (p.fallback ? 2 : 1), type.name, ": all golden cases have the same ", p.name);
      }
    }
  }
}

TEST_CASE("every stock graph has golden results") {
  std::set<std::string> covered, there;
  for (const GoldenDocument& d : documents_of("graphs")) covered.insert(d.graph.filename());
  // Those with inputs are nodes of others.
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(TERRAZZO_SOURCE_DIR) / "graphs"))
    if (entry.path().extension() == ".json" && read_interface(entry.path()).inputs.empty())
      there.insert(entry.path().filename());
  CHECK(covered == there);
}

TEST_SUITE_END();
