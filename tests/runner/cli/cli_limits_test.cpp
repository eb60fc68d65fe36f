#include <chrono>
#include <cstdlib>
#include <filesystem>

#include <doctest/doctest.h>

#include "tests/runner/fakes.h"
#include "tests/runner/workplace.h"

/// How much commands may take: --memory, --max-pixels, --max-bytes.
using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool is_sanitized = true;
#else
constexpr bool is_sanitized = false;
#endif

bool says(const ProgramRun& run, const std::string& text) {
  return (run.out + run.err).find(text) != std::string::npos;
}

}  // namespace

TEST_CASE("every command that reads images takes limits on them") {
  const Workplace w;
  const Size size{160, 128};
  write_picture(w.path / "photo.png", 37, Semantic::base_color, size);
  write_picture(w.path / "maps/base_color.png", 1, Semantic::base_color, size);
  write_picture(w.path / "maps/height.png", 2, Semantic::height, size);
  REQUIRE(fs::file_size(w.path / "photo.png") > 1024);
  const std::vector<std::vector<std::string>> commands = {
      {"run", "soft.json"},        {"synth", "maps", "-o", "made"},   {"check", "soft.json"},
      {"compare", "maps", "maps"}, {"new", "maps", "-o", "new.json"}, {"library", "add", "wall", "maps"},
  };
  for (std::vector<std::string> command : commands) {
    CAPTURE(command[0]);
    command.insert(command.end(), {"--max-pixels", "767"});
    const ProgramRun pixels = w.run(command);
    CHECK(pixels.code == 2);
    CHECK_MESSAGE(says(pixels, "--max-pixels allows 767"), pixels.err);
    command[command.size() - 2] = "--max-bytes";
    command.back() = "1K";
    const ProgramRun bytes = w.run(command);
    CHECK(bytes.code == 2);
    CHECK_MESSAGE(says(bytes, "at most 1.0 KiB are read, as --max-bytes says"), bytes.err);
  }
  CHECK_FALSE(fs::exists(w.path / "out"));
}

TEST_CASE("a file of gigabytes is refused before any of it is read") {
  const Workplace w;
  write_text(w.path / "huge.jpg", std::string("\xff\xd8\xff\xe0\x00\x04", 6));
  fs::resize_file(w.path / "huge.jpg", uintmax_t{3} << 30);
  write_text(w.path / "huge.json", R"({"terrazzo": 1, "nodes": {
    "map": {"type": "load_map", "path": "huge.jpg"},
    "file": {"type": "export", "material": "@map", "path": "out/map.png"}}})");
  const auto start = std::chrono::steady_clock::now();
  const ProgramRun run = w.run({"check", "huge.json", "--memory", "1G"});
  CHECK(run.code == 2);
  CHECK_MESSAGE(says(run, "the file has 3221225472 bytes"), run.err);
  // Reading it took 22 s, on a quiet machine.
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(8));
}

TEST_CASE("the process stays within the budget, and the result does not depend on it") {
  const Workplace w;
  for (const auto& [name, semantic] :
       {std::pair("base_color", Semantic::base_color), std::pair("height", Semantic::height)})
    write_picture(w.path / "maps" / (std::string(name) + ".png"), 7, semantic, {2048, 2048});
  write_text(w.path / "small.json", R"({"terrazzo": 1, "parameters": {"out": {"type": "path"}}, "nodes": {
    "maps":    {"type": "load_material", "path": "maps"},
    "colour":  {"type": "get_map", "material": "@maps", "map": "base_color"},
    "lighter": {"type": "levels", "image": "@colour", "gamma": 1.2},
    "smaller": {"type": "resize", "material": "@lighter", "size": 512},
    "copies":  {"type": "export", "material": "@maps", "path": "$out/{map}.png"},
    "files":   {"type": "export", "material": "@smaller", "path": "$out/small.png"}}})");
  REQUIRE(w.run({"run", "small.json", "--no-cache", "--set", "out=usual"}).code == 0);
  constexpr long budget_mib = 16, most_mib = budget_mib * 12 / 10 + 50;
  StartedProgram program(w.path, {"run", "small.json", "--no-cache", "--set", "out=bounded", "--memory", "16M"});
  const long peak_kib = program.watch_memory();
  const ProgramRun bounded = program.wait();
  CHECK_MESSAGE(bounded.code == 0, bounded.err);
  for (const char* name : {"base_color.png", "height.png", "small.png"})
    CHECK(read_text(w.path / "usual" / name) == read_text(w.path / "bounded" / name));
  if (is_sanitized) return;
  CHECK(peak_kib > 0);
  CHECK(peak_kib / 1024 <= most_mib);
}

TEST_CASE("an analysis that needs more than the budget is refused with what it needs") {
  const Workplace w;
  write_text(w.path / "large.json", R"({"terrazzo": 1, "nodes": {
    "maps":  {"type": "pattern", "kind": "bricks", "size": 1024},
    "weighted": {"type": "weight", "material": "@maps"},
    "space": {"type": "pca", "features": "@weighted"},
    "index": {"type": "index", "appearance": "@space"},
    "file":  {"type": "save_analysis", "index": "@index", "path": "a.terrazzo"}}})");
  const ProgramRun run = w.run({"run", "large.json", "--memory", "64M"});
  CHECK(run.code == 2);
  CHECK_MESSAGE(says(run, "node \"space\" (pca): it takes about"), run.err);
  CHECK_MESSAGE(says(run, "and --memory gives 64 MiB. Give --memory 1"), run.err);
  CHECK(w.run({"check", "large.json", "--memory", "64M"}).code == 2);
  CHECK(w.run({"check", "large.json", "--memory", "256M"}).code == 0);
  write_text(w.path / "made.json", R"({"terrazzo": 1, "nodes": {
    "maps":  {"type": "pattern", "kind": "bricks", "size": 128},
    "weighted": {"type": "weight", "material": "@maps"},
    "space": {"type": "pca", "features": "@weighted"},
    "index": {"type": "index", "appearance": "@space"},
    "layout": {"type": "synthesize", "index": "@index", "size": 8192},
    "file":  {"type": "export", "uv": "@layout", "uv_path": "uv.exr"}}})");
  const ProgramRun made = w.run({"check", "made.json", "--memory", "64M"});
  CHECK(made.code == 2);
  CHECK_MESSAGE(says(made, "node \"layout\" (synthesize): it takes about"), made.err);
}

TEST_CASE("maps that are made on demand are refused too, unless nothing asks for them") {
  const Workplace w;
  write_text(w.path / "made.json", R"({"terrazzo": 1, "nodes": {
    "maps":  {"type": "pattern", "kind": "bricks", "size": 256},
    "weighted": {"type": "weight", "material": "@maps"},
    "space": {"type": "pca", "features": "@weighted"},
    "index": {"type": "index", "appearance": "@space"},
    "layout": {"type": "synthesize", "index": "@index", "size": 64, "quality": "draft"},
    "result": {"type": "resolve_uv", "uv": "@layout", "material": "@maps", "blend": 2},
    "files": {"type": "export", "material": "@result", "path": "out/{map}.png"}}})");
  REQUIRE(w.run({"run", "made.json"}).code == 0);
  CHECK(w.run({"run", "made.json", "--memory", "4M"}).code == 0);
  fs::remove_all(w.path / "out");
  const ProgramRun run = w.run({"run", "made.json", "--memory", "4M"});
  CHECK(run.code == 2);
  CHECK_MESSAGE(says(run, "node \"result\" (resolve_uv): it takes about 7 MiB"), run.err);
}
