#include <csignal>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "runner/farm/farm_folder.h"
#include "runner/farm/farm_job.h"
#include "tests/runner/workplace.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;
using Json = nlohmann::json;

namespace {

/// A job of two branches that share a slow node, frozen by the program itself.
struct Job {
  Workplace w;
  fs::path folder;

  Job() {
    write_picture(w.path / "a.png", 1, Semantic::base_color, {96, 96});
    write_text(w.path / "graph.json", R"({"terrazzo": 1, "nodes": {
      "a": {"type": "load_map", "path": "a.png"},
      "weighted": {"type": "weight", "material": "@a"},
      "slow": {"type": "pca", "features": "@weighted"},
      "index": {"type": "index", "appearance": "@slow"},
      "layout": {"type": "synthesize", "index": "@index", "size": [64, 64], "quality": "draft"},
      "other": {"type": "synthesize", "index": "@index", "size": [48, 48], "quality": "draft"},
      "x": {"type": "export", "uv": "@layout", "path": "x.exr"},
      "y": {"type": "export", "uv": "@other", "path": "y.exr"}}})");
    const ProgramRun made = w.run({"submit", "graph.json", "--openjd", "template.json"});
    REQUIRE_MESSAGE(made.code == 0, made.err);
    const auto names = FarmFolder(w.path / "cache").job_names();
    REQUIRE(names.size() == 1);
    folder = FarmFolder(w.path / "cache").jobs() / names.front();
  }
  ProgramRun task(std::vector<std::string> args) const {
    args.insert(args.begin(), {"task", folder.string()});
    return w.run(args);
  }
  std::map<std::string, std::string> states() const {
    std::map<std::string, std::string> out;
    const Json list = Json::parse(task({"--list"}).out);
    for (const Json& u : list.at("units")) out[u.at("name").get<std::string>()] = u.at("state").get<std::string>();
    return out;
  }
};

}  // namespace

TEST_CASE("a unit is made once; a stamp says what it is, whoever made it") {
  const Job job;
  CHECK(job.states() ==
        std::map<std::string, std::string>{{"index", "elsewhere"}, {"x", "elsewhere"}, {"y", "elsewhere"}});
  const ProgramRun first = job.task({"index", "--stamp", "index.json"});
  CHECK(first.code == 0);
  CHECK(first.err.find("index (index)") != std::string::npos);
  const std::string stamp = read_text(job.w.path / "index.json");
  CHECK(Json::parse(stamp).at("made").at("index").at("outputs").size() == 1);
  fs::remove(job.w.path / "index.json");
  const ProgramRun again = job.task({"index", "--stamp", "index.json"});
  CHECK(again.err.find("cached") != std::string::npos);
  CHECK(read_text(job.w.path / "index.json") == stamp);

  // What it needs and nobody has made, it makes itself, after some waiting; the originals are not missed.
  fs::remove(job.w.path / "a.png");
  CHECK(job.task({"x"}).code == 0);
  CHECK(fs::exists(job.w.path / "x.exr"));
  CHECK(job.states().at("x") == "done");
  CHECK(job.states().at("y") == "elsewhere");
  fs::remove(job.w.path / "x.exr");
  CHECK(job.states().at("x") == "elsewhere");
}

TEST_CASE("a unit that fails is noted, and those that need it say so") {
  const Job job;
  // The frozen input is damaged where nobody has a key for it yet.
  write_failure(job.folder, "index", {"it was too hard", 0});
  const ProgramRun run = job.task({"x"});
  CHECK(run.code == 1);
  CHECK(run.err.find("skipped, as \"index\" failed: it was too hard") != std::string::npos);
  CHECK(job.states().at("x") == "failed");
  CHECK(job.task({"index"}).code == 0);
  CHECK(job.task({"x"}).code == 0);
  CHECK(job.states().at("x") == "done");
}

TEST_CASE("a unit that cannot read an input names the user's file, not its copy") {
  const Workplace w;
  write_picture(w.path / "wall" / "wall_height.png", 1, Semantic::height, {96, 96});
  std::string bytes = read_text(w.path / "wall" / "wall_height.png");
  bytes[bytes.size() / 2] ^= 0x55;  // which only reading all of it finds
  write_text(w.path / "wall" / "wall_height.png", bytes);
  write_text(w.path / "graph.json", R"({"terrazzo": 1, "nodes": {
    "a": {"type": "load_material", "path": "wall"},
    "x": {"type": "export", "material": "@a", "path": "x/{map}.png"}}})");
  REQUIRE(w.run({"submit", "graph.json", "--openjd", "template.json"}).code == 0);
  const std::string job = FarmFolder(w.path / "cache").job_names().at(0);
  const std::string original = (w.path / "wall" / "wall_height.png").string();
  const ProgramRun run = w.run({"task", job, "x"});
  CHECK(run.code == 1);
  CHECK(run.err.find(original) != std::string::npos);
  CHECK(run.err.find("farm/inputs/") == std::string::npos);
  CHECK(w.run({"submit", job, "--status"}).out.find(original) != std::string::npos);
}

TEST_CASE("inputs, version and plug-ins must be those of the submission") {
  const Job job;
  for (const auto& entry : fs::recursive_directory_iterator(FarmFolder::of_job(job.folder).inputs()))
    if (entry.is_regular_file()) write_picture(entry.path(), 7, Semantic::base_color, {96, 96});
  const ProgramRun run = job.task({"index"});
  CHECK(run.code == 1);
  CHECK(run.err.find("has another key here") != std::string::npos);
}

TEST_CASE("wrong names of jobs, units and arrays") {
  const Job job;
  CHECK(job.task({}).code == 2);
  CHECK(job.task({"indx"}).err.find("did you mean \"index\"?") != std::string::npos);
  CHECK(job.task({"--array", "abc"}).code == 2);
  CHECK(job.task({"x", "y", "--stamp", "s.json"}).code == 2);
  const ProgramRun none = job.w.run({"task", "walls", "index"});
  CHECK(none.code == 2);
  CHECK(none.err.find("neither a graph file nor a job") != std::string::npos);
  write_text(job.folder / "job.json", "{}");
  CHECK(job.task({"x"}).err.find("no job of terrazzo, or damaged") != std::string::npos);
}

TEST_CASE("submit without Slurm says what is missing, and prints what it would do") {
  const Job job;
  const ProgramRun printed = job.w.run({"submit", "graph.json", "--print"});
  CHECK(printed.code == 0);
  CHECK(printed.out.find("#SBATCH --array=0-0") != std::string::npos);
  CHECK(printed.out.find("<job of array 1>") != std::string::npos);
  CHECK(job.w.run({"submit"}).code == 2);
  CHECK(job.w.run({"submit", "nothing.json"}).code == 2);
  const auto json = Json::parse(read_text(job.w.path / "template.json"));
  CHECK(json.at("steps").size() == 3);
  // The arrays of the template can be run.
  const auto& args = json.at("steps").at(0).at("script").at("actions").at("onRun").at("args");
  CHECK(job.task({"--array", args.at(3).get<std::string>(), "--index", "0"}).code == 0);
  CHECK(job.states().at("index") == "done");
  CHECK(job.task({"--array", args.at(3).get<std::string>(), "--index", "1"}).code == 2);
}
