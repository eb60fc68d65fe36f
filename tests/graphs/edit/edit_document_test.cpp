#include "graphs/edit/edit_document.h"

#include <doctest/doctest.h>

#include "core/base/error.h"
#include "graphs/document/load.h"
#include "graphs/text/edit.h"
#include "graphs/text/stock_graphs.h"

using namespace terrazzo;

namespace {

const std::string wall = R"t({
  "terrazzo": 1,   // the format
  "summary": "a wall",

  "parameters": {
    "size": {"type": "size", "default": [64, 64]},
    "seed": {"type": "int",  "default": 1, "help": "another seed"}
  },
  "presets": {
    "worn": {"help": "worn", "set": {"seed": 3, "weighted.weights": {"height": 2}}}
  },
  "nodes": {
    // where it comes from

    "exemplar": {"type": "pattern", "kind": "bricks", "seed": "$seed"},  // bricks
    "weighted": {"type": "weight",  "material": "@exemplar"},


    "lattice":  {"type": "regularity", "features": "@weighted", "mode": "auto"},
    "space":    {"type": "pca", "features": "@lattice"},
    "index":    {"type": "index", "appearance": "@space"},
    /* here */
    "layout":   {"type": "synthesize", "index": "@index",
                 "size": "=round(@exemplar.size * 2)", "seed": "$seed", },
    "result":   {"type": "resolve_uv", "uv": "@layout", "material": "@exemplar"}
  },
  "outputs": {"result": "@result", "uv": {"from": "@layout", "help": "where from"}}
}
)t";

std::string document() {
  std::string out = wall;
  const std::string mark = "    /* here */\n";
  return out.replace(out.find(mark), mark.size(), "    // the expensive one\n");
}

EditedText edit(const std::string& text, const std::string& edits) {
  EditedText out = edited(text, "/nowhere/wall.json", json_in("[" + edits + "]"));
  REQUIRE(parse_json(out.text).value);
  return out;
}

std::string refusal(const std::string& text, const std::string& edits) {
  try {
    edit(text, edits);
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

/// The lines of `after` that differ from `before`, with - and +, in the order of the text.
std::string line_changes(const std::string& before, const std::string& after) {
  const auto lines = [](const std::string& text) {
    std::vector<std::string> out;
    for (size_t at = 0; at < text.size();) {
      const size_t end = std::min(text.find('\n', at), text.size());
      out.push_back(text.substr(at, end - at));
      at = end + 1;
    }
    return out;
  };
  const std::vector<std::string> a = lines(before), b = lines(after);
  std::vector<std::vector<size_t>> common(a.size() + 1, std::vector<size_t>(b.size() + 1));
  for (size_t i = a.size(); i-- > 0;)
    for (size_t k = b.size(); k-- > 0;)
      common[i][k] = a[i] == b[k] ? common[i + 1][k + 1] + 1 : std::max(common[i + 1][k], common[i][k + 1]);
  std::string out;
  for (size_t i = 0, k = 0; i < a.size() || k < b.size();) {
    if (i < a.size() && k < b.size() && a[i] == b[k]) {
      i++, k++;
    } else if (i < a.size() && (k == b.size() || common[i + 1][k] >= common[i][k + 1])) {
      out += "-" + a[i++] + "\n";
    } else {
      out += "+" + b[k++] + "\n";
    }
  }
  return out;
}

std::string diff_of(const std::string& edits) {
  return line_changes(document(), edit(document(), edits).text);
}

}  // namespace

TEST_CASE("an edit changes its lines and no others") {
  CHECK(diff_of(R"t({"op": "set", "node": "lattice", "key": "mode", "value": "off"})t") ==
        R"t(-    "lattice":  {"type": "regularity", "features": "@weighted", "mode": "auto"},
+    "lattice":  {"type": "regularity", "features": "@weighted", "mode": "off"},
)t");
  CHECK(diff_of(R"t({"op": "set", "node": "weighted", "key": "mute", "value": true})t") ==
        R"t(-    "weighted": {"type": "weight",  "material": "@exemplar"},
+    "weighted": {"type": "weight",  "material": "@exemplar", "mute": true},
)t");
  CHECK(diff_of(R"t({"op": "unset", "node": "layout", "key": "seed"})t") ==
        R"t(-                 "size": "=round(@exemplar.size * 2)", "seed": "$seed", },
+                 "size": "=round(@exemplar.size * 2)", },
)t");
  CHECK(diff_of(R"t({"op": "value", "name": "seed", "value": 7})t") ==
        R"t(-    "seed": {"type": "int",  "default": 1, "help": "another seed"}
+    "seed": {"type": "int",  "default": 7, "help": "another seed"}
)t");
  CHECK(diff_of(R"t({"op": "set", "node": "exemplar", "key": "seed", "value": "$seed"})t") == "");
  CHECK(diff_of(R"t({"op": "set", "key": "summary", "value": "two walls"})t") ==
        "-  \"summary\": \"a wall\",\n+  \"summary\": \"two walls\",\n");
}

