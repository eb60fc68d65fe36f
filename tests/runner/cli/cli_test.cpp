#include <csignal>
#include <cstdlib>
#include <sstream>

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/image_io/image_file.h"
#include "test_paths.h"
#include "tests/runner/fakes.h"
#include "tests/runner/program.h"
#include "tests/runner/workplace.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace fs = std::filesystem;

TEST_CASE("the program says its version and helps on standard output") {
  const Workplace w;
  const ProgramRun version = w.run({"--version"});
  CHECK(version.code == 0);
  CHECK(version.out.find("terrazzo ") == 0);
  for (const char* part : {"\nbuilt with ", "OpenImageIO 2.", "oneTBB 20", "plug-in interface "})
    CHECK_MESSAGE(version.out.find(part) != std::string::npos, part);
  const ProgramRun help = w.run({"--help"});
  CHECK(help.code == 0);
  for (const char* command :
       {"run", "synth", "new", "check", "upgrade", "draw", "nodes", "schema", "cache", "compare", "submit", "task"})
    CHECK_MESSAGE(help.out.find(std::string("  ") + command + " ") != std::string::npos, command);
  const ProgramRun run_help = w.run({"run", "--help"});
  CHECK(run_help.code == 0);
  CHECK(run_help.out.find("--dry-run") != std::string::npos);
}

TEST_CASE("a run that finds everything cached loads no image library") {
  const Workplace w;
  REQUIRE(w.run({"run", "soft.json"}).code == 0);
  ::setenv("LD_DEBUG", "files", 1);
  const ProgramRun again = w.run({"run", "soft.json"});
  ::unsetenv("LD_DEBUG");
  CHECK(again.code == 0);
  CHECK(again.err.find("libtbb") != std::string::npos);
  CHECK(again.err.find("OpenImageIO") == std::string::npos);
  CHECK(again.err.find("OpenColorIO") == std::string::npos);
}

TEST_CASE("wrong command lines are refused with code 2, a message that helps, and nothing written") {
  struct Wrong {
    std::vector<std::string> args;
    std::string says;
  };
  const std::vector<Wrong> all = {
      {{}, "A command is required"},
      {{"rnu"}, "unknown command rnu (did you mean \"run\"?)"},
      {{"run"}, "GRAPH is required"},
      {{"run", "soft.json", "--thread", "2"}, "unknown option --thread (did you mean \"--threads\"?)"},
      {{"run", "soft.json", "second.json"}, "unexpected argument second.json"},
      {{"run", "sofd.json"}, "did you mean \"soft.json\"?"},
      {{"run", "soft.json", "--threads", "0"}, "--threads"},
      {{"run", "soft.json", "--threads", "many"}, "--threads"},
      {{"run", "soft.json", "--memory", "2"}, "--memory takes a number with a unit"},
      {{"run", "soft.json", "--memory", "-2G"}, "--memory takes a number with a unit"},
      {{"run", "soft.json", "--progress", "loud"}, "--progress"},
      {{"run", "soft.json", "--cache", "c", "--no-cache"}, "--cache"},
      {{"run", "soft.json", "--cache", "photo.png"}, "--cache photo.png"},
      {{"run", "soft.json", "--set", "radius"}, "radius"},
      {{"run", "soft.json", "--set", "radios=2"}, "did you mean \"radius\"?"},
      {{"run", "soft.json", "--set", "radius=-2"}, "from 0"},
      {{"run", "soft.json", "--set", "soft.radios=2"}, "did you mean \"radius\"?"},
      {{"run", "soft.json", "--only", "sofd"}, "--only: there is no node \"sofd\" (did you mean \"soft\"?)"},
      {{"run", "soft.json", "--trace", "photo.png/t.json"},
       "--trace photo.png/t.json: expected a folder to write to, found the file photo.png"},
      {{"run", "soft.json", "--report", "photo.png/r.html"},
       "--report photo.png/r.html: expected a folder to write to, found the file photo.png"},
      {{"run", "soft.json", "--report", "r.txt"}, "--report takes a file that ends in .html; \"r.txt\" does not"},
      {{"run", "soft.json", "--report", "r.txt", "--dry-run"}, "--report takes a file that ends in .html"},
      {{"run", "soft.json", "--preset", "worn"}, "--preset worn: the graph has no preset of that name; it has none"},
      {{"run", "soft.json", "--params", "nowhere.json"}, "nowhere.json: there is no such settings file"},
      {{"run", "photo.png"}, "photo.png"},
      {{"check"}, "GRAPH is required"},
      {{"draw", "soft.json"}, "--out is required"},
      {{"draw", "soft.json", "-o", "graph.gif"}, "-o takes a file that ends in .svg or .dot"},
      {{"nodes", "blurr"}, "there is no node type \"blurr\" (did you mean \"blur\"?)"},
      {{"cache"}, "A subcommand is required"},
      {{"cache", "clean"}, "unknown command clean (did you mean \"clear\"?)"},
      {{"cache", "gc", "--limit", "lots"}, "--limit takes a number with a unit"},
      {{"synth"}, "FOLDER is required"},
      {{"synth", ".", "-o", "out", "--size", "big"}, "size"},
      {{"new", "."}, "--out is required"},
      {{"new", ".", "-o", "soft.json"}, "soft.json exists; --force overwrites it"},
      {{"compare", "photo.png"}, "OUTPUT is required"},
  };
  const Workplace w;
  for (const Wrong& wrong : all) {
    std::string line = "terrazzo";
    for (const std::string& a : wrong.args) line += " " + a;
    CAPTURE(line);
    const ProgramRun r = w.run(wrong.args);
    CHECK(r.code == 2);
    CHECK(r.out == "");
    CHECK_MESSAGE(r.err.find(wrong.says) != std::string::npos, r.err);
    CHECK(r.err.find("error: ") == 0);
    CHECK_FALSE(fs::exists(w.path / "out"));
  }
}

