#include <sstream>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>
#include <sys/resource.h>

#include "tests/runner/fakes.h"
#include "tests/runner/program.h"
#include "tests/runner/workplace.h"

using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

TEST_CASE("check finds what the plan of a run would refuse, once all parameters are set") {
  const Workplace w;
  write_text(w.path / "twice.json", R"({"terrazzo": 1, "nodes": {
    "photo": {"type": "load_map", "path": "photo.png"},
    "a": {"type": "export", "material": "@photo", "path": "out/a.png"},
    "b": {"type": "export", "material": "@photo", "path": "out/a.png"}}})");
  const ProgramRun twice = w.run({"check", "twice.json"});
  CHECK(twice.code == 2);
  CHECK_MESSAGE(twice.err.find("would be written twice") != std::string::npos, twice.err);
  write_text(w.path / "open.json", R"({"terrazzo": 1, "parameters": {"image": {"type": "path"}}, "nodes": {
    "photo": {"type": "load_map", "path": "$image"},
    "a": {"type": "export", "material": "@photo", "path": "out/a.png"}}})");
  const ProgramRun open = w.run({"check", "open.json"});
  CHECK_MESSAGE(open.code == 0, open.err);
  CHECK(open.err.find("--set image=VALUE") != std::string::npos);
  write_text(w.path / "half.json", R"({"terrazzo": 1, "parameters": {"image": {"type": "path"}}, "nodes": {
    "photo": {"type": "load_map", "path": "$image"},
    "gone": {"type": "load_map", "path": "gone.png"},
    "a": {"type": "export", "material": "@photo", "path": "out/a.png"}}})");
  const ProgramRun half = w.run({"check", "half.json"});
  CHECK(half.code == 2);
  CHECK_MESSAGE(half.err.find("half.json:3:5: node \"gone\"") != std::string::npos, half.err);
  CHECK(w.run({"check", "open.json", "--set", "image=gone.png"}).code == 2);
}

TEST_CASE("check marks what is no mistake as a note or a warning") {
  const Workplace w;
  write_text(w.path / "notes.json", R"({"terrazzo": 1, "parameters": {"image": {"type": "path"}}, "nodes": {
    "photo": {"type": "load_map", "path": "$image"},
    "idle": {"type": "blur", "image": "@photo"},
    "a": {"type": "export", "material": "@photo", "path": "out/a.png"}}})");
  const ProgramRun r = w.run({"check", "notes.json"});
  CHECK(r.code == 0);
  CHECK_MESSAGE(r.out ==
                    "note: notes.json:4:41: node \"a\", port \"material\": the image of \"@photo\" becomes a "
                    "material of one map\nnotes.json is valid: 3 nodes, 1 parameter\n",
                r.out);
  CHECK_MESSAGE(r.err ==
                    "warning: notes.json:3:5: node \"idle\": no sink reads it; it will not run\n"
                    "note: nodes that depend on an unset parameter were not checked: --set image=VALUE\n",
                r.err);
}

TEST_CASE("check tells what the document's text shows and what only its plan shows in one go") {
  const Workplace w;
  write_text(w.path / "wrong.json", R"({"terrazzo": 1, "nodes": {
    "gone": {"type": "load_map", "path": "gone.png"},
    "photo": {"type": "load_map", "path": "photo.png"},
    "soft": {"type": "blur", "image": "@photo", "radios": 2},
    "odd": {"type": "blurr", "image": "@photo"},
    "a": {"type": "export", "material": "@soft", "path": "out/a.png"},
    "b": {"type": "export", "material": "@photo", "path": "out/a.png"},
    "c": {"type": "export", "material": "@odd", "path": "out/a.png"},
    "d": {"type": "export", "material": "@gone", "path": "photo.png/d.png"}}})");
  for (const std::string command : {"check", "run"}) {
    const ProgramRun r = w.run({command, "wrong.json"});
    CHECK(r.code == 2);
    for (const char* part :
         {"wrong.json:2:5: node \"gone\" (load_map): cannot read", "wrong.json:4:49: node \"soft\": blur has no port",
          "wrong.json:5:21: node \"odd\": unknown node type",
          "wrong.json:7:51: node \"b\" (export), parameter \"path\"", "here and by the node \"a\"",
          "wrong.json:9:50: node \"d\" (export), parameter \"path\": expected a folder"})
      CHECK_MESSAGE(r.err.find(part) != std::string::npos, r.err);
    CHECK(std::count(r.err.begin(), r.err.end(), '\n') == 5);
  }
}

TEST_CASE("one mistake is said once: what follows an unknown command is that command's, and an image is no graph") {
  const Workplace w;
  CHECK(w.run({"synt", "tall", "-o", "out"}).err ==
        "error: unknown command synt (did you mean \"synth\"?)\n`terrazzo --help` says what it takes.\n");
  for (const std::string command : {"run", "check"})
    CHECK(w.run({command, "photo.png"}).err ==
          "error: photo.png: expected a graph file, found an image; graphs load images by their nodes\n");
}

TEST_CASE("what is left over behind an unknown option is not a mistake of its own") {
  const Workplace w;
  CHECK(w.run({"synth", "--qualty", "draft", "stone", "-o", "out"}).err ==
        "error: unknown option --qualty (did you mean \"--quality\"?)\n`terrazzo synth --help` says what it takes.\n");
  const ProgramRun two = w.run({"synth", "stone", "more", "--qualty", "draft", "--sied=3", "-o", "out"});
  CHECK_MESSAGE(two.err ==
                    "error: unexpected argument more\nunknown option --qualty (did you mean \"--quality\"?)\n"
                    "unknown option --sied=3 (did you mean \"--seed\"?)\n"
                    "`terrazzo synth --help` says what it takes.\n",
                two.err);
}