TEST_CASE("a node is added behind another and connected") {
  const EditedText added = edit(document(), R"t({"op": "add", "type": "crop", "behind": {"node": "exemplar"}})t");
  CHECK(added.added == std::vector<std::string>{"crop"});
  CHECK(line_changes(document(), added.text) == "+    \"crop\": {\"type\": \"crop\", \"material\": \"@exemplar\"},\n");
  const EditedText second = edit(added.text, R"t({"op": "add", "type": "crop", "values": {"x": 3}})t");
  CHECK(second.added == std::vector<std::string>{"crop_2"});
  CHECK(line_changes(added.text, second.text) ==
        R"t(-    "result":   {"type": "resolve_uv", "uv": "@layout", "material": "@exemplar"}
+    "result":   {"type": "resolve_uv", "uv": "@layout", "material": "@exemplar"},
+    "crop_2": {"type": "crop", "x": 3}
)t");
  CHECK(refusal(document(), R"t({"op": "add", "type": "crops"})t") ==
        R"t(there is no node type "crops" (did you mean "crop"?))t");
  CHECK(refusal(document(), R"t({"op": "add", "type": "crop", "name": "layout"})t") ==
        R"t(there is a node "layout" already)t");
}

TEST_CASE("a graph begins empty") {
  EditedText out = edit("{\n  \"terrazzo\": 1,\n  \"nodes\": {}\n}\n", R"t({"op": "add", "type": "pattern"},
    {"op": "add", "type": "weight", "behind": {"node": "pattern"}}, {"op": "parameter", "name": "seed", "set":
    {"type": "int", "default": 1}})t");
  CHECK(out.text == R"t({
  "terrazzo": 1,
  "parameters": {
    "seed": {"type": "int", "default": 1}
  },
  "nodes": {
    "pattern": {"type": "pattern"},
    "weight": {"type": "weight", "material": "@pattern"}
  }
}
)t");
}

TEST_CASE("removing a node takes what reads it along, and says so") {
  const EditedText out = edit(document(), R"t({"op": "remove", "nodes": ["layout", "weighted"]})t");
  CHECK(line_changes(document(), out.text) ==
        R"t(-    "worn": {"help": "worn", "set": {"seed": 3, "weighted.weights": {"height": 2}}}
+    "worn": {"help": "worn", "set": {"seed": 3}}
-    "weighted": {"type": "weight",  "material": "@exemplar"},
-    "lattice":  {"type": "regularity", "features": "@weighted", "mode": "auto"},
+    "lattice":  {"type": "regularity", "mode": "auto"},
-    // the expensive one
-    "layout":   {"type": "synthesize", "index": "@index",
-                 "size": "=round(@exemplar.size * 2)", "seed": "$seed", },
-    "result":   {"type": "resolve_uv", "uv": "@layout", "material": "@exemplar"}
+    "result":   {"type": "resolve_uv", "material": "@exemplar"}
-  "outputs": {"result": "@result", "uv": {"from": "@layout", "help": "where from"}}
+  "outputs": {"result": "@result"}
)t");
  CHECK(out.taken == std::vector<std::string>{R"t(the preset "worn" no longer sets "weighted.weights")t",
                                              R"t(a wire into the port "features" of "lattice")t",
                                              R"t(a wire into the port "uv" of "result")t",
                                              R"t(the output "uv" of the graph)t"});
  // A comment above a blank line is about more than the first node.
  CHECK(diff_of(R"t({"op": "remove", "nodes": ["exemplar"]})t").find("where it comes from") == std::string::npos);
}

