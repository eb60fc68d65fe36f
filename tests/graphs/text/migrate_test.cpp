#include "graphs/text/migrate.h"

#include <doctest/doctest.h>

#include "graphs/text/format.h"
#include "tests/graphs/document/fake_types.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

/// Version 1 called the node type "photo" by "picture", version 2 its file "source".
std::vector<Migration> two_migrations() {
  const auto each_node = [](JsonValue& document, auto change) {
    if (JsonValue* nodes = document.find("nodes"))
      for (JsonMember& m : nodes->members) change(m.value);
  };
  return {[=](JsonValue& document) {
            each_node(document, [](JsonValue& node) {
              if (JsonValue* type = node.find("type"); type && type->text == "picture") type->text = "photo";
            });
          },
          [=](JsonValue& document) {
            each_node(document, [](JsonValue& node) {
              for (JsonMember& m : node.members)
                if (m.name == "source") m.name = "file";
            });
          }};
}

const std::string old_text =
    "{\"terrazzo\": 1, \"nodes\": {\"a\": {\"type\": \"picture\", \"source\": \"a.png\"}, // the exemplar\n"
    "\"out\": {\"type\": \"write\", \"material\": \"@a\", \"path\": \"b.png\"}}}";

}  // namespace

TEST_CASE("older documents are read as if they were of the current version") {
  const std::vector<Migration> migrations = two_migrations();
  const LoadOptions options{.types = fake_types(), .migrations = migrations};
  const LoadedGraph loaded = load_graph_text(old_text, "/x/a.json", {}, options);
  CHECK(loaded.graph.nodes[0].type->name == "photo");
  CHECK(std::get<std::string>(loaded.graph.nodes[0].params.at("file")) == "/x/a.png");
}

TEST_CASE("messages about an older document point into the file as it is") {
  const std::vector<Migration> migrations = two_migrations();
  const std::string text = "{\"terrazzo\": 2,\n\"nodes\": {\"a\": {\"type\": \"photo\", \"source\": 3}}}";
  CHECK_THROWS_WITH_AS(load_graph_text(text, "a.json", {}, {.types = fake_types(), .migrations = migrations}),
                       "a.json:2:44: node \"a\", parameter \"file\": expected a path, found the number 3", GraphError);
}

TEST_CASE("upgrading rewrites a document through every version and keeps its comments") {
  const std::string text = upgraded(old_text, "a.json", two_migrations());
  CHECK(text ==
        "{\n"
        "  \"terrazzo\": 3,\n"
        "  \"nodes\": {\n"
        "    \"a\": {\"type\": \"photo\", \"file\": \"a.png\"},  // the exemplar\n"
        "    \"out\": {\"type\": \"write\", \"material\": \"@a\", \"path\": \"b.png\"}\n"
        "  }\n"
        "}\n");
  CHECK(upgraded(text, "a.json", two_migrations()) == text);
}

TEST_CASE("a document from the future is refused") {
  CHECK_THROWS_WITH_AS(
      upgraded("{\"terrazzo\": 4}", "a.json", two_migrations()),
      "a.json:1:14: \"terrazzo\": the file has format 4, this terrazzo reads up to 3; use a newer terrazzo",
      GraphError);
  CHECK_THROWS_AS(upgraded("{\"terrazzo\": 1,,}", "a.json"), GraphError);
}

TEST_CASE("the canonical form has a line for each entry that fits on one") {
  const std::string long_text(100, 'x');
  const JsonValue v =
      *parse_json("// top\n{\"terrazzo\":1,\"parameters\":{},\"nodes\":{\"a\":{\"type\":\"photo\",\"file\":\"" +
                  long_text + "\", \"size\":[1,2]},\n// above b\n\"b\":{\"type\":\"x\", // why\n\"n\": 1.50}}}")
           .value;
  const std::string text = formatted(v);
  CHECK(text ==
        "// top\n"
        "{\n"
        "  \"terrazzo\": 1,\n"
        "  \"parameters\": {},\n"
        "  \"nodes\": {\n"
        "    \"a\": {\n"
        "      \"type\": \"photo\",\n"
        "      \"file\": \"" +
            long_text +
            "\",\n"
            "      \"size\": [1, 2]\n"
            "    },\n"
            "    // above b\n"
            "    \"b\": {\n"
            "      \"type\": \"x\",  // why\n"
            "      \"n\": 1.50\n"
            "    }\n"
            "  }\n"
            "}\n");
  CHECK(formatted(*parse_json(text).value) == text);
}

TEST_CASE("formatting keeps every value") {
  const std::string text =
      R"({"terrazzo": 1, "x": [null, true, false, -1.5e-3, "a\"\\\n\u0001ä", [], {}, {"k": [[1], {"y": 2}]}]})";
  const JsonValue v = *parse_json(text).value;
  CHECK(compact(*parse_json(formatted(v)).value) == compact(v));
}
