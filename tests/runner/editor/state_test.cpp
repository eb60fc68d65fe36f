#include "runner/editor/state.h"

#include <fstream>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "graphs/tools/descriptor_json.h"
#include "nodes/common/registry.h"
#include "runner/editor/types_json.h"
#include "runner/scheduler/run_tool.h"
#include "tests/run_node.h"

using namespace terrazzo;
using nlohmann::ordered_json;
using terrazzo::test::TemporaryFolder;

namespace {

DocumentSnapshot snapshot_of(const std::string& text, const std::filesystem::path& file = "/nowhere/wall.json") {
  DocumentSnapshot out;
  out.file = file;
  out.text = text;
  return out;
}

ordered_json state_of(const std::string& text) {
  return state_json(snapshot_of(text));
}

const ordered_json& named(const ordered_json& list, const std::string& name) {
  for (const ordered_json& entry : list)
    if (entry["name"] == name) return entry;
  FAIL(name);
  return list;
}

const std::string wall = R"t({
  "terrazzo": 1,
  "summary": "a wall",
  "parameters": {
    "scale": {"type": "number", "default": 2, "min": 1, "group": "size", "help": "how many times"},
    "size": {"type": "size", "default": "=round([64, 32] * scale)"}
  },
  "presets": {"large": {"help": "larger", "set": {"scale": 8, "exemplar.seed": 3}}},
  "nodes": {
    "exemplar": {"type": "pattern", "kind": "bricks", "size": "$size", "seed": "=2 * scale", "comment": "bricks"},
    "find": {"type": "find", "material": "@exemplar", "mode": "off"},
    "layout": {"type": "synthesize", "index": "@find.index", "mute": false}
  },
  "outputs": {"uv": "@layout"},
  "graphs": {
    "find": {
      "inputs": {"material": {"type": "material"}},
      "parameters": {"mode": {"type": "choice", "choices": ["auto", "off"], "default": "auto"}},
      "nodes": {
        "weighted": {"type": "weight", "material": "@material"},
        "lattice": {"type": "regularity", "features": "@weighted", "mode": "$mode"},
        "space": {"type": "pca", "features": "@lattice"},
        "index": {"type": "index", "appearance": "@space"}
      },
      "outputs": {"index": "@index"}
    }
  }
}
)t";

std::string replaced(std::string text, const std::string& old, const std::string& now) {
  return text.replace(text.find(old), old.size(), now);
}

}  // namespace

TEST_CASE("the state has the levels, their nodes, and what expressions come to") {
  const ordered_json state = state_of(wall);
  CHECK(state["problems"] == ordered_json::array());
  CHECK(state["file"] == ordered_json{{"name", "wall.json"}, {"folder", "/nowhere"}});
  const ordered_json& top = state["levels"][""];
  CHECK(top["summary"] == "a wall");
  CHECK(named(top["parameters"], "scale")["group"] == "size");
  CHECK(named(top["parameters"], "scale")["value"] == 2.0);
  CHECK(named(top["parameters"], "size")["default"] == "=round([64, 32] * scale)");
  CHECK(named(top["parameters"], "size")["value"] == ordered_json{128, 64});
  CHECK(named(top["parameters"], "size")["pointer"] == "/parameters/size");
  CHECK(top["presets"] == ordered_json::array({{{"name", "large"},
                                                {"summary", "larger"},
                                                {"beside", false},
                                                {"values", {{"scale", 8}, {"exemplar.seed", 3}}}}}));
  CHECK(top["outputs"][0]["from"] == "@layout");
  CHECK(top["outputs"][0]["type"] == "uv_map");
  const ordered_json& exemplar = named(top["nodes"], "exemplar");
  CHECK(exemplar["known"] == true);
  CHECK(exemplar["category"] == "source");
  CHECK(exemplar["comment"] == "bricks");
  CHECK(exemplar["values"] == ordered_json{{"kind", "bricks"}, {"size", "$size"}, {"seed", "=2 * scale"}});
  CHECK(exemplar["shown"] == ordered_json{{"size", "128x64"}, {"seed", "4"}});
  CHECK_FALSE(exemplar.contains("params"));
  CHECK(named(types_json()["types"], "pattern") == json_of_type(*find_node_type("pattern")));
  const ordered_json& find = named(top["nodes"], "find");
  CHECK(find["level"] == "find");
  CHECK(find["category"] == "graph");
  CHECK(find["params"][0]["choices"] == ordered_json{"auto", "off"});
  CHECK(find["wires"] == ordered_json::array({{{"port", "material"},
                                               {"index", 0},
                                               {"node", "exemplar"},
                                               {"output", "material"},
                                               {"pointer", "/nodes/find/material"}}}));
  CHECK(find["x"] > exemplar["x"]);
  const ordered_json& inner = state["levels"]["find"];
  CHECK(inner["inputs"][0]["type"] == "material");
  CHECK(named(inner["nodes"], "lattice")["shown"]["mode"] == "off");
  CHECK(named(inner["nodes"], "weighted")["wires"][0]["node"] == "material");
}