TEST_CASE("run writes the files, says what it did, and does nothing the second time") {
  const Workplace w;
  const ProgramRun first = w.run({"run", "soft.json"});
  CHECK_MESSAGE(first.code == 0, first.err);
  CHECK(first.out == "");
  CHECK(first.err.find("wrote " + (w.path / "out/base_color.png").string()) != std::string::npos);
  CHECK(first.err.find("3 stages: 0 cached, 3 run, ") != std::string::npos);
  CHECK(fs::exists(w.path / "out/base_color.png"));

  const ProgramRun plan = w.run({"run", "soft.json", "--dry-run"});
  CHECK(plan.code == 0);
  CHECK(plan.out.find("3 stages: 2 cached, 1 up to date\n") == 0);
  CHECK(plan.err == "");
  const ProgramRun second = w.run({"run", "soft.json"});
  CHECK(second.code == 0);
  CHECK(second.err.find("3 stages: 3 cached, 0 run, ") != std::string::npos);
  CHECK(second.err.find("wrote") == std::string::npos);
}

TEST_CASE("a changed parameter is named in the plan") {
  const Workplace w;
  REQUIRE(w.run({"run", "soft.json"}).code == 0);
  const ProgramRun plan = w.run({"run", "soft.json", "--set", "radius=3", "--dry-run"});
  CHECK_MESSAGE(plan.out.find("parameter radius changed from 2 to 3") != std::string::npos, plan.out);
}

TEST_CASE("the same bytes come out with and without cache, and on any number of threads") {
  const Workplace w;
  REQUIRE(w.run({"run", "soft.json"}).code == 0);
  const std::string expected = read_text(w.path / "out/base_color.png");
  for (const char* threads : {"1", "2", "4"}) {
    REQUIRE(w.run({"run", "soft.json", "--no-cache", "--threads", threads, "--set", "out=other"}).code == 0);
    CHECK(read_text(w.path / "other/base_color.png") == expected);
  }
}

TEST_CASE("a file that cannot be read ends a run with code 1, and names graph, place, node and parameter") {
  const Workplace w;
  std::string damaged = read_text(w.path / "photo.png");
  damaged.replace(damaged.size() / 2, 8, "no pixel");
  write_text(w.path / "photo.png", damaged);
  const ProgramRun r = w.run({"run", "soft.json"});
  CHECK(r.code == 1);
  CHECK(r.err.find("error: soft.json:6:5: node \"photo\" (load_map)") != std::string::npos);
  CHECK(r.err.find("photo.png") != std::string::npos);
  CHECK(r.err.find("3 stages: 0 cached, 0 run, 1 failed, 2 not run, ") != std::string::npos);
  CHECK_FALSE(fs::exists(w.path / "out"));
}

