#include "runner/editor/layout_edits.h"

#include <cmath>
#include <fstream>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "graphs/text/stock_graphs.h"
#include "nodes/common/registry.h"
#include "runner/editor/document.h"
#include "runner/editor/state.h"
#include "tests/run_node.h"

using namespace terrazzo;
using nlohmann::ordered_json;
using terrazzo::test::TemporaryFolder;

namespace {

/// A document in a folder of its own.
class LaidOut {
 public:
  explicit LaidOut(std::string text) : document_(folder_.path() / "g.json", std::move(text)) {}

  void edit(const char* edits) { document_.edit({{"edits", ordered_json::parse("[" + std::string(edits) + "]")}}); }
  void undo() { document_.undo(); }
  ordered_json level(const std::string& name = "") { return state_json(document_.snapshot())["levels"][name]; }
  std::map<std::string, std::pair<double, double>> places(const std::string& name = "") {
    std::map<std::string, std::pair<double, double>> out;
    const ordered_json shown = level(name);
    for (const ordered_json& n : shown["nodes"]) out[n["name"]] = {n["x"], n["y"]};
    return out;
  }

 private:
  TemporaryFolder folder_;
  EditedDocument document_;
};

std::string stock_text(std::string_view name) {
  for (const StockGraph& g : stock_graphs())
    if (g.name == name) return std::string(g.text);
  FAIL(name);
  return "";
}

const char* chain = R"({"terrazzo": 1, "nodes": {
  "stones": {"type": "pattern"}, "height": {"type": "get_map", "material": "@stones", "map": "height"},
  "soft": {"type": "blur", "image": "@height"}, "hard": {"type": "blur", "image": "@height"}}})";

}  // namespace

TEST_CASE("edits leave the nodes that they are not about where they are seen") {
  const std::string text = stock_text("material");
  for (const char* edit :
       {R"({"op": "add", "type": "blur", "x": 900, "y": 40})",
        R"({"op": "add", "type": "crop", "behind": {"node": "exemplar"}})", R"({"op": "remove", "nodes": ["guides"]})",
        R"({"op": "rename", "node": "index", "to": "a"})",
        R"({"op": "disconnect", "node": "space", "port": "features"})",
        R"({"op": "group", "nodes": ["space", "index"], "name": "part"})"}) {
    CAPTURE(edit);
    LaidOut graph(text);
    const auto before = graph.places();
    REQUIRE(before.size() > 5);
    graph.edit(edit);
    for (const auto& [name, place] : graph.places())
      if (const auto at = before.find(name); at != before.end()) CHECK_MESSAGE(at->second == place, name);
    graph.undo();
    CHECK(graph.places() == before);
  }
}

TEST_CASE("cards do not overlap") {
  for (const StockGraph& stock : stock_graphs()) {
    CAPTURE(stock.name);
    LaidOut graph{std::string(stock.text)};
    const ordered_json nodes = graph.level()["nodes"];
    for (size_t i = 0; i < nodes.size(); i++)
      for (size_t j = i + 1; j < nodes.size(); j++) {
        const auto height = [](const ordered_json& n) {
          const NodeType* type = find_node_type(n["type"].get<std::string>());
          return 49.0 + 17.0 * double(type ? std::max(type->inputs.size(), type->outputs.size())
                                           : std::max(n["inputs"].size(), n["outputs"].size()));
        };
        const auto &a = nodes[i], &b = nodes[j];
        const double ay = a["y"], by = b["y"];
        const bool are_apart = std::abs(a["x"].get<double>() - b["x"].get<double>()) >= 176 || ay + height(a) <= by ||
                               by + height(b) <= ay;
        CHECK_MESSAGE(are_apart, a["name"] << " and " << b["name"]);
      }
  }
}