TEST_CASE("a renamed node keeps its wires, expressions, outputs and presets") {
  const EditedText out = edit(document(), R"t({"op": "rename", "node": "exemplar", "to": "bricks"},
                                            {"op": "rename", "node": "weighted", "to": "w-1"})t");
  CHECK(line_changes(document(), out.text) ==
        R"t(-    "worn": {"help": "worn", "set": {"seed": 3, "weighted.weights": {"height": 2}}}
+    "worn": {"help": "worn", "set": {"seed": 3, "w-1.weights": {"height": 2}}}
-    "exemplar": {"type": "pattern", "kind": "bricks", "seed": "$seed"},  // bricks
-    "weighted": {"type": "weight",  "material": "@exemplar"},
+    "bricks": {"type": "pattern", "kind": "bricks", "seed": "$seed"},  // bricks
+    "w-1": {"type": "weight",  "material": "@bricks"},
-    "lattice":  {"type": "regularity", "features": "@weighted", "mode": "auto"},
+    "lattice":  {"type": "regularity", "features": "@w-1", "mode": "auto"},
-                 "size": "=round(@exemplar.size * 2)", "seed": "$seed", },
-    "result":   {"type": "resolve_uv", "uv": "@layout", "material": "@exemplar"}
+                 "size": "=round(@bricks.size * 2)", "seed": "$seed", },
+    "result":   {"type": "resolve_uv", "uv": "@layout", "material": "@bricks"}
)t");
  CHECK(refusal(document(), R"t({"op": "rename", "node": "space", "to": "index"})t") ==
        R"t(there is a node "index" already)t");
}

TEST_CASE("wires that do not fit are refused with both ends and what would help") {
  CHECK(refusal(document(), R"t({"op": "connect", "from": "exemplar", "to": "lattice", "port": "features"})t") ==
        R"t("@exemplar" does not go into the port "features" of "lattice": expected a wire of type features, found )t"
        R"t("@exemplar", which is of type material (would fit: "@weighted"))t");
  CHECK(refusal(document(), R"t({"op": "connect", "from": "layout", "to": "exemplar", "port": "material"})t") ==
        R"t(pattern has no port "material"; it takes no wires)t");
  CHECK(refusal(document(), R"t({"op": "connect", "from": "index", "to": "weighted", "port": "mat"})t") ==
        R"t(weight has no port "mat" (did you mean "material"?))t");
  CHECK(refusal(document(), R"t({"op": "connect", "from": "exemplars", "to": "weighted", "port": "material"})t") ==
        R"t("@exemplars" does not go into the port "material" of "weighted": "@exemplars" leads to no node )t"
        R"t((did you mean "exemplar"?))t");
  CHECK(
      refusal(document(), R"t({"op": "connect", "from": "result", "to": "weighted", "port": "material"})t") ==
      R"t("@result" does not go into the port "material" of "weighted": the wires would form a cycle: )t"
      R"t(weighted -> lattice -> space -> index -> layout -> result -> weighted; take one of these wires away first)t");
}

