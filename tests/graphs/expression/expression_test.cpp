#include "graphs/expression/expression.h"

#include <map>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "graphs/expression/operations.h"

using namespace terrazzo;

namespace {

class Scope : public ExpressionScope {
 public:
  ExpressionValue parameter(const std::string& name) override {
    const auto at = values.find(name);
    if (at == values.end()) throw Error(fmt::format("no {}", name));
    return at->second;
  }
  const Forecast& forecast(const std::string& node) override { return forecasts.at(node); }

  std::map<std::string, ExpressionValue> values = {
      {"size", {Size{512, 256}, "pixels"}},
      {"seed", {int64_t{7}}},
      {"radius", {2.5, "pixels"}},
      {"turn", {90.0, "degrees"}},
      {"quality", {std::string("best")}},
      {"wrap", {true}},
      {"weights", {NumberMap{{"height", {2}}, {"normal", {1, 0.5}}}}},
      {"fill", {TextMap{{"r", "height"}}}},
      {"levels", {Numbers{1, 2, 4}}},
      {"maps", {Texts{"height", "normal"}}},
      {"far", {int64_t{9223372036854775807}}},
  };
  std::map<std::string, Forecast> forecasts = {
      {"bricks",
       {.maps = {"height", "normal"},
        .images = {{"height", {.size = Size{64, 32}}}, {"normal", {.size = Size{64, 32}}}}}},
      {"mixed",
       {.maps = {"height", "normal"},
        .images = {{"height", {.size = Size{64, 32}}}, {"normal", {.size = Size{128, 64}}}}}},
      {"some", {.maps = {"height"}, .possible_maps = std::vector<std::string>{"normal"}}},
      {"nothing", {}}};
};

ExpressionValue value_of(const std::string& text) {
  Scope scope;
  return Expression(text).evaluate(scope);
}

/// A value as a person writes it, with its unit.
std::string shown(const std::string& text) {
  const ExpressionValue v = value_of(text);
  std::string out;
  if (const auto* numbers = std::get_if<Numbers>(&v.value))
    out = fmt::format("[{}]", fmt::join(*numbers, ", "));
  else if (const auto* texts = std::get_if<Texts>(&v.value))
    out = fmt::format("['{}']", fmt::join(*texts, "', '"));
  else
    out = expression::described(v);
  return v.unit.empty() ? out : out + " " + v.unit;
}

/// `offset: message` of what is wrong with it.
std::string trouble(const std::string& text) {
  try {
    Scope scope;
    Expression(text).evaluate(scope);
  } catch (const ExpressionError& e) {
    return fmt::format("{}: {}", e.offset(), e.what());
  }
  return "";
}

}  // namespace

TEST_CASE("operators bind as in mathematics, and from the left") {
  CHECK(shown("1 + 2 * 3") == "the number 7");
  CHECK(shown("(1 + 2) * 3") == "the number 9");
  CHECK(shown("10 - 4 - 3") == "the number 3");
  CHECK(shown("64 / 4 / 2") == "the number 8");
  CHECK(shown("-2 * -3") == "the number 6");
  CHECK(shown("1 + 1 == 2 && 2 < 3") == "true");
  CHECK(shown("true || false && false") == "true");
  CHECK(shown("seed > 5 ? 'many' : seed > 2 ? 'some' : 'few'") == "the text 'many'");
  CHECK(shown("!(1 > 2)") == "true");
}

TEST_CASE("whole numbers stay exact, and what does not fit is an error") {
  CHECK(shown("1024 / 2") == "the number 512");
  CHECK(std::holds_alternative<int64_t>(value_of("1024 / 2").value));
  CHECK(shown("7 / 2") == "the number 3.5");
  CHECK(shown("0.5 * 4") == "the number 2");
  CHECK(std::holds_alternative<int64_t>(value_of("0.5 * 4").value));
  CHECK(shown("9007199254740993 + 2") == "the number 9007199254740995");  // beyond what doubles hold
  CHECK(shown("far") == "the number 9223372036854775807");
  CHECK(trouble("1 + far") == "2: the result does not fit into 64 bits");
  CHECK(trouble("far * 2") == "4: the result does not fit into 64 bits");
  CHECK(trouble("0 - far - 2") == "8: the result does not fit into 64 bits");
  CHECK(trouble("(0 - far - 1) / -1") == "");
  CHECK(shown("-7 % 3") == "the number 2");
  CHECK(shown("7 % -3") == "the number -2");
  CHECK(shown("5.5 % 2") == "the number 1.5");
  CHECK(trouble("1 / 0") == "2: division by zero");
  CHECK(trouble("1 % 0") == "2: division by zero");
  CHECK(trouble("1e308 * 10") == "6: the result is not a finite number");
}

