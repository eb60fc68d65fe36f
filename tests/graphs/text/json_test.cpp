#include "graphs/text/json.h"

#include <doctest/doctest.h>

using namespace terrazzo;

namespace {

JsonValue parsed(const std::string& text) {
  const ParsedJson json = parse_json(text);
  REQUIRE_MESSAGE(json.problems.empty(), (json.problems.empty() ? "" : json.problems.front().message));
  return *json.value;
}

/// `line:column message` of the only problem.
std::string problem_in(const std::string& text) {
  const ParsedJson json = parse_json(text);
  REQUIRE(json.problems.size() == 1);
  const Problem& p = json.problems.front();
  return std::to_string(p.place.line) + ":" + std::to_string(p.place.column) + " " + p.message;
}

std::string nested(int depth) {
  return std::string(depth, '[') + std::string(depth, ']');
}

}  // namespace

TEST_CASE("every value and name knows its line and column") {
  const JsonValue v = parsed("{\n  \"a\": [1,\n    true],\n  \"b\": {\"c\": null}\n}");
  CHECK(v.place.line == 1);
  CHECK(v.members[0].place.line == 2);
  CHECK(v.members[0].place.column == 3);
  CHECK(v.members[0].value.place.column == 8);
  CHECK(v.members[0].value.items[1].place.line == 3);
  CHECK(v.members[0].value.items[1].place.column == 5);
  CHECK(v.find("b")->find("c")->place.column == 14);
}

TEST_CASE("a comma may follow the last entry, but nothing else may") {
  CHECK(parsed("[1, 2,]").items.size() == 2);
  CHECK(parsed("{\"a\": 1,}").members.size() == 1);
  CHECK(parsed("{\"a\": [1, // one\n // none\n],\n}").find("a")->items.front().comment_after == "// one");
  CHECK(parsed("[1,\n // none\n]").comments_inside.size() == 1);
  for (const char* wrong : {"[,]", "[1,,]", "[1,,2]", "{,}", "{\"a\": 1,,}", "{\"a\",}"}) {
    CAPTURE(std::string(wrong));
    CHECK_FALSE(parse_json(wrong).value);
  }
}

TEST_CASE("columns count characters, not bytes") {
  CHECK(parsed("[\"\xC3\xA4\xE2\x82\xAC\xF0\x9F\x98\x80\", 1]").items[1].place.column == 9);
  CHECK(parsed("\xEF\xBB\xBF[1]").items[0].place.column == 2);
}

TEST_CASE("lines may end in a carriage return as well") {
  CHECK(parsed("{\r\n\"a\": 1 // one\r\n}").find("a")->place.line == 2);
}

TEST_CASE("numbers keep their spelling and tell integers from others") {
  const JsonValue v = parsed("[0, -12, 1.50, 2e3, -0, 9223372036854775807, 9223372036854775808]");
  CHECK(v.items[0].kind == JsonValue::Kind::integer);
  CHECK(v.items[1].integer == -12);
  CHECK(v.items[1].number == -12);
  CHECK(v.items[2].kind == JsonValue::Kind::number);
  CHECK(v.items[2].text == "1.50");
  CHECK(v.items[3].number == 2000);
  CHECK(v.items[5].integer == INT64_MAX);
  CHECK(v.items[6].kind == JsonValue::Kind::number);
}

TEST_CASE("malformed numbers are refused") {
  for (const std::string text : {"01", "+1", "1.", ".5", "1e", "1e+", "--1", "-", "0x10", "1_000", "1.2.3", "1e400"}) {
    CAPTURE(text);
    CHECK(parse_json(text).problems.size() == 1);
  }
}

TEST_CASE("escapes in texts give their characters") {
  CHECK(parsed(R"("\"\\\/\b\f\n\r\t")").text == "\"\\/\b\f\n\r\t");
  CHECK(parsed(R"("\u00e4\u20AC\ud83d\ude00")").text == "\xC3\xA4\xE2\x82\xAC\xF0\x9F\x98\x80");
  for (const std::string text : {R"("\x")", R"("\u12")", R"("\u12g4")", R"("\ud83d")", R"("\ud83dx")",
                                 R"("\ud83d\u0041")", R"("\ude00")", R"("\u0000")", "\"\\", "\"\\u"}) {
    CAPTURE(text);
    CHECK(parse_json(text).problems.size() == 1);
  }
}

TEST_CASE("what is no UTF-8 is refused at its place") {
  CHECK(problem_in("[\n\"\xC3\"]") == "2:2 the byte 0xc3 is not UTF-8; save the file as UTF-8");
  for (const std::string wrong : {"\xC0\xAF", "\xE0\x80\xAF", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xF8", "\xE2\x82"}) {
    CAPTURE(wrong);
    CHECK(parse_json("[\"" + wrong + "\"]").problems.size() == 1);
  }
}

TEST_CASE("nesting is limited") {
  CHECK(parse_json(nested(json_depth_limit)).problems.empty());
  CHECK(problem_in(nested(json_depth_limit + 1)) == "1:65 nested deeper than 64 levels");
  CHECK(parse_json(std::string(1000000, '[')).problems.size() == 1);
  std::string objects;
  for (int i = 0; i < 100000; i++) objects += "{\"a\":";
  CHECK(problem_in(objects) == "1:321 nested deeper than 64 levels");
}

TEST_CASE("all duplicate names are found, and a syntax error beside them") {
  const ParsedJson json = parse_json("{\"a\": 1, \"b\": {\"c\": 1, \"c\": 2}, \"a\": 2,, }");
  REQUIRE(json.problems.size() == 3);
  CHECK_FALSE(json.value);
  CHECK(json.problems[0].place.column == 24);
}

TEST_CASE("a name that stands twice is found even if its value cannot be read, in the order of places") {
  const ParsedJson json = parse_json("{\"a\": 1, \"a\": {\"b\": 1, \"b\": ?}}");
  REQUIRE(json.problems.size() == 3);
  CHECK(json.problems[0].place.column == 10);
  CHECK(json.problems[1].place.column == 24);
  CHECK(json.problems[2].message == "expected a value for \"b\", found \"?\"");
}

TEST_CASE("comments are kept with what they are about") {
  const JsonValue v = parsed(
      "// the file\n{\n  // first\n  // second\n  \"a\": 1, // after a\n  \"b\": [1, // one\n  2 // two\n  ]\n  // "
      "last\n}\n// end");
  CHECK(v.comments_before == std::vector<std::string>{"// the file"});
  CHECK(v.find("a")->comments_before == std::vector<std::string>{"// first", "// second"});
  CHECK(v.find("a")->comment_after == "// after a");
  CHECK(v.find("b")->items[0].comment_after == "// one");
  CHECK(v.find("b")->items[1].comment_after == "// two");
  CHECK(v.comments_inside == std::vector<std::string>{"// last", "// end"});
}

TEST_CASE("long values are shortened in messages, between characters") {
  JsonValue v;
  v.kind = JsonValue::Kind::text;
  for (int i = 0; i < 100; i++) v.text += "\xC3\xA4";
  const std::string shown = found(v);
  CHECK(shown.size() < 100);
  CHECK(parse_json(shown.substr(9, shown.find(" and so on") - 9)).problems.empty());
}