TEST_CASE("the wires of a list port are appended, put in and taken away") {
  const std::string before =
      "{\n  \"terrazzo\": 1,\n  \"nodes\": {\n    \"a\": {\"type\": \"load_map\"},\n    \"b\": "
      "{\"type\": \"load_map\"},\n    \"s\": {\"type\": \"contact_sheet\"}\n  }\n}\n";
  std::string port;
  for (const Port& p : find_node_type("contact_sheet")->inputs)
    if (p.list) port = p.name;
  const std::string end = R"t(, "to": "s", "port": ")t" + port + "\"}";
  EditedText out = edit(before, R"t({"op": "connect", "from": "a")t" + end + R"t(, {"op": "connect", "from": "b")t" +
                                    end + R"t(, {"op": "connect", "from": "b", "index": 0)t" + end);
  CHECK(out.text.find("[\"@b\", \"@a\", \"@b\"]") != std::string::npos);
  out = edit(out.text, R"t({"op": "disconnect", "node": "s", "index": 1, "port": ")t" + port + "\"}");
  CHECK(out.text.find("[\"@b\", \"@b\"]") != std::string::npos);
  out = edit(out.text, R"t({"op": "remove", "nodes": ["b"]})t");
  CHECK(out.text.find(port) == std::string::npos);
}

TEST_CASE("a node is put into a wire") {
  const std::string before = edit(document(), R"t({"op": "add", "type": "crop"})t").text;
  const EditedText out =
      edit(before, R"t({"op": "insert", "node": "crop", "wire": {"node": "weighted", "port": "material"}})t");
  CHECK(line_changes(before, out.text) ==
        R"t(-    "weighted": {"type": "weight",  "material": "@exemplar"},
+    "weighted": {"type": "weight",  "material": "@crop"},
-    "crop": {"type": "crop"}
+    "crop": {"type": "crop", "material": "@exemplar"}
)t");
  CHECK(
      refusal(before, R"t({"op": "insert", "node": "crop", "wire": {"node": "space", "port": "features"}})t") ==
      R"t("crop" does not fit between "lattice" and "space": it would have to take a wire of type features and make )t"
      R"t(one of type features)t");
}

TEST_CASE("nodes go through the clipboard with their wires, comments and graphs") {
  const std::string text = copied_nodes(document(), "", {"layout", "index"});
  CHECK(text == R"t({
  "nodes": {
    "index": {"type": "index", "appearance": "@space"},
    // the expensive one
    "layout": {"type": "synthesize", "index": "@index", "size": "=round(@exemplar.size * 2)", "seed": "$seed"}
  }
}
)t");
  const JsonValue clip = JsonValue::of(text);
  const std::string op = R"t({"op": "paste", "text": )t" + in_quotes(text) + "}";
  const EditedText out = edit(document(), op);
  CHECK(out.added == std::vector<std::string>{"index_2", "layout_2"});
  CHECK(line_changes(document(), out.text) ==
        R"t(-    "result":   {"type": "resolve_uv", "uv": "@layout", "material": "@exemplar"}
+    "result":   {"type": "resolve_uv", "uv": "@layout", "material": "@exemplar"},
+    "index_2": {"type": "index", "appearance": "@space"},
+    // the expensive one
+    "layout_2": {"type": "synthesize", "index": "@index_2", "size": "=round(@exemplar.size * 2)", "seed": "$seed"}
)t");
  const EditedText other = edit("{\"terrazzo\": 1, \"nodes\": {}}", op);
  CHECK(
      other.text ==
      R"t({"terrazzo": 1, "nodes": {"index": {"type": "index"}, "layout": {"type": "synthesize", "index": "@index", )t"
      R"t("size": "=round(@exemplar.size * 2)", "seed": "$seed"}}})t");
  CHECK(refusal(document(), R"t({"op": "paste", "text": "hello"})t").starts_with("the clipboard holds no nodes: "));
}

