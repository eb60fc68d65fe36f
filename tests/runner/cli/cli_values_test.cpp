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

TEST_CASE("folders of reports, traces, drawings and new graphs are made") {
  const Workplace w;
  const ProgramRun run = w.run({"run", "soft.json", "--report", "a/b/r.html", "--trace", "c/t.json"});
  CHECK_MESSAGE(run.code == 0, run.err);
  CHECK(fs::exists(w.path / "a/b/r.html"));
  CHECK(fs::exists(w.path / "c/t.json"));
  CHECK(w.run({"draw", "soft.json", "-o", "d/e/soft.svg"}).code == 0);
  CHECK(fs::exists(w.path / "d/e/soft.svg"));
  CHECK(w.run({"run", "soft.json", "--report", "f/r.html", "--dry-run"}).code == 0);
  CHECK_FALSE(fs::exists(w.path / "f"));
}

TEST_CASE("values come from presets and settings files, and a graph's own help lists them") {
  const Workplace w;
  write_text(w.path / "soft.presets.json", R"({"strong": {"help": "much softer", "set": {"radius": 4}}})");
  write_text(w.path / "other.json", R"({"radius": "=2 * 4", "out": "from-file"})");
  const ProgramRun help = w.run({"run", "soft.json", "--help"});
  CHECK(help.code == 0);
  CHECK(help.out.find("  radius: ") != std::string::npos);
  CHECK(help.out.find("  strong: much softer\n      sets radius\n") != std::string::npos);
  CHECK(help.out.find("--preset NAME") != std::string::npos);
  CHECK(w.run({"run", "nowhere.json", "--help"}).code == 2);
  CHECK(w.run({"run", "--help"}).code == 0);
  const ProgramRun run = w.run({"run", "soft.json", "--preset", "strong", "--params", "other.json"});
  CHECK_MESSAGE(run.code == 0, run.err);
  CHECK(fs::exists(w.path / "from-file/base_color.png"));
  CHECK(w.run({"check", "soft.json", "--preset", "stong"}).err.find("did you mean \"strong\"?") != std::string::npos);
}

TEST_CASE("watching sees a source that vanishes come back") {
  const Workplace w;
  StartedProgram program(w.path, {"run", "soft.json", "--watch"});
  REQUIRE(program.says("watching 2 files"));
  const std::string photo = read_text(w.path / "photo.png");
  fs::remove(w.path / "photo.png");
  REQUIRE(program.says("there is no such file"));
  write_text(w.path / "photo.png", photo);
  CHECK(program.says("3 stages: 3 cached, 0 run"));
  program.signal(SIGTERM);
  CHECK(program.wait().code == 0);
}

TEST_CASE("a sweep runs all variations, shares what is the same, and picks the best") {
  const Workplace w;
  const ProgramRun twice = w.run({"run", "soft.json", "--sweep", "radius=1..3"});
  CHECK(twice.code == 2);
  CHECK_MESSAGE(twice.err.find("/out/{map}.png for radius=1 and for radius=2; let its path tell them apart, as --set "
                               "\"out=='out/' + radius\" does") != std::string::npos,
                twice.err);
  CHECK(
      w.run({"run", "soft.json", "--sweep", "photo.semantic=height,mask"})
          .err.find("a path can tell them apart only by parameters of the graph: declare one for \"photo.semantic\"") !=
      std::string::npos);
  const std::vector<std::string> sweep = {"run",         "soft.json", "--sweep",
                                          "radius=1..3", "--set",     "out=='out/' + radius"};
  const auto with = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all = sweep;
    all.insert(all.end(), more.begin(), more.end());
    return w.run(all);
  };
  const ProgramRun run = with({"--sheet", "sheets/all.png"});
  CHECK_MESSAGE(run.code == 0, run.err);
  for (const char* file : {"out/1/base_color.png", "out/2/base_color.png", "out/3/base_color.png", "sheets/all.png"})
    CHECK(fs::exists(w.path / file));
  CHECK(read_text(w.path / "out/1/base_color.png") != read_text(w.path / "out/3/base_color.png"));
  CHECK(with({"--sheet", "all.html"}).code == 0);
  CHECK(read_text(w.path / "all.html").find("radius=2") != std::string::npos);
  CHECK(with({"--best", "swd"}).err.find("need a compare node") != std::string::npos);
  CHECK(with({"--sheet", "all.xyz"}).code == 2);
  CHECK(w.run({"run", "soft.json", "--sheet", "x.png"}).err.find("go with --sweep or --table") != std::string::npos);
  CHECK(w.run({"run", "soft.json", "--sweep", "radios=1,2"}).err.find("did you mean \"radius\"?") != std::string::npos);
}