TEST_CASE("progress as json is an object per line, from the plan to the end") {
  const Workplace w;
  const ProgramRun r = w.run({"run", "soft.json", "--progress", "json"});
  CHECK(r.code == 0);
  std::vector<nlohmann::json> events;
  std::istringstream lines(r.err);
  for (std::string line; std::getline(lines, line);) events.push_back(nlohmann::json::parse(line));
  REQUIRE(events.size() >= 3);
  CHECK(events.front()["event"] == "plan");
  CHECK(events.front()["stages"].size() == 3);
  CHECK(events.front()["stages"][1]["size"] == nlohmann::json({32, 24}));
  CHECK(events.back()["event"] == "finished");
  CHECK(events.back()["ok"] == true);
  CHECK(events.back()["files"][0] == (w.path / "out/base_color.png").string());
}

TEST_CASE("with progress as json, warnings about the document are objects too") {
  const Workplace w;
  write_text(w.path / "idle.json", R"({
  "terrazzo": 1,
  "parameters": {"unused": {"type": "number", "default": 2}},
  "nodes": {
    "photo": {"type": "load_map", "path": "photo.png"},
    "files": {"type": "export", "material": "@photo", "path": "out/{map}.png"}
  }
})");
  const ProgramRun r = w.run({"run", "idle.json", "--progress", "json"});
  CHECK(r.code == 0);
  std::istringstream lines(r.err);
  std::string first;
  std::getline(lines, first);
  const nlohmann::json warning = nlohmann::json::parse(first);
  CHECK(warning["event"] == "warning");
  CHECK(warning["message"].get<std::string>().find("unused") != std::string::npos);
  CHECK(w.run({"run", "idle.json", "--progress", "plain"}).err.find("warning: ") == 0);
}

TEST_CASE("trace and report are written") {
  const Workplace w;
  const ProgramRun r = w.run({"run", "soft.json", "--trace", "t.json", "--report", "r.html"});
  CHECK_MESSAGE(r.code == 0, r.err);
  const nlohmann::json trace = nlohmann::json::parse(read_text(w.path / "t.json"));
  bool soft = false;
  for (const auto& e : trace["traceEvents"]) soft = soft || e["name"] == "soft";
  CHECK(soft);
  const std::string report = read_text(w.path / "r.html");
  CHECK(report.find("A blurred picture") != std::string::npos);
  CHECK(report.find("data:image/png;base64,iVBOR") != std::string::npos);
}

TEST_CASE("a trace or report that cannot be written is an error with the reason, after the run itself") {
  const Workplace w;
  for (const std::string option : {"--trace", "--report"}) {
    const ProgramRun r = w.run({"run", "soft.json", option, "/dev/full"});
    CHECK(r.code == 1);
    CHECK_MESSAGE(r.err.find("error: cannot write /dev/full: No space left on device") != std::string::npos, r.err);
    CHECK(fs::exists(w.path / "out/base_color.png"));
  }
}

TEST_CASE("a run whose messages nobody can receive does its work all the same") {
  const Workplace w;
  const auto code_of = [&](const std::string& messages) {
    fs::remove_all(w.path / "out");
    const std::string command = fmt::format("cd '{}' && {{ '{}' run soft.json --no-cache; echo $? > code; }} {}",
                                            w.path.string(), TERRAZZO_PROGRAM, messages);
    REQUIRE(std::system(command.c_str()) == 0);
    return read_text(w.path / "code");
  };
  CHECK(code_of("2>/dev/full") == "0\n");
  CHECK(listing(w.path / "out").size() == 1);
  CHECK(code_of("2>&-") == "0\n");
  CHECK(code_of("2>&1 | true") == "0\n");
  CHECK(listing(w.path / "out").size() == 1);
}

TEST_CASE("an interrupted run ends with code 130, leaves no file and a usable cache") {
  const Workplace w;
  write_picture(w.path / "maps/stone_basecolor.png", 5);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    StartedProgram program(w.path, {"synth", "maps", "-o", "out", "--size", "8192x8192", "--progress", "json"});
    REQUIRE(program.says("\"start\",\"node\":\"layout\""));
    program.signal(signal);
    const ProgramRun r = program.wait();
    CHECK(r.code == 130);
    CHECK(r.err.find("\"cancelled\":true") != std::string::npos);
    if (fs::exists(w.path / "out")) CHECK(listing(w.path / "out").empty());
    CHECK(w.run({"cache", "verify"}).code == 0);
  }
}