TEST_CASE("a group leaves the rest as it is, and ungrouping brings back the nodes") {
  const EditedText out =
      edit(document(), R"t({"op": "group", "nodes": ["lattice", "space", "index"], "name": "find"})t");
  const std::string changes = line_changes(document(), out.text);
  CHECK(changes.find("-    \"weighted\"") == std::string::npos);
  CHECK(changes.find("    \"find\": {\"type\": \"find\", \"weighted\": \"@weighted\"},") != std::string::npos);
  const LoadedGraph grouped = load_graph_text(out.text, "/nowhere/wall.json");
  CHECK(grouped.graph.find("find/lattice"));
  // In the level of the graph the same works again.
  const EditedText deeper =
      edit(out.text, R"t({"op": "group", "level": "find", "nodes": ["space", "index"], "name": "inner"})t");
  CHECK(load_graph_text(deeper.text, "/nowhere/wall.json").graph.find("find/inner/space"));
  const EditedText back = edit(deeper.text, R"t({"op": "ungroup", "level": "find", "node": "inner"})t");
  CHECK(same_value(json_in(back.text), json_in(out.text)));
  const EditedText all = edit(back.text, R"t({"op": "ungroup", "node": "find"})t");
  CHECK(same_value(json_in(all.text), json_in(document())));
  CHECK(all.added == std::vector<std::string>{"lattice", "space", "index"});
}

TEST_CASE("a graph in the document is edited in its place") {
  std::string before =
      edit(document(), R"t({"op": "group", "nodes": ["lattice", "space", "index"], "name": "find"})t").text;
  before = edit(before, R"t({"op": "set", "node": "weighted", "key": "comment", "value": "x"})t").text;
  const EditedText out = edit(before, R"t({"op": "rename", "level": "find", "node": "space", "to": "reduced"},
    {"op": "set", "level": "find", "node": "lattice", "key": "mode", "value": "off"})t");
  CHECK(line_changes(before, out.text) ==
        R"t(-        "lattice": {"type": "regularity", "features": "@weighted", "mode": "auto"},
-        "space": {"type": "pca", "features": "@lattice"},
-        "index": {"type": "index", "appearance": "@space"}
+        "lattice": {"type": "regularity", "features": "@weighted", "mode": "off"},
+        "reduced": {"type": "pca", "features": "@lattice"},
+        "index": {"type": "index", "appearance": "@reduced"}
)t");
  CHECK(refusal(before, R"t({"op": "add", "level": "find", "type": "find"})t") ==
        R"t(the graph "find" cannot be part of itself)t");
  CHECK(refusal(before, R"t({"op": "add", "level": "lost", "type": "crop"})t") ==
        R"t(the document has no graph "lost")t");
}

TEST_CASE("a parameter is declared, changed, renamed and removed") {
  EditedText out = edit(document(), R"t({"op": "parameter", "name": "seed", "set": {"max": 9}, "rename": "luck"})t");
  CHECK(line_changes(document(), out.text) ==
        R"t(-    "seed": {"type": "int",  "default": 1, "help": "another seed"}
+    "luck": {"type": "int",  "default": 1, "help": "another seed", "max": 9}
-    "worn": {"help": "worn", "set": {"seed": 3, "weighted.weights": {"height": 2}}}
+    "worn": {"help": "worn", "set": {"luck": 3, "weighted.weights": {"height": 2}}}
-    "exemplar": {"type": "pattern", "kind": "bricks", "seed": "$seed"},  // bricks
+    "exemplar": {"type": "pattern", "kind": "bricks", "seed": "$luck"},  // bricks
-                 "size": "=round(@exemplar.size * 2)", "seed": "$seed", },
+                 "size": "=round(@exemplar.size * 2)", "seed": "$luck", },
)t");
  out = edit(out.text, R"t({"op": "parameter", "name": "size", "set": null})t");
  CHECK(out.text.find("\"size\": {") == std::string::npos);
  CHECK(refusal(document(), R"t({"op": "parameter", "name": "sizes", "set": null})t") ==
        R"t(the graph has no parameter "sizes")t");
}
