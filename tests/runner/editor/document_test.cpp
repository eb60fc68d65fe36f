#include "runner/editor/document.h"

#include <random>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "graphs/text/json.h"
#include "graphs/text/stock_graphs.h"
#include "runner/editor/state.h"
#include "tests/run_node.h"
#include "tests/runner/editor/small_document.h"
#include "tests/texts.h"

using namespace terrazzo;
using nlohmann::ordered_json;
using namespace terrazzo::test;

namespace {

namespace fs = std::filesystem;

std::string refusal_of(EditedDocument& document, const ordered_json& edits) {
  try {
    document.edit(edits);
  } catch (const EditRefused& e) {
    return e.what();
  }
  return "";
}

}  // namespace

TEST_CASE("an edited document is saved at once, and undone to the byte") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "g.json";
  write_text(file, small);
  EditedDocument document(file);
  CHECK(document.snapshot().saved);
  CHECK_FALSE(document.snapshot().undo);
  const EditAnswer answer = document.edit(request(add_crop));
  CHECK(answer.names == std::vector<std::string>{"crop"});
  const std::string once = read_text(file);
  CHECK(once == document.snapshot().text);
  CHECK(once.find("\"crop\"") != std::string::npos);
  CHECK(document.snapshot().undo == "add \"crop\"");
  document.edit(request(R"({"op": "remove", "nodes": ["a"]})"));
  const std::string twice = read_text(file);
  document.undo();
  CHECK(read_text(file) == once);
  document.undo();
  CHECK(read_text(file) == small);
  CHECK(document.undo().revision == document.revision());
  document.redo();
  document.redo();
  CHECK(read_text(file) == twice);
  CHECK_FALSE(document.snapshot().redo);
}

TEST_CASE("edits of one request are applied together or not at all") {
  const TemporaryFolder folder;
  write_text(folder.path() / "g.json", small);
  EditedDocument document(folder.path() / "g.json");
  const std::string both =
      std::string(add_crop) + R"(, {"op": "connect", "from": "b", "to": "crop", "port": "material"})";
  CHECK(refusal_of(document, request(both)).find("expected a wire of type material") != std::string::npos);
  CHECK(document.snapshot().text == small);
  CHECK(document.revision() == 1);
  for (const char* bad : {"{}", "[]", "3", "{\"edits\": []}", "{\"edits\": [{}]}", "{\"edits\": [3]}",
                          "{\"edits\": [{\"op\": \"move\"}]}", "{\"edits\": [{\"op\": \"move\", \"positions\": 3}]}",
                          "{\"edits\": [{\"op\": \"pin\", \"nodes\": [3]}]}", "{\"edits\": [{\"op\": \"frame\"}]}",
                          "{\"edits\": [{\"op\": \"move\", \"positions\": {\"a\": [1e300, 2]}}]}",
                          "{\"edits\": [{\"op\": \"set\", \"node\": \"a\"}]}"})
    CHECK_MESSAGE(!refusal_of(document, ordered_json::parse(bad)).empty(), bad);
  CHECK(document.snapshot().text == small);
}

TEST_CASE("dragging a slider is one step") {
  const TemporaryFolder folder;
  write_text(folder.path() / "g.json", small);
  EditedDocument document(folder.path() / "g.json");
  for (const char* value : {"1", "2", "3"})
    document.edit(request(std::string(R"({"op": "set", "node": "a", "key": "seed", "value": )") + value + "}", "seed"));
  CHECK(document.snapshot().text.find("\"seed\": 3") != std::string::npos);
  document.edit(request(R"({"op": "set", "node": "a", "key": "kind", "value": "bricks"})", "kind"));
  document.undo();
  CHECK(document.snapshot().text.find("\"seed\": 3") != std::string::npos);
  document.undo();
  CHECK(document.snapshot().text == small);
}

TEST_CASE("a text that is not JSON is edited as text") {
  const TemporaryFolder folder;
  write_text(folder.path() / "g.json", "{\n  \"terrazzo\": 1,\n  nodes\n}");
  EditedDocument document(folder.path() / "g.json");
  ordered_json state = state_json(document.snapshot());
  CHECK(state["broken"]["line"] == 3);
  CHECK(state["broken"]["column"] == 3);
  CHECK(refusal_of(document, request(add_crop)).starts_with("the document is not JSON: "));
  CHECK_FALSE(refusal_of(document, {{"base", 7}, {"edits", {{{"op", "text"}, {"text", small}}}}}).empty());
  document.edit({{"base", 1}, {"edits", {{{"op", "text"}, {"text", small}}}}});
  CHECK(read_text(folder.path() / "g.json") == small);
  state = state_json(document.snapshot());
  CHECK_FALSE(state.contains("broken"));
  CHECK(state["levels"][""]["nodes"].size() == 2);
  document.undo();
  CHECK(state_json(document.snapshot()).contains("broken"));
  // What can be read is not replaced by a slip, unless that is meant.
  document.redo();
  ordered_json slip = {{"op", "text"}, {"text", "{ oops"}, {"was", small}};
  CHECK(refusal_of(document, {{"edits", {slip}}}).starts_with("line 1, column 3: "));
  slip["broken"] = true;
  document.edit({{"edits", {slip}}});
  CHECK(read_text(folder.path() / "g.json") == "{ oops");
}