TEST_CASE("a long chain goes on in rows") {
  const auto shape_of = [](int count) {
    std::string nodes = R"("n0": {"type": "pattern"})", last = "n0";
    for (int i = 1; i < count; i++) {
      const std::string name = "n" + std::to_string(i);
      nodes += ", \"" + name + R"(": {"type": "crop", "material": "@)" + last + "\"}";
      last = name;
    }
    LaidOut graph("{\"terrazzo\": 1, \"nodes\": {" + nodes + "}}");
    double width = 0, height = 0;
    for (const auto& [name, at] : graph.places()) {
      width = std::max(width, at.first + 176);
      height = std::max(height, at.second + 66);
    }
    return std::pair(width, height);
  };
  CHECK(shape_of(8).second < 120);  // a short one stays in its row
  for (const int count : {12, 30, 80}) {
    CAPTURE(count);
    const auto [width, height] = shape_of(count);
    CHECK(width < (count > 20 ? 4.5 : 7) * height);
    CHECK(height < 1.5 * width);
  }
}

TEST_CASE("the node of a group covers no other") {
  LaidOut graph(R"({"terrazzo": 1, "nodes": {"a": {"type": "pattern"}, "b": {"type": "crop", "material": "@a"},
    "c": {"type": "crop", "material": "@b"}, "d": {"type": "crop", "material": "@c"}}})");
  graph.edit(R"({"op": "move", "positions": {"a": [0, 300], "b": [240, 0], "c": [480, 0], "d": [720, 0]}})");
  graph.edit(R"({"op": "group", "nodes": ["b", "d"], "name": "part"})");
  const auto places = graph.places();
  CHECK(places.at("c") == std::pair(480.0, 0.0));
  CHECK(places.at("part").first == 480);
  CHECK(places.at("part").second >= 66);
}

TEST_CASE("a node that was ungrouped comes back where it was") {
  LaidOut graph(chain);
  graph.edit(R"({"op": "group", "nodes": ["height", "soft"], "name": "part"})");
  graph.edit(R"({"op": "move", "positions": {"part": [500, 700]}})");
  graph.edit(R"({"op": "ungroup", "node": "part"})");
  const auto places = graph.places();
  REQUIRE(places.size() == 4);
  for (const auto& [name, place] : places)
    if (name != "stones" && name != "hard") CHECK(place.second > 650);
}

TEST_CASE("nodes that were ungrouped cover no others") {
  LaidOut graph(R"({"terrazzo": 1, "nodes": {"a": {"type": "pattern"}, "b": {"type": "crop", "material": "@a"},
    "c": {"type": "crop", "material": "@b"}, "d": {"type": "crop", "material": "@c"}, "e": {"type": "crop", "material": "@a"}}})");
  graph.edit(
      R"({"op": "move", "positions": {"a": [0, 0], "b": [240, 0], "c": [480, 0], "d": [720, 0], "e": [240, 70]}})");
  graph.edit(R"({"op": "group", "nodes": ["b", "c"], "name": "part"})");
  graph.edit(R"({"op": "move", "positions": {"part": [240, 0], "d": [480, 0]}})");
  graph.edit(R"({"op": "ungroup", "node": "part"})");
  const auto places = graph.places();
  REQUIRE(places.size() == 5);
  for (const auto& [one, at] : places)
    for (const auto& [other, there] : places)
      if (one < other)
        CHECK_MESSAGE((std::abs(at.first - there.first) >= 176 || std::abs(at.second - there.second) >= 66), one, " ",
                      other);
  CHECK(places.at("d").first > places.at("c").first);
}

TEST_CASE("bends of wires follow names and go with their wires") {
  LaidOut graph(chain);
  const char* bend = R"({"op": "bend", "wire": "height.image > soft.image", "points": [[10, 20], [30.4, 40]]})";
  graph.edit(bend);
  CHECK(graph.level()["bends"] == ordered_json::parse(R"({"height.image > soft.image": [[10, 20], [30, 40]]})"));
  graph.edit(R"({"op": "rename", "node": "height", "to": "h"})");
  graph.edit(R"({"op": "rename", "node": "soft", "to": "s"})");
  CHECK(graph.level()["bends"].contains("h.image > s.image"));
  graph.edit(R"({"op": "remove", "nodes": ["hard"]})");
  CHECK(graph.level()["bends"].size() == 1);
  graph.edit(R"({"op": "disconnect", "node": "s", "port": "image"})");
  CHECK(graph.level()["bends"].empty());
  graph.undo();
  CHECK(graph.level()["bends"].size() == 1);
  graph.edit(R"({"op": "bend", "wire": "h.image > s.image", "points": []})");
  CHECK(graph.level()["bends"].empty());
  CHECK_THROWS_AS(graph.edit(bend), EditRefused);
}