TEST_CASE("progress counts the stages that the summary of a failed run counts") {
  const Workplace w;
  write_text(w.path / "fails.json", R"({"terrazzo": 1, "nodes": {
    "photo": {"type": "load_map", "path": "photo.png"},
    "torn": {"type": "load_map", "path": "torn.png"},
    "a": {"type": "export", "material": "@torn", "path": "out/a.png"},
    "b": {"type": "export", "material": "@photo", "path": "out/b.png"}}})");
  write_picture(w.path / "torn.png", 5, Semantic::base_color, {256, 192});
  std::fstream torn(w.path / "torn.png", std::ios::in | std::ios::out | std::ios::binary);
  torn.seekp(int64_t(fs::file_size(w.path / "torn.png")) / 2);
  torn << "not what was here before";
  torn.close();
  const ProgramRun r = w.run({"run", "fails.json", "--progress", "plain"});
  CHECK_MESSAGE(r.code == 1, r.err);
  const size_t end = r.err.rfind(" stages: ");
  REQUIRE(end != std::string::npos);
  const std::string all = r.err.substr(r.err.rfind('\n', end) + 1, end - r.err.rfind('\n', end) - 1);
  CHECK_MESSAGE(r.err.find("/" + all + "] torn (load_map) failed") != std::string::npos, r.err);
}

TEST_CASE("a damaged picture puts nothing but json objects on standard error; a cut-off one is found before the run") {
  const Workplace w;
  const std::string whole = read_text(w.path / "photo.png");
  const auto code_for = [&](const std::string& bytes) {
    write_text(w.path / "photo.png", bytes);
    const ProgramRun r = w.run({"run", "soft.json", "--progress", "json"});
    std::istringstream lines(r.err);
    for (std::string line; std::getline(lines, line);) CHECK_MESSAGE(nlohmann::json::accept(line), line);
    return r.code;
  };
  CHECK(code_for(whole.substr(0, whole.size() - 60)) == 2);
  std::string damaged = whole;
  damaged[damaged.size() - 60] = char(damaged[damaged.size() - 60] ^ 0x55);
  CHECK(code_for(damaged) == 1);
}

TEST_CASE("new finds a folder again whose name holds what means something in documents") {
  const Workplace w;
  for (const std::string folder : {"a$b", "a$$b", "@maps", "@@maps", "${c}", "quoted \"x\" \\ y"}) {
    CAPTURE(folder);
    write_picture(w.path / folder / "stone_basecolor.png", 5);
    CHECK(w.run({"new", folder, "-o", "graph.json", "--force"}).code == 0);
    const ProgramRun r = w.run({"run", "graph.json", "--only", "exemplar"});
    CHECK_MESSAGE(r.code == 0, r.err);
  }
}

TEST_CASE("help on a command that does not exist is an error with a suggestion") {
  const Workplace w;
  const ProgramRun run = w.run({"chekc", "--help"});
  CHECK(run.code == 2);
  CHECK(run.out.empty());
  CHECK_MESSAGE(run.err.find("unknown command chekc (did you mean \"check\"?)") != std::string::npos, run.err);
  CHECK(w.run({"library", "lits", "--help"}).code == 2);
  CHECK(w.run({"library", "list", "--help"}).code == 0);
  CHECK(w.run({"run", "soft.json", "--help"}).code == 0);
}

TEST_CASE("control characters in names do not reach the terminal") {
  const Workplace w;
  const ProgramRun run = w.run({"run", "\x1b[31mred\x07.json"});
  CHECK(run.code == 2);
  CHECK_MESSAGE(run.err.find("\\x1b[31mred\\x07.json") != std::string::npos, run.err);
  CHECK(run.err.find('\x1b') == std::string::npos);
}

TEST_CASE("a file beyond the limit of the system is a failure, not the end of the program") {
  const Workplace w;
  write_text(w.path / "noise.json", R"({"terrazzo": 1, "nodes": {
    "noise": {"type": "noise", "size": 512},
    "file": {"type": "export", "material": "@noise", "path": "out/noise.png"}}})");
  rlimit before{};
  REQUIRE(::getrlimit(RLIMIT_FSIZE, &before) == 0);
  rlimit small = before;
  small.rlim_cur = 16384;
  ::setrlimit(RLIMIT_FSIZE, &small);
  const ProgramRun run = w.run({"run", "noise.json", "--no-cache"});
  ::setrlimit(RLIMIT_FSIZE, &before);
  CHECK(run.code == 1);
  CHECK_MESSAGE(run.err.find("File too large") != std::string::npos, run.err);
  CHECK_FALSE(fs::exists(w.path / "out/noise.png"));
}

TEST_CASE("images of more pixels than are allowed are refused before anything runs") {
  const Workplace w;
  const ProgramRun few = w.run({"run", "soft.json", "--max-pixels", "767"});
  CHECK(few.code == 2);
  CHECK_MESSAGE(
      few.err.find("its header says 32x24, 768 pixels; --max-pixels allows 767. Scale it down first, or allow "
                   "it with --max-pixels 768") != std::string::npos,
      few.err);
  CHECK_FALSE(fs::exists(w.path / "out"));
  CHECK(w.run({"run", "soft.json", "--max-pixels", "768"}).code == 0);
  for (const std::string wrong : {"10k", "0", "-1", "1.5"}) {
    const ProgramRun run = w.run({"run", "soft.json", "--max-pixels=" + wrong});
    CHECK(run.code == 2);
    CHECK_MESSAGE(run.err.find("--max-pixels: expected a number of pixels of at least 1, such as 100000000, found \"" +
                               wrong + "\"\n") != std::string::npos,
                  run.err);
  }
  CHECK(w.run({"run", "soft.json", "--threads", "1024"}).code == 0);
}