TEST_CASE("figures of variations become a table") {
  const Workplace w;
  write_text(w.path / "stones.json", R"({"terrazzo": 1,
  "parameters": {"seed": {"type": "int", "default": 1}, "size": {"type": "size", "default": 96}},
  "nodes": {
    "exemplar": {"type": "pattern", "kind": "gravel", "size": 64},
    "weighted": {"type": "weight", "material": "@exemplar"},
    "space": {"type": "pca", "features": "@weighted"},
    "index": {"type": "index", "appearance": "@space"},
    "layout": {"type": "synthesize", "index": "@index", "size": "$size", "seed": "$seed",
               "quality": "draft"},
    "result": {"type": "resolve_uv", "uv": "@layout", "material": "@exemplar"},
    "files": {"type": "export", "material": "@result", "path": "='stones-' + seed + '/{map}.png'"}}})");
  const ProgramRun run =
      w.run({"run", "stones.json", "--sweep", "seed=1..3", "--figures", "f.csv", "--best", "swd", "--sheet", "s.png"});
  CHECK_MESSAGE(run.code == 0, run.err);
  const std::string table = read_text(w.path / "f.csv");
  CHECK(table.starts_with("seed,swd,cooccurrence,"));
  CHECK(std::ranges::count(table, '\n') == 4);
  // The named one has the least of the column.
  std::vector<double> swd;
  std::istringstream lines(table);
  std::string line;
  for (std::getline(lines, line); std::getline(lines, line);) swd.push_back(std::stod(line.substr(line.find(',') + 1)));
  const auto least = std::ranges::min_element(swd) - swd.begin();
  CHECK(run.out.find(fmt::format("best by swd: seed={} (", least + 1)) != std::string::npos);
  CHECK(fs::exists(w.path / "stones-3/height.png"));
  const ProgramRun worst = w.run({"run", "stones.json", "--sweep", "seed=1..3", "--best", "swd:max"});
  const auto most = std::ranges::max_element(swd) - swd.begin();
  CHECK(worst.out.find(fmt::format("best by swd: seed={} (", most + 1)) != std::string::npos);
  // One analysis serves all.
  CHECK(worst.err.find("space [") == std::string::npos);
  CHECK(w.run({"run", "stones.json", "--sweep", "seed=1,2", "--sweep", "size=80,96", "--dry-run"})
            .err.find("'out/' + seed + '-' + size\"") != std::string::npos);
  CHECK(w.run({"run", "stones.json", "--sweep", "seed=1..2", "--set", "size=96x32", "--sheet", "flat.png"}).code == 0);
  CHECK(read_image_info(w.path / "flat.png").size == Size{8 + 2 * 264, 8 + 256 + 18 + 8});
  // Found before anything runs: no stage is told of.
  for (const auto& [figure, answer] : {std::pair("swdd", "no such figure (did you mean \"swd\"?)"),
                                       std::pair("wrap_seam_x", "which way is better? wrap_seam_x:min or")}) {
    const ProgramRun wrong = w.run({"run", "stones.json", "--sweep", "seed=11,12", "--best", figure});
    CHECK(wrong.code == 2);
    CHECK_MESSAGE(wrong.err.find(answer) != std::string::npos, wrong.err);
    CHECK(std::ranges::count(wrong.err, '\n') == 1);
  }
  const ProgramRun even = w.run({"run", "stones.json", "--sweep", "seed=1..3", "--best", "usage_entropy"});
  CHECK(even.out.find("best by usage_entropy: ") != std::string::npos);
  write_text(w.path / "t.csv", "seed\n5\n6\n");
  CHECK(w.run({"run", "stones.json", "--table", "t.csv", "--only", "layout"}).code == 0);
  CHECK(w.run({"run", "stones.json", "--table", "none.csv"}).code == 2);
}
