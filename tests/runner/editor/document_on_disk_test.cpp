#include <doctest/doctest.h>

#include "runner/editor/document.h"
#include "tests/run_node.h"
#include "tests/runner/editor/small_document.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

namespace fs = std::filesystem;

}  // namespace

TEST_CASE("a change on disk is taken over, merged or asked about") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "g.json";
  write_text(file, small);
  EditedDocument document(file);
  CHECK_FALSE(document.look_at_disk());
  std::string theirs = small;
  theirs.replace(theirs.find("pattern"), 7, "load_map");
  write_text(file, theirs);
  CHECK(document.look_at_disk());
  CHECK(document.snapshot().text == theirs);
  document.undo();
  CHECK(read_text(file) == small);

  SUBCASE("changes of different members go together") {
    fs::permissions(file, fs::perms::owner_read);
    document.edit(request(R"({"op": "set", "node": "b", "key": "comment", "value": "mine"})"));
    CHECK(read_text(file) == small);
    const DocumentSnapshot kept = document.snapshot();
    CHECK_FALSE(kept.saved);
    CHECK(kept.save_error.find("write-protected") != std::string::npos);
    fs::permissions(file, fs::perms::owner_all);
    write_text(file, theirs);
    CHECK(document.look_at_disk());
    CHECK(document.snapshot().saved);
    CHECK(document.snapshot().save_error.empty());
    CHECK(read_text(file).find("load_map") != std::string::npos);
    CHECK(read_text(file).find("\"mine\"") != std::string::npos);
    CHECK(read_text(file).find("// first") != std::string::npos);
  }
  SUBCASE("of the same member waits for an answer") {
    fs::permissions(file, fs::perms::owner_read);
    document.edit(request(R"({"op": "set", "node": "a", "key": "type", "value": "load_material"})"));
    fs::permissions(file, fs::perms::owner_all);
    write_text(file, theirs);
    CHECK(document.look_at_disk());
    DocumentSnapshot now = document.snapshot();
    CHECK(now.on_disk == OnDisk::changed);
    CHECK(now.conflict.ends_with(R"(/type: here to "load_material", elsewhere to "load_map")"));
    document.edit(request(add_crop));
    CHECK(read_text(file) == theirs);
    SUBCASE("mine") {
      document.resolve(true);
      CHECK(read_text(file) == document.snapshot().text);
      CHECK(read_text(file).find("load_material") != std::string::npos);
    }
    SUBCASE("theirs, which can be undone") {
      document.resolve(false);
      CHECK(document.snapshot().text == theirs);
      document.undo();
      CHECK(read_text(file).find("load_material") != std::string::npos);
    }
    CHECK(document.snapshot().on_disk == OnDisk::same);
  }
  SUBCASE("a file that is gone is written again only if that is wanted") {
    fs::remove(file);
    CHECK(document.look_at_disk());
    CHECK(document.snapshot().on_disk == OnDisk::gone);
    document.edit(request(add_crop));
    CHECK_FALSE(fs::exists(file));
    CHECK_THROWS_AS(document.resolve(false), EditRefused);
    document.resolve(true);
    CHECK(read_text(file) == document.snapshot().text);
  }
}

TEST_CASE("a file that is half written is neither taken over nor written over") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "g.json";
  write_text(file, small);
  EditedDocument document(file);
  std::string theirs = small;
  theirs.replace(theirs.find("pattern"), 7, "load_map");

  SUBCASE("and the whole one is") {
    for (const std::string& half : {std::string(), theirs.substr(0, theirs.size() / 2)}) {
      write_text(file, half);
      CHECK_FALSE(document.look_at_disk());
      CHECK(document.snapshot().text == small);
    }
    write_text(file, theirs);
    CHECK(document.look_at_disk());
    CHECK(document.snapshot().text == theirs);
    document.undo();
    CHECK(document.snapshot().text == small);
  }
  SUBCASE("an edit meanwhile is saved with it") {
    write_text(file, "");
    document.edit(request(R"({"op": "set", "node": "b", "key": "comment", "value": "mine"})"));
    CHECK(read_text(file).empty());
    CHECK_FALSE(document.snapshot().saved);
    write_text(file, theirs);
    CHECK(document.look_at_disk());
    CHECK(read_text(file).find("load_map") != std::string::npos);
    CHECK(read_text(file).find("\"mine\"") != std::string::npos);
  }
  SUBCASE("but one that stays so is shown") {
    write_text(file, theirs + "}");
    CHECK_FALSE(document.look_at_disk());
    CHECK(document.look_at_disk());
    CHECK(document.snapshot().text == theirs + "}");
  }
}

TEST_CASE("positions that are half written are neither taken over nor written over") {
  const TemporaryFolder folder;
  const fs::path sidecar = folder.path() / "g.layout.json";
  write_text(folder.path() / "g.json", small);
  EditedDocument document(folder.path() / "g.json");
  document.edit(request(R"({"op": "move", "positions": {"a": [1, 2], "b": [3, 4]}})"));
  const std::string placed = read_text(sidecar);
  write_text(sidecar, placed.substr(0, placed.size() / 2));
  CHECK_FALSE(document.look_at_disk());
  document.edit(request(R"({"op": "move", "positions": {"b": [9, 9]}})"));
  CHECK(read_text(sidecar) == placed.substr(0, placed.size() / 2));
  write_text(sidecar, placed);
  document.look_at_disk();
  const nlohmann::json nodes = nlohmann::json::parse(read_text(sidecar))["levels"][""]["nodes"];
  CHECK(nodes["a"] == nlohmann::json({1, 2}));
  CHECK(nodes["b"] == nlohmann::json({9, 9}));
}

TEST_CASE("a disk that is full loses no edit") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "in" / "g.json";
  fs::create_directories(file.parent_path());
  write_text(file, small);
  EditedDocument document(file);
  // The folder is replaced by a file: nothing can be written there, whoever writes.
  fs::rename(file.parent_path(), folder.path() / "aside");
  write_text(folder.path() / "in", "");
  document.edit(request(add_crop));
  const DocumentSnapshot kept = document.snapshot();
  CHECK(kept.text.find("\"crop\"") != std::string::npos);
  CHECK_FALSE(kept.saved);
  fs::remove(folder.path() / "in");
  fs::rename(folder.path() / "aside", folder.path() / "in");
  CHECK(document.look_at_disk());
  CHECK(document.snapshot().saved);
  CHECK(read_text(file) == kept.text);
}
