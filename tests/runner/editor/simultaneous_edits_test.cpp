#include <chrono>
#include <fstream>
#include <thread>
#include <vector>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "runner/editor/document.h"
#include "tests/run_node.h"

using namespace terrazzo;
using nlohmann::ordered_json;
using terrazzo::test::TemporaryFolder;

namespace {

namespace fs = std::filesystem;

ordered_json edit_of(const std::string& edit) {
  return {{"edits", ordered_json::parse("[" + edit + "]")}};
}

void put(const fs::path& file, const std::string& text) {
  std::ofstream(file) << text;
}

const std::string small =
    "{\n  \"terrazzo\": 1,\n  \"nodes\": {\n    \"a\": {\"type\": \"pattern\"}, // first\n    \"b\": {\"type\": "
    "\"weight\", \"material\": \"@a\"}\n  }\n}\n";

}  // namespace

TEST_CASE("a drag is one step, however long it takes, but not those of two tabs") {
  const TemporaryFolder folder;
  put(folder.path() / "g.json", small);
  EditedDocument document(folder.path() / "g.json");
  const auto drag = [&](int value, const char* tab, const char* gesture) {
    ordered_json r = edit_of(R"({"op": "set", "node": "a", "key": "seed", "value": )" + std::to_string(value) + "}");
    r["tab"] = tab;
    r["gesture"] = gesture;
    document.edit(r);
  };
  drag(1, "x", "g1");
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // longer than steps without a gesture are merged
  drag(2, "x", "g1");
  drag(3, "x", "g2");
  drag(4, "y", "g2");
  for (const char* expected : {"\"seed\": 3", "\"seed\": 2"}) {
    document.undo();
    CHECK(document.snapshot().text.find(expected) != std::string::npos);
  }
  document.undo();
  CHECK(document.snapshot().text == small);
}

TEST_CASE("a value that another edit has just changed is not overwritten unseen") {
  const TemporaryFolder folder;
  put(folder.path() / "g.json", small);
  EditedDocument document(folder.path() / "g.json");
  const auto since = [&](int64_t base, const std::string& edit) {
    ordered_json r = edit_of(edit);
    r["base"] = base;
    return r;
  };
  const int64_t begin = document.revision();
  const std::string seed = R"({"op": "set", "node": "a", "key": "seed", "value": )";
  document.edit(since(begin, seed + "5}"));
  const std::string text = document.snapshot().text;
  for (const std::string& edit : {seed + "6}", std::string(R"({"op": "unset", "node": "a", "key": "seed"})")}) {
    try {
      document.edit(since(begin, edit));
      FAIL(edit);
    } catch (const EditConflict& e) {
      CHECK(e.about() == "/nodes/a/seed");
    }
    CHECK(document.snapshot().text == text);
  }
  // The same value, another one, and one that was seen.
  document.edit(since(begin, seed + "5}"));
  document.edit(since(begin, R"({"op": "set", "node": "a", "key": "kind", "value": "bricks"})"));
  document.edit(since(document.revision(), seed + "6}"));
  CHECK(document.snapshot().text.find("\"seed\": 6") != std::string::npos);
  // What changed on disk counts as well.
  const int64_t seen = document.revision();
  std::string disk = document.snapshot().text;
  put(folder.path() / "g.json", disk.replace(disk.find("\"seed\": 6"), 9, "\"seed\": 9"));
  CHECK(document.look_at_disk());
  CHECK_THROWS_AS(document.edit(since(seen, seed + "7}")), EditConflict);
}

TEST_CASE("clients on several threads share a document") {
  const TemporaryFolder folder;
  put(folder.path() / "g.json", small);
  EditedDocument document(folder.path() / "g.json");
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; t++)
    threads.emplace_back([&] {
      for (int i = 0; i < 25; i++) {
        document.edit(edit_of(R"({"op": "add", "type": "crop"})"));
        document.look_at_disk();
        document.snapshot();
      }
    });
  for (std::thread& t : threads) t.join();
  CHECK(document.snapshot().text.find("\"crop_100\"") != std::string::npos);
  CHECK(document.snapshot().saved);
}