TEST_CASE("sizes and lists are worked on element by element") {
  CHECK(shown("size / 2") == "[256, 128] pixels");
  CHECK(shown("size.x / size.y") == "the number 2");
  CHECK(shown("size * [1, 2]") == "[512, 512] pixels");
  CHECK(shown("max(size, 300)") == "[512, 300] pixels");
  CHECK(shown("[seed, seed + 1]") == "[7, 8]");
  CHECK(shown("levels * 2 + 1") == "[3, 5, 9]");
  CHECK(shown("['a', quality]") == "['a', 'best']");
  CHECK(shown("weights.height") == "the number 2");
  CHECK(shown("weights.normal") == "[1, 0.5]");
  CHECK(shown("fill.r") == "the text 'height'");
  CHECK(trouble("levels + size") == "7: expected lists of equal length, found 3 and 2 numbers");
  CHECK(trouble("size.z") == "5: a size has .x, its width, and .y, its height; found .z");
  CHECK(trouble("weights.rough") == "8: there is no \"rough\" in it");
  CHECK(trouble("seed.x") == "5: the number 7 has no .x");
  CHECK(trouble("[1, 'a']") == "0: a list holds numbers or texts, found the text 'a'");
}

TEST_CASE("functions") {
  CHECK(shown("min(3, 1, 2)") == "the number 1");
  CHECK(shown("max(3, 1, 2)") == "the number 3");
  CHECK(shown("clamp(seed, 0, 5)") == "the number 5");
  CHECK(shown("clamp(0 - seed, 0, 5)") == "the number 0");
  CHECK(shown("round(2.5)") == "the number 3");
  CHECK(shown("round(-2.5)") == "the number -2");
  CHECK(shown("floor(2.7)") == "the number 2");
  CHECK(shown("ceil(2.1)") == "the number 3");
  CHECK(shown("round(size.x, 100)") == "the number 500 pixels");
  CHECK(shown("ceil(100, 64)") == "the number 128");
  CHECK(shown("floor(size, 100)") == "[500, 200] pixels");
  CHECK(shown("abs(-4)") == "the number 4");
  CHECK(shown("sqrt(16)") == "the number 4");
  CHECK(shown("length(maps)") == "the number 2");
  CHECK(trouble("sqrt(0 - 1)") == "0: the square root of -1");
  CHECK(trouble("round(1, 0)") == "0: round takes a step above 0, found 0");
  CHECK(trouble("clamp(1, 2)") == "0: expected clamp(value, least, most), found 2 arguments");
  CHECK(trouble("clam(1, 2)").starts_with("0: unknown function \"clam\" (did you mean \"clamp\"?"));
}

TEST_CASE("units of sums, comparisons and lists agree") {
  CHECK(shown("radius + 1") == "the number 3.5 pixels");
  CHECK(shown("radius * 2") == "the number 5 pixels");
  CHECK(shown("size.x / radius") == "the number 204.8");
  CHECK(shown("turn / 2") == "the number 45 degrees");
  CHECK(trouble("radius + turn") == "7: a sum of pixels and degrees: the units differ");
  CHECK(trouble("radius < turn") == "7: a comparison of pixels and degrees: the units differ");
  CHECK(trouble("radius == turn") == "7: a comparison of pixels and degrees: the units differ");
  CHECK(trouble("radius * size.x") == "7: pixels times pixels is not a unit here");
  CHECK(trouble("1 / radius") == "2: a number divided by pixels is not a unit here");
  CHECK(trouble("[radius, turn]") == "0: a list of pixels and degrees: the units differ");
  CHECK(trouble("max(radius, turn)") == "0: max of pixels and degrees: the units differ");
}

TEST_CASE("only what a condition chooses is evaluated") {
  CHECK(shown("true ? 1 : 1 / 0") == "the number 1");
  CHECK(shown("false && 1 / 0 == 1") == "false");
  CHECK(shown("true || 1 / 0 == 1") == "true");
  CHECK(trouble("1 ? 2 : 3") == "2: the condition before ? takes true or false, found the number 1");
  CHECK(trouble("1 && true") == "2: && takes true or false, found the number 1");
  CHECK(trouble("true && 1") == "5: && takes true or false, found the number 1");
}

