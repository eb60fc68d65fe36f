#include <filesystem>

#include <doctest/doctest.h>

#include "runner/api/job.h"
#include "tests/runner/workplace.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

const char* document = R"json({
  "terrazzo": 1,
  "parameters": {
    "seed": {"type": "int", "default": 1}, // which arrangement
    "file": {"type": "path", "default": "picture.png"}
  },
  "nodes": {
    "wide": {"type": "pattern", "kind": "bricks", "seed": "$seed", "size": [64, 64]}, // comment
    "soft": {"type": "no_such", "image": "@wide"}
  }
})json";

const JobNode& node(const JobOutline& outline, size_t at) {
  REQUIRE(outline.nodes.size() > at);
  return outline.nodes[at];
}

}  // namespace

TEST_CASE("an outline tells what a document declares, also if parts of it are wrong") {
  const JobOutline outline = Job::from_text(document).outline();
  REQUIRE(outline.parameters.size() == 2);
  CHECK(outline.parameters[0].param.name == "seed");
  CHECK(std::get<int64_t>(*outline.parameters[0].value) == 1);
  CHECK(node(outline, 0).type == "pattern");
  CHECK(node(outline, 0).is_known);
  CHECK(std::ranges::find(node(outline, 0).params, "kind", &Param::name) != node(outline, 0).params.end());
  CHECK(node(outline, 1).type == "no_such");
  CHECK(!node(outline, 1).is_known);
  CHECK(Job::from_text("{").outline().nodes.empty());
}

TEST_CASE("values are what was set last, else what the document says") {
  Job job = Job::from_text(document);
  CHECK(job.value_of("seed") == "1");
  CHECK(job.value_of("wide.kind") == "\"bricks\"");
  CHECK(!job.value_of("wide.help"));
  job.set("seed", int64_t{5}).set_text("seed", "=2 * 3").set_text("wide.size", "32x16");
  CHECK(job.value_of("seed") == "\"=2 * 3\"");
  CHECK(job.value_of("wide.size") == "\"32x16\"");
  job.unset("seed");
  CHECK(job.value_of("seed") == "1");
}

TEST_CASE("problems with values that have been set have pointers too") {
  Job job = Job::from_text(document);
  job.set_text("wide.size", "\"wide\"").set_text("seed", "[1]");
  std::vector<std::string> pointers;
  for (const Problem& p : job.check()) pointers.push_back(job.pointer_to(p));
  for (const char* expected : {"/nodes/soft/type", "/nodes/wide/size", "/parameters/seed/default"})
    CHECK_MESSAGE(std::ranges::find(pointers, expected) != pointers.end(), expected);
}

TEST_CASE("a check looks at the files that nodes will read") {
  const Workplace workplace;
  const Job good = Job::open(workplace.path / "soft.json");
  CHECK(good.check().empty());
  for (const auto& file : std::filesystem::directory_iterator(workplace.path))
    if (file.path().extension() == ".png") std::filesystem::remove(file.path());
  CHECK(!good.check().empty());
  CHECK(good.warnings().empty());
}

TEST_CASE("a document is written with the values that have been set, and nothing else changes") {
  Job job = Job::from_text(document, "/graphs/one.json");
  job.set_text("seed", "7").set_text("file", "sub/a.png").set_text("wide.size", "[8, 8]").set_text("wide.help", "1");
  std::string expected = document;
  const auto change = [&](const std::string& from, const std::string& to) {
    expected.replace(expected.find(from), from.size(), to);
  };
  change("\"default\": 1", "\"default\": 7");
  change("picture.png", "a.png");
  change("\"size\": [64, 64]", "\"size\": [8, 8], \"help\": 1");
  CHECK(job.text("sub") == expected);
  CHECK(job.text("elsewhere").find(std::filesystem::absolute("sub/a.png").string()) != std::string::npos);
  CHECK_THROWS_AS(Job::from_text(document).set_text("none", "1").text("."), Error);
  CHECK_THROWS_AS(Job::from_text(document).set_text("inner/node.seed", "1").text("."), Error);
}
