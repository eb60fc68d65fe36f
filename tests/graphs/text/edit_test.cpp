#include "graphs/text/edit.h"

#include <doctest/doctest.h>

#include "core/base/error.h"

using namespace terrazzo;

namespace {

JsonValue json(const std::string& text) {
  return *parse_json(text).value;
}

}  // namespace

TEST_CASE("a value is changed in its place and all else stays") {
  const std::string before =
      "\xef\xbb\xbf{ // \"seed\": 3\r\n  \"größe\": {\"seed\" :  [1, {\"a\": \"]}\\\"\"}, // }\r\n 2] , "
      "},\n\t\"last\": -1.5e3}";
  CHECK(with_value(before, {"größe", "seed"}, json("7")) ==
        "\xef\xbb\xbf{ // \"seed\": 3\r\n  \"größe\": {\"seed\" :  7 , },\n\t\"last\": -1.5e3}");
  CHECK(with_value(before, {"last"}, json("\"x\"")) ==
        "\xef\xbb\xbf{ // \"seed\": 3\r\n  \"größe\": {\"seed\" :  [1, {\"a\": \"]}\\\"\"}, // }\r\n 2] , "
        "},\n\t\"last\": \"x\"}");
  CHECK(with_value("3", {}, json("[4]")) == "[4]");
}

TEST_CASE("what is not there yet comes last, in the style of its neighbours") {
  CHECK(with_value("{}", {"a", "b"}, json("1")) == R"({"a": {"b": 1}})");
  CHECK(with_value("{ // none\n}", {"a"}, json("1")) == "{\"a\": 1 // none\n}");
  CHECK(with_value(R"({"a": 1})", {"b"}, json("2")) == R"({"a": 1, "b": 2})");
  CHECK(with_value(R"({"a": 1, })", {"b"}, json("2")) == R"({"a": 1, "b": 2 })");
  CHECK(with_value("{\n  \"a\": 1 // one\n}", {"b"}, json("2")) == "{\n  \"a\": 1, // one\n  \"b\": 2\n}");
  CHECK(with_value("{\r\n  \"a\": 1,\r\n  // the end\r\n}", {"b"}, json("2")) ==
        "{\r\n  \"a\": 1,\r\n  \"b\": 2,\r\n  // the end\r\n}");
  CHECK(with_value("{\n  \"a\": 1}", {"b"}, json("2")) == "{\n  \"a\": 1, \"b\": 2}");
  CHECK(with_value("{\n  \"a\": {\"x\": 1}, \"c\": 2\n}", {"a", "y"}, json("2")) ==
        "{\n  \"a\": {\"x\": 1, \"y\": 2}, \"c\": 2\n}");
}

TEST_CASE("only objects have members") {
  CHECK_THROWS_AS(with_value(R"({"a": 1})", {"a", "b"}, json("2")), Error);
  CHECK_THROWS_AS(with_value("{", {"a"}, json("2")), Error);
}