TEST_CASE("problems are where they are in the document, and the rest of the state is there all the same") {
  std::string text = replaced(wall, "\"kind\": \"bricks\"", "\"kind\": \"bricksy\"");
  text = replaced(text, "\"@lattice\"", "\"@weighted2\"");
  text = replaced(text, "{\"type\": \"synthesize\"", "{\"type\": \"synthesise\"");
  const ordered_json state = state_of(text);
  CHECK(state["problems"].size() >= 3);
  const auto at = [&](const std::string& pointer) {
    for (const ordered_json& p : state["problems"])
      if (p["pointer"] == pointer) return p;
    FAIL(pointer << " " << state["problems"].dump(2));
    return ordered_json();
  };
  CHECK(at("/nodes/exemplar/kind")["key"] == "kind");
  CHECK(at("/nodes/exemplar/kind")["level"] == "");
  CHECK(at("/nodes/layout/type")["node"] == "layout");
  const ordered_json inner = at("/graphs/find/nodes/space/features");
  CHECK(inner["level"] == "find");
  CHECK(inner["node"] == "space");
  CHECK(inner["key"] == "features");
  CHECK(inner["line"].get<int>() > 15);
  CHECK(named(state["levels"][""]["nodes"], "layout")["known"] == false);
  CHECK(named(state["levels"][""]["nodes"], "exemplar")["shown"]["size"] == "128x64");
}

TEST_CASE("parameters without effect are hidden where a graph is used, and where they are only handed on") {
  const std::string text = R"t({
    "terrazzo": 1,
    "parameters": {
      "kind": {"type": "choice", "choices": ["plain", "fancy"], "default": "plain"},
      "depth": {"type": "number", "default": 1},
      "both": {"type": "number", "default": 2}
    },
    "nodes": {
      "a": {"type": "inner", "mode": "$kind", "strength": "$depth", "width": "$both"},
      "b": {"type": "inner", "mode": "fancy", "width": "$both"},
      "c": {"type": "outer", "how": "plain"}
    },
    "graphs": {
      "inner": {
        "parameters": {
          "mode": {"type": "choice", "choices": ["plain", "fancy"], "default": "plain"},
          "strength": {"type": "number", "default": 1, "visible_if": "=mode == 'fancy'"},
          "width": {"type": "number", "default": 1, "visible_if": "=mode == 'fancy'"}
        },
        "nodes": {"grey": {"type": "solid", "size": 8, "value": "=[strength / width]"}},
        "outputs": {"image": "@grey"}
      },
      "outer": {
        "parameters": {
          "how": {"type": "choice", "choices": ["plain", "fancy"], "default": "fancy"},
          "power": {"type": "number", "default": 1}
        },
        "nodes": {"part": {"type": "inner", "mode": "$how", "strength": "$power"}},
        "outputs": {"image": "@part"}
      }
    }
  })t";
  const ordered_json top = state_of(text)["levels"][""];
  CHECK(named(top["nodes"], "a")["hidden"] == ordered_json{"strength", "width"});
  CHECK_FALSE(named(top["nodes"], "b").contains("hidden"));
  CHECK(named(top["nodes"], "c")["hidden"] == ordered_json{"power"});
  CHECK(named(top["parameters"], "depth")["hidden"] == true);
  CHECK_FALSE(named(top["parameters"], "both").contains("hidden"));  // one of its uses has an effect
  const ordered_json fancy = state_of(replaced(text, R"("default": "plain"})", R"("default": "fancy"})"))["levels"][""];
  CHECK_FALSE(named(fancy["nodes"], "a").contains("hidden"));
  CHECK_FALSE(named(fancy["parameters"], "depth").contains("hidden"));
}

