#include <csignal>

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
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
  fs::path inputs() const { return FarmFolder::of_job(folder).inputs(); }
  /// The copy of a.png.
  fs::path input() const {
    for (const auto& entry : fs::recursive_directory_iterator(inputs()))
      if (entry.path().filename() == "a.png") return entry.path();
    FAIL("there is no copy");
    return {};
  }
  ProgramRun submit() const { return w.run({"submit", "graph.json", "--openjd", "template.json"}); }
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

TEST_CASE("version, plug-ins and colours must be those of the submission; submitting again takes those from here") {
  const Job job;
  // As another version would have frozen it: each of the keys matters, not only those of sources.
  for (const char* node : {"a", "index", "weighted", "slow"}) {
    CAPTURE(node);
    FarmJob other = read_farm_job(job.folder);
    REQUIRE(other.keys.contains(node));
    other.keys[node] = Hasher().add("other").digest();
    other.program = "terrazzo 0.0.1";
    CHECK(write_farm_job(other, job.folder));
    const ProgramRun run = job.task({"index"});
    CHECK(run.code == 1);
    CHECK_MESSAGE(run.err.find(std::string("node \"") + node + "\"") != std::string::npos, run.err);
    CHECK(run.err.find("has another key here than when terrazzo 0.0.1 froze it") != std::string::npos);
    const ProgramRun again = job.submit();
    CHECK(again.code == 0);
    CHECK_MESSAGE(again.err.find("job.json") != std::string::npos, again.err);
  }
  CHECK(job.task({"index"}).code == 0);
}

namespace {

void replace_in(const fs::path& file, const std::string& from, const std::string& to) {
  std::string text = read_text(file);
  REQUIRE(text.find(from) != std::string::npos);
  write_text(file, text.replace(text.find(from), from.size(), to));
}

/// As a disk that fails would: its size and time stay.
void alter_unseen(const fs::path& file) {
  const fs::file_time_type time = fs::last_write_time(file);
  std::string bytes = read_text(file);
  bytes[bytes.size() / 2] ^= 0x10;
  write_text(file, bytes);
  fs::last_write_time(file, time);
}

}  // namespace

TEST_CASE("a job that was damaged is refused by the name of the file, and mended by submitting again") {
  const Job job;
  CHECK(job.submit().err.find("mended") == std::string::npos);
  REQUIRE(job.task({"--list"}).code == 0);  // the cache remembers the inputs' digests now
  const std::string before = fmt::format("{}", fmt::join(listing(job.w.path), " "));
  struct Damage {
    const char* what;
    std::function<void()> act;
    std::string named;
  };
  const fs::path graph = job.folder / "graph.json", document = job.folder / "job.json", input = job.input();
  const std::string copy = "farm/inputs/" + input.lexically_relative(job.inputs()).string();
  const std::string original = "the job's copy of " + (job.w.path / "a.png").string();
  const Damage all[] = {
      {"another path", [&] { replace_in(graph, "x.exr", "z.exr"); }, graph.string() + " is not the graph"},
      {"another size", [&] { replace_in(graph, "[64, 64]", "[32, 32]"); }, graph.string() + " is not the graph"},
      {"a cut graph", [&] { fs::resize_file(graph, 100); }, graph.string() + " is not the graph"},
      {"no graph", [&] { fs::remove(graph); }, graph.string()},
      {"no job", [&] { fs::remove(document); }, document.string() + " is not a job of terrazzo"},
      {"a cut job", [&] { fs::resize_file(document, 200); }, document.string() + " is not a job of terrazzo"},
      {"an altered job", [&] { replace_in(document, "\"wanted\": true", "\"wanted\": false"); },
       document.string() + " is not a job of terrazzo"},
      {"another format", [&] { replace_in(document, "\"format\": 2", "\"format\": 1"); },
       document.string() + " is not a job of terrazzo"},
      {"a lost input", [&] { fs::remove(input); }, copy + ", " + original + ", has been lost"},
      {"a cut input", [&] { fs::resize_file(input, 50); }, copy + ", " + original + ", has been altered"},
      {"an altered input",
       [&] {
         write_picture(input, 7, Semantic::base_color, {96, 96});
       },
       copy + ", " + original + ", has been altered"},
      {"an input that looks unaltered", [&] { alter_unseen(input); }, copy + ", " + original + ", has been altered"},
      {"one input more", [&] { fs::copy_file(input, input.parent_path() / "b.png"); },
       "b.png is in the folder of the job's inputs"},
  };
  for (const Damage& damage : all) {
    CAPTURE(damage.what);
    damage.act();
    const ProgramRun run = job.task({"x"});
    CHECK(run.code == 1);
    CHECK_MESSAGE(run.err.find(damage.named) != std::string::npos, run.err);
    CHECK_MESSAGE(run.err.find("submit the same again") != std::string::npos, run.err);
    CHECK(fmt::format("{}", fmt::join(listing(job.w.path), " ")) == before);
    const ProgramRun again = job.submit();
    CHECK(again.code == 0);
    CHECK_MESSAGE(again.err.find("mended in ") != std::string::npos, again.err);
    CHECK(job.submit().err.find("mended") == std::string::npos);
  }
  CHECK(job.task({"x"}).code == 0);
  CHECK(job.states().at("x") == "done");
  CHECK_FALSE(fs::exists(job.w.path / "z.exr"));

  // Where all is made, the job is mended all the same.
  REQUIRE(job.task({"y"}).code == 0);
  fs::resize_file(document, 200);
  CHECK(job.w.run({"submit", "--status"}).code == 1);
  CHECK(job.submit().code == 0);
  CHECK(job.w.run({"submit", "--status"}).code == 0);
}

TEST_CASE("tasks of a damaged array, and a job that does not say whose it is") {
  const Job job;
  const fs::path array = job.folder / "arrays" / listing(job.folder / "arrays").front();
  replace_in(array, "[[\"", "[[\"y\",\"");
  const ProgramRun run = job.task({"--array", array.stem().string(), "--index", "0"});
  CHECK(run.code == 2);
  CHECK_MESSAGE(run.err.find("its file is damaged; submit the same again") != std::string::npos, run.err);
  CHECK(job.submit().code == 0);
  CHECK(job.task({"--array", array.stem().string(), "--index", "0"}).code == 0);

  write_text(job.folder / "assignment.json", "{");
  const ProgramRun shown = job.w.run({"submit", "--status"});
  CHECK(shown.code == 1);
  CHECK_MESSAGE(shown.out.find("assignment.json does not say who is to make the job") != std::string::npos, shown.out);
  CHECK(job.submit().code == 0);
  CHECK(job.states().at("y") == "elsewhere");
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
  CHECK(job.task({"x"}).err.find("not a job of terrazzo, or has been altered or damaged") != std::string::npos);
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
