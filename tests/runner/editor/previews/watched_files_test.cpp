#include "runner/editor/previews/watched_files.h"

#include <chrono>
#include <filesystem>

#include <doctest/doctest.h>

#include "tests/run_node.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace fs = std::filesystem;

TEST_CASE("files that a graph reads are watched, also those that are missing") {
  const TemporaryFolder folder, outside;
  const fs::path document = folder.path() / "graph.json", map = folder.path() / "map.pgm";
  const std::string secret = (outside.path() / "secret.pgm").string();
  const std::string text = R"({"terrazzo": 1, "nodes": {"map": {"type": "load_map", "path": "map.pgm"},
    "other": {"type": "load_map", "path": ")" +
                           secret + R"("}}})";
  const Sandbox sandbox(folder.path());
  const auto load = [&] { return std::make_shared<const EditedGraph>(load_for_editing(text, document, {}, sandbox)); };
  const auto later = [](int hours) { return fs::file_time_type::clock::now() + std::chrono::hours(hours); };
  WatchedFiles files;
  auto graph = load();
  CHECK_FALSE(files.have_changed(nullptr, text, document, sandbox));
  CHECK_FALSE(files.have_changed(graph, text, document, sandbox));
  write_text(map, "P5 4 4 255\n" + std::string(16, 'a'));
  CHECK(files.have_changed(graph, text, document, sandbox));
  // Written before the graph was loaded, or while it was.
  fs::last_write_time(map, later(-1));
  graph = load();
  CHECK_FALSE(files.have_changed(graph, text, document, sandbox));
  graph = load();
  fs::last_write_time(map, later(0));
  CHECK(files.have_changed(graph, text, document, sandbox));
  fs::last_write_time(map, later(-1));
  graph = load();
  CHECK_FALSE(files.have_changed(graph, text, document, sandbox));
  CHECK_FALSE(files.have_changed(graph, text, document, sandbox));
  fs::last_write_time(map, later(1));
  CHECK(files.have_changed(graph, text, document, sandbox));
  // What the graph may not read is not looked at.
  write_text(secret, "x");
  CHECK_FALSE(files.have_changed(graph, text, document, sandbox));
  fs::remove(map);
  CHECK(files.have_changed(graph, text, document, sandbox));
}
