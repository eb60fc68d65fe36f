#include "runner/farm/submission.h"

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
  farm.tools.add("squeue", "echo '12_0|0|PD|terrazzo:" + id + "||PartitionConfig'");
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
