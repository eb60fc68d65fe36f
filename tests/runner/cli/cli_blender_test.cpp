#include <filesystem>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "runner/cli/addon_files.h"
#include "test_paths.h"
#include "tests/runner/program.h"
#include "tests/runner/workplace.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace fs = std::filesystem;

TEST_CASE("blender-addon writes every file of the add-on, the same bytes each time") {
  const Workplace w;
  const ProgramRun run = w.run({"blender-addon", "-o", "new/addon.zip"});
  CHECK_MESSAGE(run.code == 0, run.err);
  REQUIRE(w.run({"blender-addon", "--out", "again.zip"}).code == 0);
  CHECK(read_text(w.path / "again.zip") == read_text(w.path / "new/addon.zip"));
  const std::string command = "cd '" + w.path.string() + "' && python3 -m zipfile -e again.zip unpacked";
  REQUIRE(std::system(command.c_str()) == 0);
  const fs::path source = fs::path(TERRAZZO_SOURCE_DIR) / "examples/blender/terrazzo_blender";
  size_t files = 0;
  for (const auto& entry : fs::directory_iterator(source)) {
    if (!entry.is_regular_file()) continue;
    files++;
    CAPTURE(entry.path());
    CHECK(read_text(w.path / "unpacked/terrazzo_blender" / entry.path().filename()) == read_text(entry.path()));
  }
  CHECK(files == addon_files().size());
  CHECK(read_text(w.path / "unpacked/terrazzo_blender/written_by.txt") ==
        fs::canonical(TERRAZZO_PROGRAM).string() + "\n");
  CHECK(files > 10);
}

TEST_CASE("the add-on has the program's version") {
  const Workplace w;
  const std::string version = w.run({"--version"}).out.substr(std::string("terrazzo ").size(), 5);
  std::string manifest, module;
  for (const AddonFile& file : addon_files()) {
    if (file.name == "blender_manifest.toml") manifest = file.text;
    if (file.name == "__init__.py") module = file.text;
  }
  CHECK(contains(manifest, fmt::format("version = \"{}\"", version)));
  CHECK(contains(module, fmt::format("\"version\": ({}, {}, {})", version[0], version[2], version[4])));
}

TEST_CASE("blender-addon replaces zip files, and nothing else without --force") {
  const Workplace w;
  CHECK(contains(w.run({"blender-addon", "-o", "addon"}).err, "expected a name that ends in .zip"));
  write_text(w.path / "mine.zip", "not one");
  const ProgramRun refused = w.run({"blender-addon", "-o", "mine.zip"});
  CHECK(refused.code == 2);
  CHECK(contains(refused.err, "zip file"));
  CHECK(read_text(w.path / "mine.zip") == "not one");
  CHECK(w.run({"blender-addon", "-o", "mine.zip", "--force"}).code == 0);
  CHECK(w.run({"blender-addon", "-o", "mine.zip"}).code == 0);
  CHECK(w.run({"blender-addon"}).code == 2);
}