TEST_CASE("a damaged cache entry costs time, not the picture") {
  const Workplace w;
  REQUIRE(w.run({"run", "soft.json"}).code == 0);
  const std::string expected = read_text(w.path / "out/base_color.png");
  for (const fs::directory_entry& e : fs::recursive_directory_iterator(w.path / "cache")) {
    if (!e.is_regular_file() || e.file_size() == 0) continue;
    std::string bytes = read_text(e.path());
    bytes[bytes.size() / 2] = static_cast<char>(~bytes[bytes.size() / 2]);
    fs::permissions(e.path(), fs::perms::owner_write, fs::perm_options::add);
    write_text(e.path(), bytes);
  }
  fs::remove(w.path / "out/base_color.png");
  const ProgramRun r = w.run({"run", "soft.json"});
  CHECK_MESSAGE(r.code == 0, r.err);
  CHECK(read_text(w.path / "out/base_color.png") == expected);
}

TEST_CASE("check tells that a graph is valid and what it converts, without running it") {
  const Workplace w;
  const ProgramRun r = w.run({"check", "soft.json"});
  CHECK(r.code == 0);
  CHECK(r.out.find("soft.json is valid: 3 nodes, 2 parameters\n") != std::string::npos);
  CHECK(r.out.find("note: soft.json:8:") == 0);
  CHECK_FALSE(fs::exists(w.path / "out"));
}

TEST_CASE("check reports every problem of a graph at once") {
  const Workplace w;
  write_text(w.path / "bad.json", R"({"terrazzo": 1, "nodes": {
  "a": {"type": "blurr"},
  "b": {"type": "blur", "image": "@nowhere"}
}})");
  const ProgramRun r = w.run({"check", "bad.json"});
  CHECK(r.code == 2);
  CHECK(r.err.find("error: bad.json:2:") == 0);
  CHECK(r.err.find("\nerror: bad.json:3:") != std::string::npos);
}

TEST_CASE("upgrade rewrites a graph file, and a second time leaves it alone") {
  const Workplace w;
  const ProgramRun elsewhere = w.run({"upgrade", "soft.json", "-o", "new.json"});
  CHECK(elsewhere.code == 0);
  CHECK(w.run({"check", "new.json"}).code == 0);
  REQUIRE(w.run({"upgrade", "soft.json"}).code == 0);
  CHECK(read_text(w.path / "soft.json") == read_text(w.path / "new.json"));
  CHECK(w.run({"upgrade", "soft.json"}).err.find("soft.json is up to date") == 0);
}

TEST_CASE("draw writes a drawing") {
  const Workplace w;
  CHECK(w.run({"draw", "soft.json", "-o", "g.svg"}).code == 0);
  CHECK(read_text(w.path / "g.svg").find("<svg") != std::string::npos);
  CHECK(w.run({"draw", "soft.json", "-o", "g.dot"}).code == 0);
  CHECK(read_text(w.path / "g.dot").find("digraph") != std::string::npos);
}

TEST_CASE("nodes and schema describe what there is, for people and for programs") {
  const Workplace w;
  const ProgramRun list = w.run({"nodes"});
  CHECK(list.code == 0);
  CHECK(list.out.find("blur") != std::string::npos);
  CHECK(w.run({"nodes", "blur"}).out.find("radius") != std::string::npos);
  CHECK(w.run({"nodes", "compare"}).out.find("exemplar") != std::string::npos);
  const nlohmann::json one = nlohmann::json::parse(w.run({"nodes", "blur", "--json"}).out);
  REQUIRE(one.size() == 1);
  CHECK(one[0]["name"] == "blur");
  CHECK(nlohmann::json::parse(w.run({"nodes", "--json"}).out).size() > 20);
  CHECK(nlohmann::json::parse(w.run({"schema"}).out).contains("$schema"));
}

