#include <csignal>
#include <fstream>

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/file/file_io.h"
#include "test_paths.h"
#include "tests/runner/workplace.h"
#include "tests/texts.h"

/// Runs that nobody watches.
using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;
using Json = nlohmann::json;

namespace {

Json json_in(const fs::path& file) {
  std::ifstream in(file);
  REQUIRE(in);
  return Json::parse(in);
}

/// Two pictures, of which one turns out to be damaged only when it is read.
struct TwoBranches : Workplace {
  TwoBranches() {
    write_text(path / "two.json", R"({"terrazzo": 1, "nodes": {
  "good": {"type": "load_map", "path": "photo.png"},
  "bad": {"type": "load_map", "path": "bad.png"},
  "soft": {"type": "blur", "image": "@bad", "radius": 2},
  "soft_file": {"type": "export", "material": "@soft", "path": "out/soft_{map}.png"},
  "good_file": {"type": "export", "material": "@good", "path": "out/good_{map}.png"}
}})");
    write_picture(path / "bad.png", 5);
    std::fstream file(path / "bad.png", std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(int64_t(fs::file_size(path / "bad.png")) / 2);
    file << "not what was here before";
  }
};

/// That a value has the members that the schema lists, and no others; and so on for what it holds.
void check_members(const Json& value, const Json& schema, const std::string& where) {
  CAPTURE(where);
  if (value.is_array())
    for (const Json& item : value)
      if (schema.contains("items")) check_members(item, schema["items"], where + "[]");
  if (!value.is_object()) return;
  if (schema.contains("required"))
    for (const Json& name : schema["required"]) CHECK_MESSAGE(value.contains(name.get<std::string>()), name);
  if (!schema.contains("properties")) return;
  for (const auto& [name, member] : value.items()) {
    CHECK_MESSAGE(schema["properties"].contains(name), name);
    if (schema["properties"].contains(name)) check_members(member, schema["properties"][name], where + "." + name);
  }
}

void check_against_schema(const Json& summary) {
  check_members(summary, json_in(fs::path(TERRAZZO_SOURCE_DIR) / "examples/guide/summary.schema.json"), "summary");
}

const Json& stage_of(const Json& summary, const std::string& node) {
  for (const Json& s : summary["stages"])
    if (s["node"] == node) return s;
  FAIL("no stage " << node);
  return summary;
}

}  // namespace

TEST_CASE("with --keep-going the branch that is sound is made, and exit code and messages tell of the other one") {
  const TwoBranches w;
  const ProgramRun r = w.run({"run", "two.json", "--keep-going", "--summary", "sum.json"});
  REQUIRE_MESSAGE(r.code == 1, r.err);
  CHECK(listing(w.path / "out") == std::vector<std::string>{"good_base_color.png"});
  CHECK_MESSAGE(r.err.find("\nskipped, as \"bad\" failed: soft, soft_file\n") != std::string::npos, r.err);
  CHECK_MESSAGE(r.err.find("1 failed, 2 skipped because of that") != std::string::npos, r.err);
  const Json summary = json_in(w.path / "sum.json");
  check_against_schema(summary);
  CHECK(summary["status"] == "failed");
  CHECK(summary["exit_code"] == 1);
  CHECK(summary["counts"]["skipped"] == 2);
  CHECK(summary["failures"].size() == 1);
  CHECK(summary["failures"][0]["node"] == "bad");
  CHECK(stage_of(summary, "soft_file")["did"] == "skipped");
  CHECK(stage_of(summary, "soft_file")["because"] == "bad");
}

namespace {

/// Three pictures, the second of them cut off, and ways to make something of each.
struct ThreePictures : Workplace {
  ThreePictures() {
    for (const int i : {1, 2, 3}) write_picture(path / fmt::format("in/n{}.png", i), i);
    fs::resize_file(path / "in/n2.png", fs::file_size(path / "in/n2.png") - 40);
    write_text(path / "one.json", R"({"terrazzo": 1, "parameters": {"file": {"type": "path"}, "out": {"type": "path"}},
  "nodes": {
  "map": {"type": "load_map", "path": "$file"},
  "small": {"type": "resize", "material": "@map", "size": [8, 8]},
  "file": {"type": "export", "material": "@small", "path": "$out"}
}})");
    std::string larger = read_text(path / "one.json");
    larger.replace(larger.find("[8, 8]"), 6, "\"=@map.size * 2\"");
    write_text(path / "larger.json", larger);
    write_text(path / "all.json", R"({"terrazzo": 1, "nodes": {"all": {"type": "one.json",
  "foreach": {"files": "in/*.png", "as": "scan"}, "file": "$scan", "out": "out/$scan_name.png"}}})");
    write_text(path / "table.csv", "file,out\nin/n1.png,out/n1.png\nin/n2.png,out/n2.png\nin/n3.png,out/n3.png\n");
  }
  std::vector<std::string> made() const { return listing(path / "out"); }
};

const std::vector<std::string> first_and_third = {"n1.png", "n3.png"};

}  // namespace