TEST_CASE("texts, numbers and truth are compared with their like") {
  CHECK(shown("quality == 'best'") == "true");
  CHECK(shown("quality != 'draft'") == "true");
  CHECK(shown("size == [512, 256]") == "true");
  CHECK(shown("1 == 1.0") == "true");
  CHECK(shown("wrap == true") == "true");
  CHECK(trouble("quality == 1") == "8: a comparison of the text 'best' and the number 1");
  CHECK(trouble("quality < 'x'") == "8: < compares numbers, found the text 'best'");
  CHECK(trouble("quality - 1") == "8: - takes numbers, found the text 'best'");
  CHECK(shown("'out/' + quality + '-' + seed + '-' + size") == "the text 'out/best-7-512x256'");
  CHECK(shown("0.5 + 'x'") == "the text '0.5x'");
  CHECK(trouble("'x' + wrap") == "4: + joins texts, numbers and sizes, found true");
}

TEST_CASE("facts of nodes are what is known before they run") {
  CHECK(shown("@bricks.size * 2") == "[128, 64] pixels");
  CHECK(shown("@bricks.size.x") == "the number 64 pixels");
  CHECK(shown("@mixed.normal.size") == "the size 128x64 pixels");
  CHECK(shown("@bricks.count") == "the number 2");
  CHECK(shown("@bricks.maps") == "['height', 'normal']");
  CHECK(shown("@mixed.size") == "the size 128x64 pixels");  // as a material has it: that of its largest map
  CHECK(trouble("@bricks.heigt.size").starts_with("0: \"bricks\" gives no map \"heigt\" whose size is known (did you"));
  CHECK(trouble("@nothing.size") == "0: the size of the result of \"nothing\" is not known before it runs");
  CHECK(trouble("@some.count") == "0: the maps of \"some\" are not known before it runs");
  CHECK(trouble("@bricks.height.mean") == "15: of a map only the size is known before it is made, found mean");
  CHECK(trouble("@bricks") == "7: expected .size, .MAP.size, .count or .maps after @bricks");
}

TEST_CASE("what an expression names is known without evaluating it") {
  const Expression e("quality == 'best' ? size.x * @bricks.size.y : max(seed, size.y)");
  CHECK(e.parameters() == std::map<std::string, size_t>{{"quality", 0}, {"size", 20}, {"seed", 50}});
  CHECK(e.nodes() == std::map<std::string, size_t>{{"bricks", 29}});
}

TEST_CASE("errors say where they are and what was expected") {
  CHECK(trouble("") == "0: expected a number, a name, 'text' or (, found the end");
  CHECK(trouble("1 +") == "3: expected a number, a name, 'text' or (, found the end");
  CHECK(trouble("1 2") == "2: expected an operator or the end, found 2");
  CHECK(trouble("(1") == "2: expected ) to close (, found the end");
  CHECK(trouble("max(1, 2") == "8: expected ) or a comma, found the end");
  CHECK(trouble("true ? 1") == "8: expected : and what holds otherwise, found the end");
  CHECK(trouble("'abc") == "0: expected ' at the end of the text");
  CHECK(trouble("$size / 2") == "0: parameter names have no $ here: size / 2");
  CHECK(trouble("3px") == "0: expected an operator after the number; a unit is not written");
  CHECK(trouble("seed = 7") == "5: a comparison is written ==");
  CHECK(trouble("1 + wrong") == "4: no wrong");
  CHECK(trouble("1 + \xC3\xA4") == "4: expected a number, a name, 'text' or (, found \xC3\xA4");
}

TEST_CASE("hostile expressions are refused, not recursed into") {
  CHECK(trouble(std::string(5000, '(')).find("expected at most 60 parts within one another") != std::string::npos);
  CHECK(trouble(std::string(9000, '-') + "1").find("expected at most 60 parts") != std::string::npos);
  CHECK(trouble("1" + std::string(20000, ' ')).find("at most 10000 bytes") != std::string::npos);
  std::string sum = "1";
  for (int i = 0; i < 400; i++) sum += " + 1";
  CHECK(shown(sum) == "the number 401");
  for (int i = 0; i < 400; i++) sum += " + 1";
  CHECK(trouble(sum).find("at most 1000 parts") != std::string::npos);
}

TEST_CASE("which texts are expressions") {
  CHECK(is_expression("=1"));
  CHECK(is_expression("="));
  CHECK_FALSE(is_expression("==1"));
  CHECK_FALSE(is_expression("a=1"));
  CHECK_FALSE(is_expression(""));
}
