#include <algorithm>
#include <set>

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "graphs/document/nodes.h"
#include "graphs/tools/reference.h"
#include "graphs/tools/schema.h"
#include "graphs/values/convert.h"
#include "tests/graphs/document/fake_types.h"

using namespace terrazzo;
using namespace terrazzo::test;
using nlohmann::json;

namespace {

size_t longest_line(const std::string& text) {
  size_t longest = 0, begin = 0;
  for (size_t end = text.find('\n'); end != text.npos; begin = end + 1, end = text.find('\n', begin))
    longest = std::max(longest, end - begin);
  return longest;
}

}  // namespace

TEST_CASE("every registered node type is soundly described") {
  const std::set<std::string> categories = {"source", "image", "analysis", "synthesis", "sink"};
  std::set<std::string> names;
  for (const NodeType& t : node_types()) {
    CAPTURE(t.name);
    CHECK(is_parameter_name(t.name));
    CHECK(names.insert(t.name).second);
    CHECK(categories.contains(t.category));
    CHECK_FALSE(t.summary.empty());
    CHECK(t.summary.find('\n') == t.summary.npos);
    CHECK(static_cast<bool>(t.compute));
    CHECK((t.is_sink() || !t.outputs.empty()));
    std::set<std::string> keys = {"type"};
    for (const Port& p : t.inputs) CHECK_MESSAGE(keys.insert(p.name).second, p.name);
    for (const Param& p : t.params) CHECK_MESSAGE(keys.insert(p.name).second, p.name);
  }
}

TEST_CASE("every default is a value that its parameter takes") {
  for (const NodeType& t : node_types()) {
    Params defaults;
    for (const Param& p : t.params) {
      CAPTURE(t.name);
      CAPTURE(p.name);
      CHECK_FALSE(p.help.empty());
      if (!p.fallback) continue;
      std::vector<Problem> problems;
      Diagnostics diagnostics(problems, "");
      const std::optional<ParamValue> value = read_param(json_of(*p.fallback), p, "/", diagnostics);
      if (!problems.empty()) FAIL_CHECK(problems.front().message);
      if (value && p.type != ParamType::path) CHECK(*value == *p.fallback);
      if (value) defaults.emplace(p.name, *value);
    }
    if (t.check && defaults.size() == t.params.size()) CHECK_MESSAGE(t.check(defaults).empty(), t.name);
  }
}

TEST_CASE("the schema describes every node type with its ports and parameters") {
  const json schema = json::parse(json_schema());
  CHECK(schema["$schema"] == "https://json-schema.org/draft/2020-12/schema");
  CHECK(schema["properties"]["terrazzo"]["const"] == 1);
  const json& names =
      schema["else"]["properties"]["nodes"]["additionalProperties"]["properties"]["type"]["anyOf"][0]["enum"];
  CHECK(names.size() == node_types().size());
  for (const NodeType& t : node_types()) {
    CAPTURE(t.name);
    CHECK(std::find(names.begin(), names.end(), t.name) != names.end());
    const json& node = schema["$defs"]["node_" + t.name];
    CHECK(node["properties"].size() == common_node_keys().size() + t.inputs.size() + t.params.size());
    CHECK(node["additionalProperties"] == false);
  }
}

TEST_CASE("prints the schema of the made-up types" * doctest::skip()) {
  fmt::print("{}", json_schema(fake_types()));  // tests/schema_test.py asks for it
}

TEST_CASE("the schema carries ranges, choices, defaults and what is required") {
  const json definitions = json::parse(json_schema(fake_types()))["$defs"];
  const json& adjust = definitions["node_adjust"];
  CHECK(adjust["required"] == json({"type", "image"}));
  const json& amount = adjust["properties"]["amount"];
  CHECK(amount["default"] == 0.5);
  CHECK(amount["anyOf"][0] == json({{"type", "number"}, {"minimum", 0.0}, {"maximum", 1.0}}));
  CHECK(amount["anyOf"][1]["$ref"] == "#/$defs/reference");
  CHECK(adjust["properties"]["size"]["description"] == "How large. (pixels)");
  CHECK(definitions["node_photo"]["properties"]["kind"]["anyOf"][0]["enum"] == json({"color", "normal", "height"}));
  const json& gather = definitions["node_gather"]["properties"];
  CHECK(gather["images"]["anyOf"][2]["minItems"] == 1);
  CHECK(gather["channels"]["anyOf"][0]["propertyNames"]["enum"] == json({"r", "g", "b", "a"}));
  CHECK(gather["names"]["anyOf"][0]["maxItems"] == 3);
}

TEST_CASE("every reference inside the schema leads somewhere") {
  const json schema = json::parse(json_schema(fake_types()));
  const json flat = schema.flatten();
  int references = 0;
  for (const auto& [pointer, value] : flat.items()) {
    if (!pointer.ends_with("/$ref")) continue;
    references++;
    CHECK_MESSAGE(schema.contains(json::json_pointer(value.get<std::string>().substr(1))), pointer);
  }
  CHECK(references > 10);
}

TEST_CASE("the reference of a node says all that its descriptor says") {
  CHECK(node_reference(fake_types()[0]) ==
        "photo: Reads a picture\n"
        "\n"
        "A made-up source. It reads one picture & says what it means, <nothing> more.\n"
        "\n"
        "Outputs\n"
        "  image: image\n"
        "      the picture\n"
        "\n"
        "Parameters\n"
        "  file: a path; must be given\n"
        "      The picture's file.\n"
        "  kind: one of color, normal, height; default \"color\"\n"
        "      What it shows.\n");
  const std::string gather = node_reference(fake_types()[2]);
  CHECK(gather.find("  images: list of image\n") != gather.npos);
  CHECK(gather.find("  extra: list of material, optional\n") != gather.npos);
  CHECK(gather.find("  weights: a list of 2 to 4 numbers from 0 to 10; default [1, 2]\n") != gather.npos);
}

TEST_CASE("references fit on 80 columns") {
  for (const NodeType& t : node_types()) {
    CAPTURE(t.name);
    CHECK(longest_line(node_reference(t)) <= 80);
  }
  CHECK(longest_line(node_list()) <= 80);
}

TEST_CASE("the list of nodes goes by category") {
  CHECK(node_list(fake_types()) ==
        "source\n  photo   Reads a picture\n\n"
        "image\n  adjust  Changes a picture\n\n"
        "analysis\n  gather  Gathers pictures into a material\n\n"
        "sink\n  write   Writes a material\n");
}

TEST_CASE("descriptors are there as JSON") {
  const json all = json::parse(nodes_json(fake_types()));
  REQUIRE(all.size() == 4);
  CHECK(all[1]["name"] == "adjust");
  CHECK(all[1]["inputs"][1] ==
        json({{"name", "mask"}, {"type", "image"}, {"help", "where"}, {"optional", true}, {"list", false}}));
  CHECK(all[1]["parameters"][2]["default"] == json({256, 128}));
  CHECK(all[1]["parameters"][2]["unit"] == "pixels");
  CHECK(all[2]["parameters"][3]["max_count"] == 4);
}
