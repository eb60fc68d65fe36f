#include <chrono>
#include <csignal>
#include <sstream>
#include <thread>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "tests/runner/fakes.h"
#include "tests/runner/workplace.h"

using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

std::vector<nlohmann::json> events_of(const ProgramRun& run) {
  std::vector<nlohmann::json> events;
  std::istringstream lines(run.err);
  for (std::string line; std::getline(lines, line);) {
    CAPTURE(line);
    REQUIRE_NOTHROW(events.push_back(nlohmann::json::parse(line)));
  }
  return events;
}

}  // namespace

TEST_CASE("synth finds its mistakes before it runs, says which argument is wrong, and ends with code 2") {
  const Workplace w;
  write_picture(w.path / "maps/stone_basecolor.png", 5);
  fs::create_directories(w.path / "nothing");
  write_text(w.path / "file", "");
  struct Wrong {
    std::string folder, out, says;
  };
  const std::vector<Wrong> all = {
      {"mops", "out",
       "error: FOLDER: there is no folder or picture " + (w.path / "mops").string() + " (did you mean \"maps\"?)"},
      {"file", "out", "error: FOLDER: cannot read " + (w.path / "file").string()},
      {"nothing", "out", "error: FOLDER: no maps recognised in"},
      {"maps", "file", "error: -o: expected a folder to write to, found the file " + (w.path / "file").string()},
      {"maps", "/proc/x", "error: -o: cannot write into the folder /proc: "},
      {"maps", "file/deeper", "error: -o: expected a folder to write to, found the file " + (w.path / "file").string()},
  };
  for (const Wrong& wrong : all)
    for (const bool dry : {false, true}) {
      std::vector<std::string> args = {"synth", wrong.folder, "-o", wrong.out};
      if (dry) args.push_back("--dry-run");
      const ProgramRun r = w.run(args);
      CHECK(r.code == 2);
      CHECK(r.out == "");
      CHECK_MESSAGE(r.err.find(wrong.says) == 0, r.err);
    }
  CHECK_FALSE(fs::exists(w.path / "out"));
}

TEST_CASE("a run tells all that would fail before anything runs") {
  const Workplace w;
  write_text(w.path / "file", "");
  const ProgramRun r = w.run({"run", "soft.json", "--set", "photo.path=none.png", "--set", "out=file"});
  CHECK(r.code == 2);
  CHECK(r.err.find("error: soft.json:6:5: node \"photo\" (load_map): cannot read ") == 0);
  CHECK(
      r.err.find("error: soft.json:8:54: node \"files\" (export), parameter \"path\" (--set out): expected a folder") !=
      std::string::npos);
  CHECK(r.err.find("cached") == std::string::npos);
}

TEST_CASE("with progress as json, wrong command lines and wrong graphs are objects too") {
  const Workplace w;
  write_text(w.path / "bad.json", R"({"terrazzo": 1, "nodes": {
  "a": {"type": "blurr"},
  "b": {"type": "blur", "image": "@nowhere", "radius": -1}
}})");
  const ProgramRun graph = w.run({"run", "bad.json", "--progress", "json"});
  CHECK(graph.code == 2);
  const std::vector<nlohmann::json> problems = events_of(graph);
  REQUIRE(problems.size() == 3);
  for (const nlohmann::json& p : problems) {
    CHECK(p["event"] == "error");
    CHECK(p["file"] == "bad.json");
    CHECK(p["column"].get<int>() > 1);
  }
  CHECK(problems[0]["node"] == "a");
  CHECK(problems[0]["line"] == 2);
  CHECK(problems[0]["message"].get<std::string>().find("unknown node type \"blurr\"") != std::string::npos);
  CHECK(problems[1]["node"] == "b");
  CHECK(problems[1]["line"] == 3);
  CHECK(problems[2]["node"] == "b");

  const ProgramRun plan = w.run({"run", "soft.json", "--progress=json", "--set", "out=photo.png"});
  CHECK(plan.code == 2);
  REQUIRE(events_of(plan).size() == 1);
  CHECK(events_of(plan)[0]["node"] == "files");

  for (const std::vector<std::string>& args :
       {std::vector<std::string>{"run", "soft.json", "--progress", "json", "--thread", "2"},
        {"run", "soft.json", "--progress", "json", "--memory", "2"},
        {"run", "gone.json", "--progress", "json"},
        {"synth", "--progress", "json"}}) {
    const ProgramRun r = w.run(args);
    CHECK(r.code == 2);
    const std::vector<nlohmann::json> events = events_of(r);
    REQUIRE(events.size() == 1);
    CHECK(events[0]["event"] == "error");
    CHECK(events[0]["message"].get<std::string>() != "");
  }
}

TEST_CASE("watching with progress as json writes nothing else, and ends with the code of the last run") {
  const Workplace w;
  StartedProgram program(w.path, {"run", "soft.json", "--watch", "--progress", "json"});
  REQUIRE(program.says("{\"event\":\"watching\",\"files\":2}"));
  fs::remove(w.path / "photo.png");
  // Not before the run is over, which would be cancelled.
  REQUIRE(program.says("there is no such file\"}\n{\"event\":\"watching\""));
  program.signal(SIGINT);
  const ProgramRun r = program.wait();
  CHECK(r.code == 2);
  CHECK(events_of(r).size() > 5);
}

TEST_CASE("what a killed export leaves beside its target is gone after the next one") {
  const Workplace w;
  write_text(w.path / "large.json", R"({
  "terrazzo": 1,
  "parameters": {"size": {"type": "size", "default": 30000}},
  "nodes": {
    "photo": {"type": "load_map", "path": "photo.png"},
    "large": {"type": "resize", "material": "@photo", "size": "$size"},
    "files": {"type": "export", "material": "@large", "path": "out/{map}.png"}
  }
})");
  {
    StartedProgram program(w.path, {"run", "large.json", "--progress", "json"});
    REQUIRE(program.says("\"event\":\"progress\",\"node\":\"files\""));
    program.signal(SIGKILL);
    CHECK(program.wait().code == 128 + SIGKILL);
  }
  REQUIRE(listing(w.path / "out").size() == 1);
  CHECK(listing(w.path / "out")[0].starts_with(".base_color."));
  const ProgramRun r = w.run({"run", "large.json", "--set", "size=8"});
  CHECK_MESSAGE(r.code == 0, r.err);
  CHECK(listing(w.path / "out") == std::vector<std::string>{"base_color.png"});
}