TEST_CASE("odd documents have a state") {
  for (const char* text :
       {"", "3", "[]", "{}", "{\"nodes\": 3}", "{\"terrazzo\": 1, \"nodes\": {\"a\": 3, \"b\": {\"type\": 4}}}",
        "{\"terrazzo\": 9, \"nodes\": {}}", "{\"terrazzo\": 1, \"nodes\": {}, \"nodes\": {}, \"graphs\": [1]}",
        "{\"terrazzo\": 1, \"graphs\": {\"a\": {\"nodes\": {\"x\": {\"type\": \"a\"}}}}, \"nodes\": {\"y\": {\"type\": "
        "\"a\"}}}",
        "{\"terrazzo\": 1, \"parameters\": 7, \"presets\": [], \"outputs\": {\"a\": 3}, \"inputs\": 2, \"nodes\": "
        "{\"a\": {\"type\": \"weight\", \"material\": \"@a\"}}}"}) {
    INFO(text);
    const ordered_json state = state_of(text);
    CHECK(state["problems"].size() >= 1);
    CHECK(state["text"] == text);
    CHECK_NOTHROW(state.dump());
  }
}

TEST_CASE("further problems are added once") {
  const Problem found{{3, 3}, "", "it is dull", "exemplar"};
  const ordered_json state = state_json(snapshot_of(wall), {.errors = {}, .warnings = {found, found}, .notes = {}});
  CHECK(state["problems"].size() == 1);
  CHECK(state["problems"][0]["severity"] == "warning");
}

TEST_CASE("types for the palette have the stock graphs among them") {
  const ordered_json& types = types_json();
  CHECK(types["types"].size() == node_types().size());
  CHECK(named(types["graphs"], "stock:material")["parameters"].size() > 5);
  CHECK(types["categories"][0] == "source");
  CHECK(preset_json(snapshot_of(wall), "large") == ordered_json{{"values", {{"scale", 8}, {"exemplar.seed", 3}}}});
  CHECK_THROWS_AS(preset_json(snapshot_of(wall), "small"), Error);
}

TEST_CASE("what changed since the last commit is told node by node") {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "a graph; $(touch x).json";
  const ordered_json none = {{"lines", ordered_json::array()}, {"nodes", ordered_json::object()}};
  CHECK(changed_since_commit(snapshot_of(wall, file)) == none);
  const auto git = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {"git", "-C", folder.path().string(), "-c", "user.name=a", "-c", "user.email=a@b.c"});
    return run_tool(words).ok();
  };
  if (!git({"init", "-q"})) return;  // no git here
  CHECK(changed_since_commit(snapshot_of(wall, file)) == none);
  std::ofstream(file) << wall;
  REQUIRE(git({"add", "-A"}));
  REQUIRE(git({"commit", "-q", "-m", "one"}));
  CHECK(changed_since_commit(snapshot_of(wall, file)) == none);
  const std::string text =
      replaced(replaced(wall, "\"mode\": \"off\"", "\"mode\": \"auto\""), "\"space\": {", "\"red\": {");
  const ordered_json changed = changed_since_commit(snapshot_of(text, file));
  CHECK(changed["lines"][0].get<std::string>().find("node \"space\"") != std::string::npos);
  CHECK(changed["lines"].back() == "node \"find\": mode \"off\" -> \"auto\"");
  CHECK(changed["nodes"] == ordered_json{{"find", "changed"}, {"find/red", "added"}, {"find/space", "removed"}});
  CHECK_FALSE(std::filesystem::exists(folder.path() / "x"));
}