TEST_CASE("a text typed while the document changes is merged, or refused where both changed the same") {
  const TemporaryFolder folder;
  write_text(folder.path() / "g.json", small);
  EditedDocument document(folder.path() / "g.json");
  document.edit(request(R"({"op": "set", "node": "b", "key": "comment", "value": "theirs"})"));
  std::string typed = small;
  typed.replace(typed.find("pattern"), 7, "load_map");
  const auto apply = [&](const std::string& text) {
    return ordered_json{{"base", 1}, {"edits", {{{"op", "text"}, {"text", text}, {"was", small}}}}};
  };
  document.edit(apply(typed));
  const std::string merged = document.snapshot().text;
  CHECK(merged.find("load_map") != std::string::npos);
  CHECK(merged.find("theirs") != std::string::npos);
  std::string other = small;
  other.replace(other.find("pattern"), 7, "load_material");
  CHECK(refusal_of(document, apply(other)).find("/nodes/a/type") != std::string::npos);
  CHECK(document.snapshot().text == merged);
}

TEST_CASE("a graph that does not exist begins empty and is created by the first edit") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "new.json";
  EditedDocument document(file);
  document.look_at_disk();
  CHECK_FALSE(fs::exists(file));
  document.edit(request(R"({"op": "add", "type": "pattern"})"));
  CHECK(read_text(file) == "{\n  \"terrazzo\": 1,\n  \"nodes\": {\n    \"pattern\": {\"type\": \"pattern\"}\n  }\n}\n");
}

TEST_CASE("positions are written beside the graph once a node is moved") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "g.json", sidecar = folder.path() / "g.layout.json";
  write_text(file, small);
  EditedDocument document(file);
  const ordered_json before = state_json(document.snapshot())["levels"][""]["nodes"];
  CHECK(before[1]["x"] > before[0]["x"]);
  CHECK_FALSE(fs::exists(sidecar));
  document.edit(request(R"({"op": "move", "positions": {"a": [-7, 300.4]}})"));
  CHECK(document.snapshot().undo == "move \"a\"");
  CHECK(read_text(file) == small);
  ordered_json after = state_json(document.snapshot())["levels"][""]["nodes"];
  CHECK(after[0]["x"] == -7);
  CHECK(after[0]["y"] == 300);
  CHECK(after[1]["x"] == before[1]["x"]);
  document.edit(request(R"({"op": "rename", "node": "a", "to": "z"}, {"op": "pin", "nodes": ["z"], "on": true},
                            {"op": "frame", "set": {"title": "all", "x": 1, "y": 2, "width": 3, "height": 4}})"));
  CHECK(ordered_json::parse(read_text(sidecar)) == ordered_json::parse(R"({"levels": {"": {
    "nodes": {"b": [)" + before[1]["x"].dump() + ", " + before[1]["y"].dump() +
                                                                       R"(], "z": {"at": [-7, 300], "pinned": true}},
    "frames": {"f1": {"title": "all", "at": [1, 2], "size": [3, 4]}}}}})"));
  document.edit(request(R"({"op": "remove", "nodes": ["z"]})"));
  CHECK(read_text(sidecar).find("\"z\"") == std::string::npos);
  for (int i = 0; i < 3; i++) document.undo();
  CHECK_FALSE(fs::exists(sidecar));
  CHECK(read_text(file) == small);
}

