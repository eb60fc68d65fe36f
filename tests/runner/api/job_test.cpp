#include "runner/api/job.h"

#include <doctest/doctest.h>

#include "runner/api/session.h"
#include "tests/run_node.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

const char* noise_graph = R"({
  "terrazzo": 1,
  "parameters": {"seed": {"type": "int", "default": 1, "help": "of the noise"}, "out": {"type": "path"}},
  "presets": {"other": {"set": {"seed": 5}}},
  "nodes": {
    "noise": {"type": "noise", "size": 16, "seed": "$seed"},
    "file":  {"type": "export", "material": "@noise", "path": "$out/noise.png"}
  }
})";

const char* graph_with_input = R"({
  "terrazzo": 1,
  "inputs": {"surface": {"type": "image"}},
  "outputs": {"result": "@pale"},
  "nodes": {"pale": {"type": "levels", "image": "@surface", "out_black": [0.5]}}
})";

ImagePtr grey(float value) {
  return make_image(
      {4, 4}, 1, [=](int, int, int) { return value; }, Semantic::height);
}

float first_pixel(const RunResult& result, const std::string& node) {
  REQUIRE(result.ok());
  return std::get<ImagePtr>(result.kept.at(node).begin()->second)->read({0, 0, 1, 1})[0];
}

}  // namespace

TEST_CASE("a job tells its parameters, as they are set") {
  Job job = Job::from_text(noise_graph);
  std::vector<JobParameter> parameters = job.parameters();
  REQUIRE(parameters.size() == 2);
  CHECK(parameters[0].param.help == "of the noise");
  CHECK(*parameters[0].value == ParamValue(int64_t{1}));
  CHECK_FALSE(parameters[1].value);
  job.preset("other");
  CHECK(*job.parameters()[0].value == ParamValue(int64_t{5}));
  job.set("seed", int64_t{7});
  CHECK(*job.parameters()[0].value == ParamValue(int64_t{7}));
  job.set_text("seed", "=3 * 3");
  CHECK(*job.parameters()[0].value == ParamValue(int64_t{9}));
}

TEST_CASE("check finds what keeps a job from running, with the messages of the command line") {
  const TemporaryFolder folder;
  Job job = Job::from_text(noise_graph);
  REQUIRE(job.check().size() == 1);
  CHECK(contains(job.check()[0].message, "has no default and must be set"));
  job.set("out", (folder.path() / "out").string());
  CHECK(job.check().empty());
  job.set("sead", int64_t{1});
  REQUIRE(job.check().size() == 1);
  CHECK(contains(job.check()[0].message, "did you mean \"seed\"?"));
  CHECK_THROWS_AS(job.checked(), GraphError);
  CHECK(Job::from_text("{").check().size() == 1);
  CHECK_THROWS_AS(Job::open(folder.path() / "gone.json"), GraphError);
}

TEST_CASE("texts are set as they are, also those that look like JSON or numbers") {
  Job job = Job::from_text(R"({"terrazzo": 1, "parameters": {"name": {"type": "text", "default": ""}}, "nodes": {}})");
  for (const char* text : {"7", "true", "\"quoted\"", "[1]", "", "a b", "ä"}) {
    CAPTURE(text);
    CHECK(*job.set("name", std::string(text)).parameters()[0].value == ParamValue(std::string(text)));
  }
}

TEST_CASE("an input of the graph takes a value from memory") {
  Session session({.use_cache = false});
  Job job = Job::from_text(graph_with_input);
  REQUIRE(job.check().size() == 1);
  CHECK(contains(job.check()[0].message, "it is not connected"));
  job.give("surface", grey(0.5f));
  CHECK(job.check().empty());
  CHECK(first_pixel(session.run(job.checked(), {.keep = {"pale"}}), "pale") == doctest::Approx(0.75));
  job.give("surface", grey(1));
  CHECK(first_pixel(session.run(job.checked(), {.keep = {"pale"}}), "pale") == doctest::Approx(1));
}

TEST_CASE("a value from memory stands in for a node, and results are reused by its content") {
  const TemporaryFolder folder;
  Session session({.cache = folder.path() / "cache"});
  const auto runs = [&](const ImagePtr& given) {
    Job job = Job::from_text(noise_graph);
    job.set("out", (folder.path() / "out").string()).give("noise", given);
    const RunResult result = session.run(job.checked());
    REQUIRE(result.ok());
    return result.count(StageOutcome::Kind::run);
  };
  CHECK(runs(grey(0.25f)) == 2);
  CHECK(runs(grey(0.25f)) == 0);
  CHECK(runs(grey(0.75f)) == 2);
}

TEST_CASE("values that fit nowhere are refused") {
  const auto error = [](Job job, const std::string& name, Value value) {
    job.give(name, std::move(value));
    const std::vector<Problem> problems = job.check();
    return problems.empty() ? std::string() : problems[0].message;
  };
  Job noise = Job::from_text(noise_graph);
  noise.set("out", std::string("/tmp"));
  CHECK(contains(error(noise, "nose", grey(1)), "neither an input nor a node of the graph (did you mean \"noise\"?)"));
  CHECK(contains(error(noise, "noise", Material::of(grey(1))), "node \"noise\" gives image, and was given material"));
  CHECK(contains(error(noise, "file", grey(1)), "has 0 outputs"));
}
