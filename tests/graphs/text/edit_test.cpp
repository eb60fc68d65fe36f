#include "graphs/text/edit.h"

#include <functional>
#include <random>

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
  CHECK(with_value("{ // none\n}", {"a"}, json("1")) == "{ // none\n  \"a\": 1\n}");
  CHECK(with_value(R"({"a": 1})", {"b"}, json("2")) == R"({"a": 1, "b": 2})");
  CHECK(with_value(R"({"a": 1, })", {"b"}, json("2")) == R"({"a": 1, "b": 2, })");
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

namespace {

/// The text after `change` of its document, which must read as that.
std::string changed(const std::string& text, const std::function<void(JsonValue&)>& change) {
  JsonValue after = json(text);
  change(after);
  std::string out = with_changes(text, after);
  const ParsedJson parsed = parse_json(out);
  INFO(out);
  REQUIRE(parsed.value);
  CHECK(same_value(*parsed.value, after));
  return out;
}

std::string without(const std::string& text, const std::string& name) {
  return changed(text,
                 [&](JsonValue& v) { std::erase_if(v.members, [&](const JsonMember& m) { return m.name == name; }); });
}

}  // namespace

TEST_CASE("a member goes away with its comments and its comma") {
  CHECK(without(R"({"a": 1, "b": 2, "c": 3})", "a") == R"({"b": 2, "c": 3})");
  CHECK(without(R"({"a": 1, "b": 2, "c": 3})", "b") == R"({"a": 1, "c": 3})");
  CHECK(without(R"({"a": 1, "b": 2, "c": 3})", "c") == R"({"a": 1, "b": 2})");
  CHECK(without(R"({ "a": 1, "b": 2 })", "a") == R"({ "b": 2 })");
  CHECK(without(R"({ "a":1,"b" :2 , })", "b") == R"({ "a":1, })");
  CHECK(without(R"({ "a": 1 })", "a") == "{}");
  CHECK(without("{\n  \"a\": 1,\n  \"b\": 2\n}", "b") == "{\n  \"a\": 1\n}");
  CHECK(without("{\n  \"a\": 1,\n\n  \"b\": 2\n}", "a") == "{\n  \"b\": 2\n}");
  CHECK(without("{\n  \"a\": 1, // one\n  // two\n  \"b\": 2 // more\n  // end\n}", "b") ==
        "{\n  \"a\": 1 // one\n  // end\n}");
  CHECK(without("{\r\n\t\"a\": 1,\r\n\t\"b\": 2,\r\n}", "a") == "{\r\n\t\"b\": 2,\r\n}");
  CHECK(without("{\"a\": 1, // one\n \"b\": 2}", "b") == "{\"a\": 1 // one\n}");
  CHECK(without("{\n  \"z\": 0, // zero\n  \"a\": 1, \"b\": 2\n}", "a") == "{\n  \"z\": 0, // zero\n  \"b\": 2\n}");
  CHECK(without("{ // all\n  \"a\": 1\n}", "a") == "{ // all\n}");
}

TEST_CASE("a comment above a blank line is about more than the member below it") {
  CHECK(without("{\n  // sources\n\n  // the bricks\n  \"a\": 1,\n  \"b\": 2\n}", "a") ==
        "{\n  // sources\n\n  \"b\": 2\n}");
  CHECK(without("{\n  \"z\": 0,\n  // more\n\n  \"a\": 1,\n\n  \"b\": 2\n}", "a") ==
        "{\n  \"z\": 0,\n  // more\n\n  \"b\": 2\n}");
}

TEST_CASE("members have other names in their places, and values keep their spelling") {
  const std::string before = "{\n  \"a\" :  1.50, // one\n  \"b\": {\"x\": [1,2,  3], \"y\": 1e3}\n}";
  CHECK(changed(before, [](JsonValue& v) { v.members[0].name = "c"; }) ==
        "{\n  \"c\" :  1.50, // one\n  \"b\": {\"x\": [1,2,  3], \"y\": 1e3}\n}");
  CHECK(changed(before, [](JsonValue& v) { v.find("b")->set("y", json("7")); }) ==
        "{\n  \"a\" :  1.50, // one\n  \"b\": {\"x\": [1,2,  3], \"y\": 7}\n}");
  CHECK(changed(before, [](JsonValue& v) { *v.find("b") = json(R"({"y": 1000.0, "x": [1, 3]})"); }) ==
        "{\n  \"a\" :  1.50, // one\n  \"b\": {\"x\": [1,  3], \"y\": 1e3}\n}");
}

TEST_CASE("items are put in and taken out") {
  const auto items = [](const std::string& text, const std::string& list) {
    return changed(text, [&](JsonValue& v) { v = json(list); });
  };
  CHECK(items("[1, 2, 3]", "[1, 3]") == "[1, 3]");
  CHECK(items("[1, 2, 3]", "[0, 1, 2, 3]") == "[0, 1, 2, 3]");
  CHECK(items("[1,2]", "[1, 2, 3]") == "[1,2, 3]");
  CHECK(items("[\n  1, // one\n  2 // two\n]", "[1, 5, 2]") == "[\n  1, // one\n  5,\n  2 // two\n]");
  CHECK(items("[]", "[1]") == "[1]");
  CHECK(items("[1]", "[]") == "[]");
}