TEST_CASE("compare prints figures as a table or as json") {
  const Workplace w;
  write_picture(w.path / "other.png", 7);
  const ProgramRun table = w.run({"compare", "photo.png", "other.png"});
  CHECK_MESSAGE(table.code == 0, table.err);
  CHECK(table.out.find("  swd ") != std::string::npos);
  const ProgramRun json = w.run({"compare", "photo.png", "other.png", "--json"});
  CHECK(nlohmann::json::parse(json.out)["figures"][0]["name"] == "swd");
  for (const std::string sheet : {"sheets/s.png", "s.html"}) {
    const ProgramRun drawn = w.run({"compare", "photo.png", "other.png", "--sheet", sheet});
    CHECK_MESSAGE(drawn.code == 0, drawn.err);
    CHECK(drawn.out == table.out);
  }
  CHECK(read_image_info(w.path / "sheets/s.png").size == Size{6 + 32 + 6 + 32 + 6, 6 + 24 + 9 + 6});
  const std::string page = read_text(w.path / "s.html");
  CHECK(page.find("<td>swd</td>") != std::string::npos);
  CHECK(page.find("data:image/png;base64,iVBOR") != std::string::npos);
  CHECK(w.run({"compare", "photo.png", "other.png", "--sheet", "s.doc"}).code == 2);
  for (const std::string sheet : {"photo.png/s.html", "photo.png/s.png"}) {
    const ProgramRun refused = w.run({"compare", "photo.png", "other.png", "--sheet", sheet});
    CHECK(refused.code == 2);
    CHECK(refused.out == "");
    CHECK_MESSAGE(refused.err.find("photo.png") != std::string::npos, refused.err);
  }
  CHECK(w.run({"compare", "photo.png", "other.png", "--tileable", "x"}).out.find("wrap_seam_x") != std::string::npos);
  const ProgramRun missing = w.run({"compare", "photo.png", "gone.png"});
  CHECK(missing.code == 2);
  CHECK(missing.err.find("gone.png") != std::string::npos);
}

TEST_CASE("compare measures the layout too when it is given the uv map") {
  const Workplace w;
  std::vector<ExemplarPixel> pixels;
  for (int i = 0; i < 32 * 24; i++) pixels.push_back({uint16_t(i % 32), uint16_t(i / 32)});
  run_node("export", {{"uv_path", (w.path / "uv.png").string()}},
           {{"uv", {UvMap::make({32, 24}, {32, 24}, std::move(pixels))}}});
  const ProgramRun r = w.run({"compare", "photo.png", "photo.png", "--uv", "uv.png", "--json"});
  CHECK_MESSAGE(r.code == 0, r.err);
  std::map<std::string, double> figures;
  const nlohmann::json report = nlohmann::json::parse(r.out);
  for (const auto& f : report["figures"]) figures[f["name"]] = f["value"];
  CHECK(figures.at("seam_energy") == 0);
  CHECK(figures.at("usage_entropy") == doctest::Approx(1).epsilon(0.02));
  CHECK(figures.at("largest_copy") == 1);
}

TEST_CASE("new writes a commented graph that runs") {
  const Workplace w;
  write_picture(w.path / "maps/stone_basecolor.png", 5);
  fs::create_directories(w.path / "graphs");
  const ProgramRun r = w.run({"new", "maps", "-o", "graphs/stone.json"});
  CHECK_MESSAGE(r.code == 0, r.err);
  const std::string text = read_text(w.path / "graphs/stone.json");
  CHECK(text.find("\"default\": \"../maps\"") != std::string::npos);
  CHECK(text.find("//   base_color: 32x24, 3 channels") != std::string::npos);
  CHECK(w.run({"check", "graphs/stone.json"}).code == 0);
  const ProgramRun run = w.run({"run", "graphs/stone.json", "--set", "size=40x40", "--set", "out=big"});
  CHECK_MESSAGE(run.code == 0, run.err);
  CHECK(fs::exists(w.path / "big/base_color.png"));
  CHECK(w.run({"new", "nowhere", "-o", "x.json"}).code == 2);
}

TEST_CASE("watching runs the graph again when a file that it reads is touched") {
  const Workplace w;
  StartedProgram program(w.path, {"run", "soft.json", "--watch"});
  REQUIRE(program.says("watching 2 files"));
  fs::last_write_time(w.path / "photo.png", fs::last_write_time(w.path / "photo.png") + std::chrono::seconds(3));
  CHECK(program.says("3 stages: 3 cached, 0 run"));
  program.signal(SIGTERM);
  CHECK(program.wait().code == 0);
}
