#include <doctest/doctest.h>

#include "core/base/error.h"
#include "graphs/document/load.h"
#include "graphs/edit/edit_document.h"
#include "graphs/text/edit.h"

using namespace terrazzo;

namespace {

const std::string without_presets = R"t({
  "terrazzo": 1,
  "parameters": {
    "seed": {"type": "int", "default": 1},  // any
    "size": {"type": "int", "default": 64}
  },
  "graphs": {"inner": {"nodes": {"grey": {"type": "solid"}}, "outputs": {"image": "@grey"}}},
  "nodes": {"wall": {"type": "pattern", "seed": "$seed", "size": "$size"}}
}
)t";

std::string after(const std::string& text, const std::string& edits) {
  return edited(text, "/nowhere/wall.json", json_in("[" + edits + "]")).text;
}

/// The seed that the preset gives the node.
int64_t seed_with(const std::string& text, const std::string& preset) {
  const LoadedGraph loaded = load_graph_text(text, "/nowhere/wall.json", {}, {.presets = {preset}});
  return std::get<int64_t>(loaded.graph.find("wall")->params.at("seed"));
}

}  // namespace

TEST_CASE("presets are made, changed, renamed and removed") {
  const std::string made =
      after(without_presets, R"t({"op": "preset", "name": "late", "set": {"help": "later", "set": {"seed": 7}}})t");
  CHECK(seed_with(made, "late") == 7);
  CHECK(made.find("\"seed\": {\"type\": \"int\", \"default\": 1},  // any") != made.npos);
  const std::string other = after(made, R"t({"op": "preset", "name": "early", "set": {"set": {"seed": 2}}})t");
  CHECK(seed_with(other, "early") == 2);
  CHECK(seed_with(other, "late") == 7);
  // New values, and no help any more.
  const std::string changed =
      after(other, R"t({"op": "preset", "name": "late", "set": {"help": null, "set": {"seed": 9}}})t");
  CHECK(seed_with(changed, "late") == 9);
  CHECK(changed.find("later") == changed.npos);
  const std::string renamed = after(changed, R"t({"op": "preset", "name": "late", "rename": "last one"})t");
  CHECK(seed_with(renamed, "last one") == 9);
  CHECK_THROWS_AS(seed_with(renamed, "late"), Error);
  // They follow their parameters.
  const std::string followed = after(renamed, R"t({"op": "parameter", "name": "seed", "rename": "luck"})t");
  CHECK(seed_with(followed, "last one") == 9);
  const std::string removed = after(after(changed, R"t({"op": "preset", "name": "late", "set": null})t"),
                                    R"t({"op": "preset", "name": "early", "set": null})t");
  CHECK(removed == without_presets);
}

TEST_CASE("a parameter that is removed leaves no values behind") {
  const std::string before =
      after(without_presets, R"t({"op": "preset", "name": "late", "set": {"set": {"seed": 7, "size": 8}}},
                                 {"op": "parameter", "level": "inner", "name": "tone", "set": {"type": "number"}},
                                 {"op": "add", "type": "inner", "name": "use", "values": {"tone": 0.5}},
                                 {"op": "preset", "name": "dark", "set": {"set": {"use.tone": 0.1, "size": 9}}})t");
  const EditedText one =
      edited(before, "/nowhere/wall.json", json_in(R"t([{"op": "parameter", "name": "seed", "set": null}])t"));
  CHECK(one.taken == std::vector<std::string>{R"(the preset "late" no longer sets "seed")"});
  CHECK(one.text.find("\"seed\": 7") == one.text.npos);
  CHECK(one.text.find("\"size\": 8") != one.text.npos);
  const EditedText two = edited(before, "/nowhere/wall.json",
                                json_in(R"t([{"op": "parameter", "level": "inner", "name": "tone", "set": null}])t"));
  CHECK(two.taken ==
        std::vector<std::string>{R"("use" no longer sets "tone")", R"(the preset "dark" no longer sets "use.tone")"});
  CHECK(two.text.find("tone") == two.text.npos);
}

TEST_CASE("presets follow the parameters of graphs within graphs") {
  const std::string before = R"t({
  "terrazzo": 1,
  "graphs": {
    "inner": {"parameters": {"tone": {"type": "number", "default": 0.5}},
              "nodes": {"grey": {"type": "solid", "value": "=[tone]"}}, "outputs": {"image": "@grey"}},
    "outer": {"nodes": {"b": {"type": "inner", "tone": 0.2}, "tone": {"type": "solid"}}, "outputs": {"image": "@b"}}
  },
  "nodes": {"a": {"type": "outer"}, "c": {"type": "inner"}, "wall": {"type": "pattern"}},
  "presets": {"dark": {"set": {"a/b.tone": 0.1, "c.tone": 0.3, "a/tone.value": [0.4], "wall.tone": 1, "seed": 2}}}
}
)t";
  const auto targets = [](const std::string& text) {
    std::vector<std::string> out;
    const JsonValue document = json_in(text);
    for (const JsonMember& m : document.find("presets")->find("dark")->find("set")->members) out.push_back(m.name);
    return out;
  };
  const std::string renamed =
      after(before, R"t({"op": "parameter", "level": "inner", "name": "tone", "rename": "hue"})t");
  CHECK(targets(renamed) == std::vector<std::string>{"a/b.hue", "c.hue", "a/tone.value", "wall.tone", "seed"});
  CHECK(renamed.find("\"b\": {\"type\": \"inner\", \"hue\": 0.2}") != renamed.npos);
  const EditedText removed =
      edited(before, "/nowhere/wall.json",
             json_in(R"t([{"op": "parameter", "level": "inner", "name": "tone", "set": null}])t"));
  CHECK(targets(removed.text) == std::vector<std::string>{"a/tone.value", "wall.tone", "seed"});
  CHECK(removed.taken == std::vector<std::string>{R"("b" in "outer" no longer sets "tone")",
                                                  R"(the preset "dark" no longer sets "a/b.tone")",
                                                  R"(the preset "dark" no longer sets "c.tone")"});
}

TEST_CASE("presets that cannot be are refused") {
  const std::string text = after(without_presets, R"t({"op": "preset", "name": "a", "set": {"set": {"seed": 7}}},
    {"op": "preset", "name": "b", "set": {"set": {"seed": 8}}})t");
  for (const char* edit :
       {R"t({"op": "preset", "name": "a", "rename": "b"})t", R"t({"op": "preset", "name": "c", "rename": "d"})t",
        R"t({"op": "preset", "name": "c", "set": null})t", R"t({"op": "preset", "name": "", "set": {}})t",
        R"t({"op": "preset", "level": "inner", "name": "c", "set": {"set": {"seed": 7}}})t"}) {
    INFO(edit);
    CHECK_THROWS_AS(after(text, edit), Error);
  }
}
