#include <algorithm>
#include <exception>
#include <functional>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "core/base/hash.h"
#include "graphs/text/migrate.h"
#include "tests/graphs/document/fake_types.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

const std::string valid = R"({ // a graph
  "terrazzo": 1, "summary": "Umlauts: ä", "help": "h",
  "parameters": {"p": {"type": "path", "default": "maps", "help": "x"}, "n": {"type": "int", "default": 3, "min": 0, "max": 9},
    "s": {"type": "size", "default": [64, 32]}, "c": {"type": "choice", "choices": ["color", "height"], "default": "color"}},
  "nodes": {
    "a": {"type": "photo", "file": "$p/a.png", "kind": "$c"},
    "b": {"type": "adjust", "image": "@a", "amount": 0.25, "steps": "$n", "size": "$s", "wrap": true, "label": "@@x $$ ${n}"},
    "g": {"type": "gather", "images": ["@a", "@b.image"], "channels": {"r": "x"}, "gains": {"x": [1, 2e-1]}, "weights": [1, 2]},
    "w": {"type": "write", "material": "@g.material", "path": "out/{map}.png"} // sink
  }
}
)";

/// A graph or a GraphError with at least one problem: nothing else may come of any text.
bool is_handled(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    load_fake(text, overrides);
    return true;
  } catch (const GraphError& e) {
    return !e.problems().empty();
  } catch (const std::exception&) {
    return false;
  }
}

bool can_be_upgraded_or_refused(const std::string& text) {
  try {
    const std::string once = upgraded(text, "x.json");
    return upgraded(once, "x.json") == once;
  } catch (const GraphError& e) {
    return !e.problems().empty();
  } catch (const std::exception&) {
    return false;
  }
}

}  // namespace

TEST_CASE("the document that is going to be spoilt is valid") {
  CHECK(problems_of(valid) == "");
}

TEST_CASE("a document cut off anywhere gives a clear error") {
  for (size_t length = 0; length < valid.size(); length++) {
    CAPTURE(length);
    CHECK(is_handled(valid.substr(0, length)));
  }
}

TEST_CASE("changed, added and lost bytes give a graph or a clear error") {
  constexpr std::string_view likely = "{}[]\",:@$.-/\\\n 019eE\xC3\xFF\x01";
  for (size_t at = 0; at < valid.size(); at++) {
    CAPTURE(at);
    const uint64_t bits = random_bits(1, at);
    const char byte = bits % 2 ? likely[(bits >> 8) % likely.size()] : static_cast<char>(bits >> 16);
    std::string changed = valid, added = valid, lost = valid;
    changed[at] = byte;
    added.insert(at, 1, byte);
    lost.erase(at, 1 + (bits >> 32) % 8);
    CHECK(is_handled(changed));
    CHECK(is_handled(added));
    CHECK(is_handled(lost));
    CHECK(can_be_upgraded_or_refused(added));
  }
}

TEST_CASE("any value may stand anywhere") {
  const std::vector<std::string> values = {
      "null",   "true",      "-1",     "1e300",  "9223372036854775807", "\"\"", "\"@\"",
      "\"@.\"", "\"$\"",     "\"$n\"", "\"@w\"", "\"99999999999x1\"",   "[]",   "{}",
      "[[]]",   "{\"\": {}}"};
  const std::vector<std::string> parts = {"1, \"summary\"",
                                          "\"path\", \"default\"",
                                          "\"maps\"",
                                          "3, \"min\"",
                                          "[64, 32]",
                                          "[\"color\", \"height\"]",
                                          "\"photo\"",
                                          "\"$p/a.png\"",
                                          "\"@a\"",
                                          "0.25",
                                          "\"$n\"",
                                          "\"$s\"",
                                          "true",
                                          "{\"r\": \"x\"}",
                                          "[1, 2e-1]",
                                          "[1, 2]",
                                          "\"@g.material\"",
                                          "[\"@a\", \"@b.image\"]"};
  for (const std::string& part : parts) {
    const size_t at = valid.find(part);
    REQUIRE(at != valid.npos);
    const size_t rest = part.find(", \"");
    const std::string kept = part.front() == '[' || rest == part.npos ? "" : part.substr(rest);
    for (const std::string& value : values) {
      const std::string text = std::string(valid).replace(at, part.size(), value + kept);
      CAPTURE(text);
      CHECK(is_handled(text));
    }
  }
}