TEST_CASE(
    "with --keep-going a source that is cut off fails the variations and iterations that need it, and no others") {
  const std::vector<std::string> jobs[] = {
      {"run", "one.json", "--table", "table.csv"}, {"run", "larger.json", "--table", "table.csv"}, {"run", "all.json"}};
  for (const std::vector<std::string>& job : jobs) {
    CAPTURE(job[1]);
    const ThreePictures w;
    const ProgramRun strict = w.run(job);
    CHECK(strict.code == 2);
    CHECK_FALSE(fs::exists(w.path / "out"));
    std::vector<std::string> going = job;
    going.insert(going.end(), {"--keep-going", "--summary", "sum.json", "--report", "report.html"});
    const ProgramRun r = w.run(going);
    CHECK_MESSAGE(r.code == 1, r.err);
    CHECK(w.made() == first_and_third);
    CHECK_MESSAGE(r.err.find("n2.png: it is truncated") != std::string::npos, r.err);
    const Json summary = json_in(w.path / "sum.json");
    check_against_schema(summary);
    CHECK(summary["status"] == "failed");
    REQUIRE(summary["failures"].size() == 1);
    CHECK(stage_of(summary, summary["failures"][0]["node"])["did"] == "failed");
    CHECK(summary["counts"]["not_run"] == 0);
    const std::string variation = job[1] == "all.json" ? "" : "file=in/n2.png, out=out/n2.png";
    CHECK(summary["failures"][0].value("variation", "") == variation);
    CHECK(stage_of(summary, summary["failures"][0]["node"]).value("variation", "") == variation);
  }
}

TEST_CASE("in the summary a stage has its variation, unless several share it") {
  const ThreePictures w;
  write_text(w.path / "table.csv", "file,out\nin/n1.png,out/a.png\nin/n1.png,out/b.png\n");
  REQUIRE(w.run({"run", "one.json", "--table", "table.csv", "--summary", "sum.json"}).code == 0);
  std::map<std::string, int> stages;
  const Json summary = json_in(w.path / "sum.json");
  for (const Json& s : summary["stages"]) stages[s.value("variation", "shared")]++;
  CHECK(stages == std::map<std::string, int>{
                      {"shared", 2}, {"file=in/n1.png, out=out/a.png", 1}, {"file=in/n1.png, out=out/b.png", 1}});
  write_text(w.path / "table.csv", "file,out\nin/n1.png,out/a.png\nin/n2.png,out/b.png\n");
  CHECK(w.run({"run", "one.json", "--table", "table.csv", "--summary", "sum.json"}).code == 2);
  const Json invalid = json_in(w.path / "sum.json");
  check_against_schema(invalid);
}

TEST_CASE("a source larger than may be read fails only what needs it, with --keep-going") {
  const ThreePictures w;
  write_picture(w.path / "in/n2.png", 2, Semantic::base_color, {300, 300});
  const ProgramRun r = w.run({"run", "all.json", "--max-pixels", "2000", "--keep-going"});
  CHECK_MESSAGE(r.code == 1, r.err);
  CHECK(w.made() == first_and_third);
}

TEST_CASE("with --keep-going files that two variations would write end the run before it begins") {
  const ThreePictures w;
  write_text(w.path / "table.csv", "file,out\nin/n1.png,out/n1.png\nin/n2.png,out/n2.png\nin/n3.png,out/n1.png\n");
  const ProgramRun r = w.run({"run", "one.json", "--table", "table.csv", "--keep-going"});
  CHECK_MESSAGE(r.code == 2, r.err);
  CHECK_FALSE(fs::exists(w.path / "out"));
}

TEST_CASE("the summary of a run has its files with digests, and of the next one that all was there") {
  const Workplace w;
  REQUIRE(w.run({"run", "soft.json", "--summary", "new/one.json"}).code == 0);
  REQUIRE(w.run({"run", "soft.json", "--summary", "two.json"}).code == 0);
  const Json one = json_in(w.path / "new/one.json"), two = json_in(w.path / "two.json");
  for (const Json& summary : {one, two}) {
    check_against_schema(summary);
    CHECK(summary["status"] == "done");
    const Json& file = stage_of(summary, "files")["files"][0];
    CHECK(file["bytes"] == fs::file_size(file["path"].get<std::string>()));
    CHECK(file["digest"].get<std::string>() == content_digest(fs::path(file["path"].get<std::string>()))->hex());
  }
  CHECK(stage_of(one, "files")["did"] == "run");
  CHECK(stage_of(two, "files")["did"] == "up to date");
  CHECK(stage_of(two, "files")["hit"] == true);
  CHECK(one["stages"].size() == two["stages"].size());
}

TEST_CASE("a summary is written of an invalid graph and of a run that is cancelled, too") {
  const Workplace w;
  CHECK(w.run({"run", "soft.json", "--summary", "sum.json", "--set", "photo.path=none.png"}).code == 2);
  const Json invalid = json_in(w.path / "sum.json");
  check_against_schema(invalid);
  CHECK(invalid["status"] == "invalid");
  CHECK(invalid["failures"][0]["node"] == "photo");

  write_picture(w.path / "maps/stone_basecolor.png", 5);
  StartedProgram program(
      w.path, {"synth", "maps", "-o", "out", "--size", "2048x2048", "--progress", "json", "--summary", "sum.json"});
  REQUIRE(program.says("\"start\",\"node\":\"layout\""));
  program.signal(SIGTERM);
  CHECK(program.wait().code == 130);
  const Json cancelled = json_in(w.path / "sum.json");
  check_against_schema(cancelled);
  CHECK(cancelled["status"] == "cancelled");
  CHECK(stage_of(cancelled, "layout")["did"] == "not run");
}

TEST_CASE("a summary that cannot be written is told before anything runs") {
  const Workplace w;
  write_text(w.path / "file", "");
  const ProgramRun r = w.run({"run", "soft.json", "--summary", "file/sum.json"});
  CHECK(r.code == 2);
  CHECK_MESSAGE(r.err.find("error: --summary file/sum.json: ") == 0, r.err);
}