TEST_CASE("a canonical entry that becomes too long is broken into lines as the canonical form has it") {
  const std::string value(90, 'x');
  const std::string before = "{\n  \"nodes\": {\n    \"a\": {\"type\": \"" + value + "\"}\n  }\n}\n";
  CHECK(changed(before,
                [](JsonValue& v) { v.find("nodes")->find("a")->set("comment", json("\"twenty characters\"")); }) ==
        "{\n  \"nodes\": {\n    \"a\": {\n      \"type\": \"" + value +
            "\",\n      \"comment\": \"twenty characters\"\n    }\n  }\n}\n");
}

TEST_CASE("a line that is too long already stays one") {
  const std::string line = "    \"a\": {\"type\": \"" + std::string(110, 'x') + "\", \"b\": ";
  const auto text = [&](const std::string& b) { return "{\n  \"nodes\": {\n" + line + b + "}\n  }\n}\n"; };
  CHECK(changed(text("1"), [](JsonValue& v) { v.find("nodes")->find("a")->set("b", json("23")); }) == text("23"));
}

TEST_CASE("sections that are empty get their entries on lines of their own") {
  const auto add = [](JsonValue& v) { v.find("nodes")->set("a", json(R"({"type": "x"})")); };
  CHECK(changed("{\r\n  \"nodes\": {}\r\n}\r\n", add) ==
        "{\r\n  \"nodes\": {\r\n    \"a\": {\"type\": \"x\"}\r\n  }\r\n}\r\n");
  CHECK(changed("{\n\t\"nodes\": {\n\t\t// nothing yet\n\t}\n}", add) ==
        "{\n\t\"nodes\": {\n\t\t// nothing yet\n\t\t\"a\": {\"type\": \"x\"}\n\t}\n}");
  CHECK(changed(R"({"nodes": {}})", add) == R"({"nodes": {"a": {"type": "x"}}})");
}

namespace {

/// Random JSON in all sorts of layouts.
class RandomText {
 public:
  explicit RandomText(unsigned seed) : random(seed) {}

  std::mt19937 random;
  size_t below(size_t n) { return random() % n; }

  std::string space(bool may_end = true) {
    static const std::vector<std::string> all = {"",       "",       " ",       "\n  ",
                                                 "\r\n\t", "\n\n  ", " // c\n", "\n  // {\"x\": 1,\n  "};
    return all[below(may_end ? all.size() : 3)];
  }

  std::string value(int depth) {
    static const std::vector<std::string> plain = {"1",    "-2.50",           "1e3",  "true", "null",
                                                   "\"\"", "\"a \\\" // ]\"", "\"ü\""};
    const size_t kind = depth > 3 ? 2 : below(4);
    if (kind > 1) return plain[below(plain.size())];
    const size_t count = below(4);
    std::string out = kind == 0 ? "{" : "[";
    for (size_t i = 0; i < count; i++) {
      out += space();
      if (kind == 0) out += "\"n" + std::to_string(i) + "\"" + space() + ":" + space();
      out += value(depth + 1) + space();
      if (i + 1 < count || below(4) == 0) out += ",";
    }
    return out + space() + (kind == 0 ? "}" : "]");
  }

  /// Changes something somewhere.
  void change(JsonValue& v) {
    const bool is_deeper = below(3) > 0;
    if (is_deeper && !v.members.empty()) return change(v.members[below(v.members.size())].value);
    if (is_deeper && !v.items.empty()) return change(v.items[below(v.items.size())]);
    const JsonValue fresh = json(value(2));
    if (v.is_object() && below(5) > 0) {
      const size_t at = below(v.members.size() + 1);
      if (at < v.members.size() && below(2) == 0)
        v.members.erase(v.members.begin() + ptrdiff_t(at));
      else if (at < v.members.size() && below(2) == 0)
        v.members[at].name = "renamed" + std::to_string(below(1000000));
      else
        v.members.insert(v.members.begin() + ptrdiff_t(at), {"new" + std::to_string(below(1000000)), {}, fresh});
    } else if (v.is_list() && below(5) > 0) {
      const size_t at = below(v.items.size() + 1);
      if (at < v.items.size() && below(2) == 0)
        v.items.erase(v.items.begin() + ptrdiff_t(at));
      else
        v.items.insert(v.items.begin() + ptrdiff_t(at), fresh);
    } else {
      v = fresh;
    }
  }
};

}  // namespace

TEST_CASE("any change of any text reads as it should") {
  RandomText random(3);
  for (int i = 0; i < 3000; i++) {
    std::string text = (random.below(4) == 0 ? "\xef\xbb\xbf" : "") + random.space() + random.value(0) + random.space();
    if (!text.ends_with('\n')) text += "\n";
    const ParsedJson parsed = parse_json(text);
    INFO(text);
    REQUIRE(parsed.value);
    CHECK(with_changes(text, *parsed.value) == text);
    changed(text, [&](JsonValue& v) {
      for (size_t n = random.below(4); n-- > 0;) random.change(v);
      random.change(v);
    });
  }
}