TEST_CASE("any override gives a graph or a clear error") {
  for (const std::string target : {"p", "n", "s", "c", "a.file", "a.kind", "b.image", "b.size", "b.steps", "g.images",
                                   "g.gains", "g.weights", "w.material", "", ".", "x.y.z", "\xFF"})
    for (const std::string value : {"",         "@",          "@a",      "$",  "$n",       "${",        "null",
                                    "[",        "[[",         "{\"a\":", "-1", "1e999",    "3x",        "x3",
                                    "\xFF\xFE", "9999999999", "\"",      "//", "[\"@a\"]", "{\"x\": 1}"}) {
      const std::string override = target + "=" + value;
      CAPTURE(override);
      CHECK(is_handled(valid, {override}));
    }
}

namespace {

constexpr int many = 20000;

/// A graph of many nodes, each of which `line` makes.
GraphError error_of_many(const std::function<std::string(int)>& line) {
  std::string text = R"({"terrazzo": 1, "nodes": {"a": {"type": "photo", "file": "a.png"})";
  for (int i = 0; i < many; i++) text += fmt::format(",\n\"n{}\": {}", i, line(i));
  try {
    load_fake(text + "}}");
  } catch (const GraphError& e) {
    return e;
  }
  return GraphError("", {});
}

size_t lines_with(const std::vector<Problem>& problems, const std::string& words) {
  return size_t(std::count_if(problems.begin(), problems.end(),
                              [&](const Problem& p) { return p.message.find(words) != std::string::npos; }));
}

}  // namespace

TEST_CASE("of very many mistakes the first hundred are shown, and only these are compared with all nodes") {
  const GraphError nowhere =
      error_of_many([](int i) { return fmt::format(R"({{"type": "adjust", "image": "@m{}"}})", i); });
  REQUIRE(nowhere.problems().size() == many);
  CHECK(lines_with(nowhere.problems(), "leads to no node") == many);
  CHECK(lines_with(nowhere.problems(), "did you mean") + lines_with(nowhere.problems(), "(valid: ") == 100);
  CHECK(std::string(nowhere.what()).ends_with("\nand 19,900 more problems"));
  CHECK(std::ranges::count(std::string(nowhere.what()), '\n') == 100);

  const GraphError types = error_of_many([](int i) {
    return fmt::format(R"({{"type": "adjust", "image": "@{}"}})", i == 0 ? "a" : "n" + std::to_string(i - 1) + ".no");
  });
  CHECK(types.problems().size() == many - 1);
}

TEST_CASE("of long cycles the middle is left out, and of very many the text stays short") {
  const GraphError one =
      error_of_many([](int i) { return fmt::format(R"({{"type": "adjust", "image": "@n{}"}})", (i + 1) % many); });
  REQUIRE(one.problems().size() == 1);
  CHECK(one.problems()[0].message.find("the wires form a cycle: n0 -> n19999 -> n19998") == 0);
  CHECK(one.problems()[0].message.find(" -> n19990 -> (19980 more) -> n9 -> n8 ") != std::string::npos);
  CHECK(one.problems()[0].message.ends_with(" -> n1 -> n0"));

  const GraphError all = error_of_many([](int i) {
    return fmt::format(R"({{"type": "gather", "images": ["@n{}", "@n0"]}})", std::min(i + 1, many - 1));
  });
  CHECK(all.problems().size() >= many - 1);
  size_t longest = 0;
  for (const Problem& p : all.problems()) longest = std::max(longest, p.message.size());
  CHECK(longest < 500);
}
