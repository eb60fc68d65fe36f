#include <doctest/doctest.h>
#include <sys/stat.h>

#include "tests/runner/fakes.h"
#include "tests/runner/workplace.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

// A pipe that is opened to read keeps its reader waiting for a writer.
TEST_CASE("pipes and devices in the place of files are refused, and nothing waits for them") {
  const Workplace w;
  write_picture(w.path / "maps/stone_basecolor.png", 5);
  for (const char* name : {"pipe.png", "pipe.json", "maps/stone_normal.png", "maps/terrazzo-material.json"})
    REQUIRE(::mkfifo((w.path / name).c_str(), 0600) == 0);
  fs::create_symlink("/dev/zero", w.path / "zero.png");
  fs::create_symlink("/dev/zero", w.path / "zero.json");
  struct Refused {
    std::vector<std::string> args;
    std::string says;
  };
  const std::vector<Refused> all = {
      {{"run", "pipe.json"}, "expected a graph file, found a pipe; save it as a file first"},
      {{"run", "zero.json"}, "expected a graph file, found a device"},
      {{"check", "pipe.json"}, "found a pipe"},
      {{"run", "soft.json", "--params", "pipe.json"}, "found a pipe"},
      {{"run", "soft.json", "--set", "photo.path=pipe.png"}, "pipe.png: it is a pipe; expected an image file"},
      {{"run", "soft.json", "--set", "photo.path=zero.png"}, "zero.png: it is a device; expected an image file"},
      {{"synth", "maps", "-o", "out"}, "terrazzo-material.json"},
  };
  for (const Refused& r : all) {
    const ProgramRun run = w.run(r.args);
    CHECK(run.code == 2);
    CHECK_MESSAGE(contains(run.err, r.says), run.err);
  }
  fs::remove(w.path / "maps/terrazzo-material.json");
  const ProgramRun folder = w.run({"synth", "maps", "-o", "out"});
  CHECK(folder.code == 2);
  CHECK_MESSAGE(contains(folder.err, "stone_normal.png: it is a pipe; expected an image file"), folder.err);
}

TEST_CASE("a pipe in the place of a cache entry is a miss") {
  const Workplace w;
  REQUIRE(w.run({"run", "soft.json"}).code == 0);
  fs::remove_all(w.path / "out");
  std::vector<fs::path> files;
  for (const auto& e : fs::recursive_directory_iterator(w.path / "cache"))
    if (e.is_regular_file()) files.push_back(e.path());
  CHECK(files.size() > 3);
  for (const fs::path& file : files) {
    fs::remove(file);
    REQUIRE(::mkfifo(file.c_str(), 0600) == 0);
  }
  const ProgramRun run = w.run({"run", "soft.json"});
  CHECK_MESSAGE(run.code == 0, run.err);
  CHECK(fs::exists(w.path / "out/base_color.png"));
  for (const char* what : {"status", "verify", "gc", "clear"}) {
    const ProgramRun cache = w.run({"cache", what});
    CHECK_MESSAGE(cache.code <= 1, cache.err);
  }
}
