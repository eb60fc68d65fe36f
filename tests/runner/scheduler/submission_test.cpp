#include "runner/scheduler/submission.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "tests/runner/farm/tools.h"
#include "tests/runner/workplace.h"

using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

/// A graph of one unit, and a Slurm that takes what it is given and makes nothing of it.
struct Farm {
  Workplace w;
  Tools tools;

  Farm() {
    write_picture(w.path / "a.png", 1);
    write_text(w.path / "graph.json", R"({"terrazzo": 1, "nodes": {
      "a": {"type": "load_map", "path": "a.png"},
      "x": {"type": "export", "material": "@a", "path": "x.png"}}})");
    tools.add("scontrol", "echo 'Slurmctld(primary) at farm is UP'; echo 'MaxArraySize = 21'");
    tools.add("squeue", "true");
    tools.add("scancel", "true");
    tools.add("sinfo", "echo '4|16000|day*'");
    tools.add("sbatch", "echo >> submitted; echo 12");
  }
  std::string job() const { return FarmFolder(w.path / "cache").job_names().at(0); }
  size_t submitted() const { return tools.text("submitted").size(); }
  std::string state() const {
    const ProgramRun run = w.run({"submit", job(), "--status", "--json"});
    return nlohmann::json::parse(run.out).at("units").at(0).at("state").get<std::string>();
  }
};

}  // namespace

TEST_CASE("what is missing of a job of Slurm's is lost, and waiting hands it over again") {
  const Farm farm;
  CHECK(farm.w.run({"submit", "graph.json"}).code == 0);
  CHECK(farm.state() == "lost");
  const ProgramRun waited = farm.w.run({"submit", farm.job(), "--wait", "--retries", "1"});
  CHECK(waited.code == 1);
  CHECK(farm.submitted() == 2);
}

TEST_CASE("a cancelled job is that until it is submitted again") {
  const Farm farm;
  CHECK(farm.w.run({"submit", "graph.json"}).code == 0);
  CHECK(farm.w.run({"submit", farm.job(), "--cancel"}).code == 0);
  CHECK(farm.state() == "cancelled");
  const ProgramRun waited = farm.w.run({"submit", farm.job(), "--wait"});
  CHECK(waited.code == 1);
  CHECK(waited.out.find("1 cancelled") != std::string::npos);
  CHECK(farm.submitted() == 1);
  CHECK(farm.w.run({"submit", "graph.json"}).code == 0);
  CHECK(farm.submitted() == 2);
  CHECK(farm.state() == "lost");
}

TEST_CASE("a cancellation that ends nothing fails, and says so") {
  const Farm farm;
  CHECK(farm.w.run({"submit", "graph.json"}).code == 0);
  const fs::path arrays = FarmFolder(farm.w.path / "cache").jobs() / farm.job() / "arrays";
  const std::string id = fs::path(listing(arrays).front()).stem().string();
  farm.tools.add("squeue", "echo '12_0|0|PD|terrazzo:" + id + "||None|bob'");
  const ProgramRun run = farm.w.run({"submit", farm.job(), "--cancel"});
  CHECK(run.code == 1);
  CHECK(run.out.find("cancelled") == std::string::npos);
  CHECK_MESSAGE(run.err.find("is still in the queue after 10 seconds: 12_0 of bob") != std::string::npos, run.err);
}

TEST_CASE("what is ignored of the environment is said once, when something is handed over") {
  const Farm farm;
  const Environment account("SBATCH_ACCOUNT", "project"), wait("SBATCH_WAIT", "1");
  const ProgramRun run = farm.w.run({"submit", "graph.json"});
  CHECK(run.code == 0);
  CHECK_MESSAGE(
      run.err.find("warning: SBATCH_ACCOUNT, SBATCH_WAIT in the environment are ignored; ask with --partition, "
                   "--account, --time or --sbatch=OPTION") != std::string::npos,
      run.err);
  CHECK(farm.w.run({"submit", farm.job(), "--status"}).err.find("SBATCH_") == std::string::npos);
  CHECK(farm.w.run({"submit", "graph.json", "--sbatch=--array=0-5"}).code == 2);
}

TEST_CASE("what no node has is refused; what Slurm does not start is told") {
  const Farm farm;
  const ProgramRun refused = farm.w.run({"submit", "graph.json", "--cores", "64"});
  CHECK(refused.code == 2);
  CHECK(refused.err.find("the largest node that Slurm can give has 4 cores") != std::string::npos);
  CHECK(farm.w.run({"submit", "graph.json", "--memory", "20G"}).err.find("has 15.6 GiB") != std::string::npos);
  CHECK(farm.submitted() == 0);
  CHECK(farm.w.run({"submit", "graph.json", "--cores", "64", "--openjd", "template.json"}).code == 0);
  CHECK(farm.w.run({"submit", "graph.json", "--cores", "4"}).code == 0);
  const fs::path arrays = FarmFolder(farm.w.path / "cache").jobs() / farm.job() / "arrays";
  const std::string id = fs::path(listing(arrays).front()).stem().string();
  farm.tools.add("squeue", "echo '12_0|0|PD|terrazzo:" + id + "||PartitionConfig|ann'");
  CHECK(farm.w.run({"submit", "--status"}).out.find("1 waiting; Slurm does not start some of it: PartitionConfig") !=
        std::string::npos);
}