TEST_CASE("what else is in a sidecar is kept, and a broken one only replaced by a move") {
  const TemporaryFolder folder;
  const fs::path sidecar = folder.path() / "g.layout.json";
  write_text(folder.path() / "g.json", small);
  const std::string text =
      "{\n  // mine\n  \"zoom\": 3,\n  \"levels\": {\"\": {\"nodes\": {\"a\": [1, 2], \"gone\": "
      "[5, 6], \"b\": {\"at\": [3, 4], \"note\": 1}}}, \"other\": {\"x\": 1}}\n}\n";
  write_text(sidecar, text);
  EditedDocument document(folder.path() / "g.json");
  document.edit(request(R"({"op": "move", "positions": {"b": [9, 9]}})"));
  CHECK(read_text(sidecar).find("\"zoom\": 3") != std::string::npos);
  CHECK(read_text(sidecar).find("// mine") != std::string::npos);
  CHECK(read_text(sidecar).find("\"note\": 1") != std::string::npos);
  CHECK(read_text(sidecar).find("\"gone\": [5, 6]") != std::string::npos);
  write_text(sidecar, "{ broken");
  CHECK_FALSE(document.look_at_disk());  // it may be half written
  CHECK(document.look_at_disk());
  const ordered_json state = state_json(document.snapshot());
  CHECK(state["problems"].back()["severity"] == "note");
  CHECK(read_text(sidecar) == "{ broken");
  document.edit(request(add_crop));
  CHECK(read_text(sidecar) == "{ broken");
  document.edit(request(R"({"op": "move", "positions": {"b": [9, 9]}})"));
  CHECK(read_text(sidecar).find("\"crop\": [") != std::string::npos);
}

TEST_CASE("any edits parse, are undone to the byte and done again") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "g.json";
  std::mt19937 random(7);
  const auto pick = [&](const std::vector<std::string>& all) { return all[random() % all.size()]; };
  for (const StockGraph& stock : stock_graphs()) {
    std::string text(stock.text);
    if (random() % 2 == 0) {  // with other line ends and a mark
      std::string other = "\xef\xbb\xbf";
      for (const char c : text) other += c == '\n' ? "\r\n" : std::string(1, c);
      text = other;
    }
    write_text(file, text);
    EditedDocument document(file);
    std::vector<std::string> texts = {text};
    size_t applied = 0;
    for (int i = 0; i < 60; i++) {
      const JsonValue json = *parse_json(document.snapshot().text).value;
      std::string level;
      if (const JsonValue* graphs = json.find("graphs"); graphs && random() % 3 == 0)
        level = graphs->members[random() % graphs->members.size()].name;
      const JsonValue* graph = level.empty() ? &json : json.find("graphs")->find(level);
      std::vector<std::string> nodes = {"lost"}, keys = {"seed", "comment", "material"};
      for (const JsonMember& m : graph->find("nodes")->members) {
        nodes.push_back(m.name);
        for (const JsonMember& k : m.value.members)
          if (k.name != "type") keys.push_back(k.name);
      }
      ordered_json e = {
          {"op", pick({"add", "remove", "connect", "disconnect", "set", "unset", "rename", "group", "ungroup", "insert",
                       "paste", "parameter", "value", "move"})},
          {"level", level},
          {"node", pick(nodes)},
          {"key", pick(keys)},
          {"value", ordered_json::parse(pick({"1", "2.50", "\"$seed\"", "[1, 2]", "{\"height\": 2, \"x\": [3]}",
                                              "\"=@exemplar.size\"", "null", "\"// no \\\" comment\""}))},
          {"type", pick({"crop", "weight", "pattern", "stock:material", "nothing"})},
          {"from", pick(nodes)},
          {"to", random() % 2 == 0 ? pick(nodes) : "new" + std::to_string(i)},
          {"port", pick(keys)},
          {"nodes", {pick(nodes), pick(nodes)}},
          {"name", "name" + std::to_string(i)},
          {"wire", {{"node", pick(nodes)}, {"port", pick(keys)}}},
          {"set", {{"type", "int"}, {"default", i}}}};
      if (e["op"] == "set" && e["key"] == "type") continue;
      if (e["op"] == "move") e["positions"] = {{pick(nodes), {i, i}}};
      if (e["op"] == "paste") e["text"] = "{\"pasted\": {\"type\": \"crop\", \"material\": \"@" + pick(nodes) + "\"}}";
      try {
        document.edit({{"base", 0}, {"edits", {e}}});
      } catch (const EditRefused& refused) {
        CHECK(std::string(refused.what()) != "");
        continue;
      }
      applied++;
      const DocumentSnapshot now = document.snapshot();
      const ParsedJson parsed = parse_json(now.text);
      INFO(e.dump());
      REQUIRE(parsed.value);
      REQUIRE(parsed.problems.empty());
      REQUIRE(read_text(file) == now.text);
      texts.push_back(now.text);
      if (applied % 8 == 0) REQUIRE_FALSE(state_json(now).contains("broken"));
    }
    CHECK(applied > 10);
    const std::string last = document.snapshot().text, layout = document.snapshot().layout.text;
    while (document.snapshot().undo) {
      document.undo();
      const std::string now = document.snapshot().text;
      REQUIRE(std::ranges::find(texts, now) != texts.end());
    }
    CHECK(read_text(file) == text);
    while (document.snapshot().redo) document.redo();
    CHECK(read_text(file) == last);
    CHECK(document.snapshot().layout.text == layout);
    fs::remove(layout_path(file));
  }
}
