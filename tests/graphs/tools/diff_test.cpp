#include "graphs/tools/diff.h"

#include <doctest/doctest.h>

using namespace terrazzo;

namespace {

std::vector<std::string> diff(const std::string& a, const std::string& b) {
  return differences(*parse_json(a).value, *parse_json(b).value);
}

const std::string graph = R"({"terrazzo": 1, "parameters": {"seed": {"type": "int", "default": 1}},
  "nodes": {"a": {"type": "photo", "file": "a.png"}, "b": {"type": "adjust", "image": "@a", "size": "=@a.size * 2"},
  "out": {"type": "write", "material": "@b", "path": "x-$seed.png"}}})";

std::string changed(const std::string& from, const std::string& to) {
  std::string out = graph;
  for (size_t at = out.find(from); at != out.npos; at = out.find(from, at + to.size()))
    out.replace(at, from.size(), to);
  return out;
}

}  // namespace

TEST_CASE("order, comments and spaces are no differences") {
  CHECK(diff(graph, graph).empty());
  CHECK(diff(graph, R"({"terrazzo": 1, "nodes": {
    // the end first
    "out": {"path": "x-$seed.png", "type": "write", "material": "@b"}, "a": {"file": "a.png", "type": "photo"},
    "b": {"type": "adjust", "image": "@a", "size": "=@a.size * 2"}}, "parameters": {"seed": {"default": 1, "type": "int"}}})")
            .empty());
}

TEST_CASE("changed, new and missing values in words") {
  CHECK(diff(graph, changed("a.png", "c.png")) == std::vector<std::string>{R"(node "a": file "a.png" -> "c.png")"});
  CHECK(diff(graph, changed("\"default\": 1", "\"default\": 2, \"min\": 0")) ==
        std::vector<std::string>{R"(parameter "seed": default 1 -> 2)", R"(parameter "seed": min is given now: 0)"});
  CHECK(diff(graph, changed(", \"size\": \"=@a.size * 2\"", "")) ==
        std::vector<std::string>{R"(node "b": size is no longer given; it was "=@a.size * 2")"});
  CHECK(diff(graph, changed("\"terrazzo\": 1", "\"terrazzo\": 1, \"seed\": 3")) ==
        std::vector<std::string>{"seed is given now: 3"});
}

TEST_CASE("nodes come, go, and are renamed") {
  CHECK(diff(graph, changed("\"a\": {\"type\": \"photo\", \"file\": \"a.png\"}, ", "")) ==
        std::vector<std::string>{R"(node "a" (photo) is gone)"});
  CHECK(diff(graph, changed("\"nodes\": {", "\"nodes\": {\"z\": {\"type\": \"photo\", \"file\": \"z\"}, ")) ==
        std::vector<std::string>{R"(node "z" (photo) is new: {"type": "photo", "file": "z"})"});
  std::string renamed = graph;
  for (const auto& [from, to] :
       {std::pair("\"a\":", "\"photo\":"), std::pair("@a\"", "@photo\""), std::pair("@a.", "@photo.")})
    for (size_t at = renamed.find(from); at != renamed.npos; at = renamed.find(from, at + 1))
      renamed.replace(at, std::string(from).size(), to);
  CHECK(diff(graph, renamed) == std::vector<std::string>{R"(node "a" is called "photo" now)"});
}

TEST_CASE("graphs in graphs are compared with their place") {
  const std::string with =
      R"({"graphs": {"g": {"nodes": {"n": {"type": "photo", "file": "a"}}, "outputs": {"image": "@n"}}}})";
  std::string other = with;
  other.replace(other.find("\"a\""), 3, "\"b\"");
  CHECK(diff(with, other) == std::vector<std::string>{R"(graph "g", node "n": file "a" -> "b")"});
}