TEST_CASE("a job for another scheduler is not Slurm's to ask about, to cancel or to hand over again") {
  const Farm farm;
  farm.tools.add("squeue", "exit 1");
  CHECK(farm.w.run({"submit", "graph.json", "--openjd", "template.json"}).code == 0);
  CHECK(farm.state() == "elsewhere");
  const ProgramRun shown = farm.w.run({"submit", farm.job(), "--status"});
  CHECK(shown.code == 0);
  CHECK(shown.out.find("template.json for another scheduler") != std::string::npos);
  CHECK(farm.w.run({"submit", "--status"}).out.find("1 elsewhere") != std::string::npos);
  const ProgramRun cancelled = farm.w.run({"submit", farm.job(), "--cancel"});
  CHECK(cancelled.code == 2);
  CHECK(cancelled.err.find("cancel it there") != std::string::npos);

  // Waiting waits for the other scheduler.
  {
    StartedProgram waiting(farm.w.path, {"submit", farm.job(), "--wait"});
    REQUIRE(waiting.says("waiting until that has made it"));
    REQUIRE(waiting.says("1 elsewhere"));
    const TemporaryFolder worker;
    const fs::path folder = FarmFolder(farm.w.path / "cache").jobs() / farm.job();
    CHECK(run_program(worker.path(), {"task", folder.string(), "x"}).code == 0);
    CHECK(waiting.wait().code == 0);
  }
  CHECK(farm.submitted() == 0);
}

namespace {

/// Two pictures, the second of them cut off.
struct HalfAFarm : Farm {
  HalfAFarm() {
    write_picture(w.path / "b.png", 2);
    fs::resize_file(w.path / "b.png", fs::file_size(w.path / "b.png") - 40);
    write_text(w.path / "one.json",
               R"({"terrazzo": 1, "parameters": {"file": {"type": "path"}, "out": {"type": "path"}},
      "nodes": {
      "map": {"type": "load_map", "path": "$file"},
      "small": {"type": "resize", "material": "@map", "size": [8, 8]},
      "x": {"type": "export", "material": "@small", "path": "$out"}}})");
    std::string larger = read_text(w.path / "one.json");
    larger.replace(larger.find("[8, 8]"), 6, "\"=@map.size * 2\"");
    write_text(w.path / "larger.json", larger);
    write_text(w.path / "table.csv", "file,out\na.png,out/a.png\nb.png,out/b.png\n");
    write_text(w.path / "bad.csv", "file,out\nb.png,out/b.png\n");
  }
};

}  // namespace

TEST_CASE("with --keep-going a variation whose source is cut off is left out, and told of") {
  for (const char* graph : {"one.json", "larger.json"}) {
    CAPTURE(graph);
    const HalfAFarm farm;
    const std::vector<std::string> strict = {"submit", graph, "--table", "table.csv"};
    std::vector<std::string> going = strict, printed = strict;
    going.emplace_back("--keep-going");
    printed.insert(printed.end(), {"--keep-going", "--print"});
    CHECK(farm.w.run(strict).code == 2);
    CHECK_FALSE(fs::exists(farm.w.path / "cache/farm/jobs"));

    const ProgramRun scripts = farm.w.run(printed);
    CHECK(scripts.code == 1);
    CHECK(scripts.out.find("#SBATCH") != std::string::npos);
    CHECK_MESSAGE(scripts.err.find("left out: ") != std::string::npos, scripts.err);
    CHECK_MESSAGE(scripts.err.find("b.png: it is truncated") != std::string::npos, scripts.err);

    const ProgramRun submitted = farm.w.run(going);
    CHECK(submitted.code == 1);
    CHECK(farm.submitted() == 1);
    CHECK_MESSAGE(submitted.err.find("b.png: it is truncated") != std::string::npos, submitted.err);
    const nlohmann::json state = nlohmann::json::parse(farm.w.run({"submit", farm.job(), "--status", "--json"}).out);
    CHECK_FALSE(state.at("complete").get<bool>());
    CHECK(state.at("units").size() == 1);
    REQUIRE_FALSE(state.at("left_out").empty());
    CHECK(state.at("left_out").dump().find("it is truncated") != std::string::npos);

    // Made by hand: all that is in the job is done, and what is not in it is still missing.
    const fs::path folder = FarmFolder(farm.w.path / "cache").jobs() / farm.job();
    const std::string unit = state.at("units").at(0).at("name").get<std::string>();
    CHECK(farm.w.run({"task", folder.string(), unit}).code == 0);
    CHECK(listing(farm.w.path / "out") == std::vector<std::string>{"a.png"});
    const ProgramRun shown = farm.w.run({"submit", farm.job(), "--status"});
    CHECK(shown.code == 1);
    CHECK_MESSAGE(shown.out.find("1 of 1 done; ") != std::string::npos, shown.out);
    CHECK(shown.out.find("it is truncated") != std::string::npos);
    CHECK(farm.w.run({"submit", farm.job(), "--wait"}).code == 1);
    CHECK(farm.w.run(going).code == 1);
    CHECK(farm.submitted() == 1);

    // The sound variation alone is another job, which is complete.
    write_text(farm.w.path / "table.csv", "file,out\na.png,out/a.png\n");
    const ProgramRun alone = farm.w.run(going);
    CHECK(alone.code == 0);
    CHECK(alone.out.find("nothing to do") != std::string::npos);
  }
}

TEST_CASE("with --keep-going nothing is submitted where nothing can be made") {
  const HalfAFarm farm;
  const ProgramRun r = farm.w.run({"submit", "one.json", "--table", "bad.csv", "--keep-going"});
  CHECK(r.code == 1);
  CHECK_MESSAGE(r.err.find("it is truncated") != std::string::npos, r.err);
  CHECK_MESSAGE(r.err.find("nothing can be made without that") != std::string::npos, r.err);
  CHECK_FALSE(fs::exists(farm.w.path / "cache/farm/jobs"));
}
