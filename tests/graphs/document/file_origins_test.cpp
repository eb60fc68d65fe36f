#include "graphs/document/file_origins.h"

#include <doctest/doctest.h>

#include "tests/graphs/document/fake_types.h"
#include "tests/run_node.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

using PathNames = std::set<std::string>;

PathNames by(const LoadedGraph& loaded, const char* node, const char* about) {
  return loaded.graph.find(node)->files_by.at(about);
}

}  // namespace

TEST_CASE("every port knows which of the graph's paths its files come from") {
  const LoadedGraph loaded = load_fake(document(R"("a": {"type": "photo", "file": "$one"},
      "b": {"type": "adjust", "image": "@a", "steps": "$steps"},
      "c": {"type": "photo", "file": "maps/${two}.png"},
      "all": {"type": "gather", "images": ["@b", "@c"]},
      "files": {"type": "write", "material": "@all", "path": "$$one/$out/{map}.png"})",
                                                R"("one": {"type": "path", "default": "a.png", "help": "."},
      "two": {"type": "path", "default": "b", "help": "."}, "out": {"type": "path", "default": "o", "help": "."},
      "steps": {"type": "int", "default": 3, "help": "."})"));
  CHECK(by(loaded, "a", "file") == PathNames{"one"});
  CHECK(by(loaded, "b", "image") == PathNames{"one"});
  CHECK(by(loaded, "c", "file") == PathNames{"two"});
  CHECK(by(loaded, "all", "images") == PathNames{"one", "two"});
  CHECK(by(loaded, "files", "material") == PathNames{"one", "two"});
  CHECK(by(loaded, "files", "path") == PathNames{"out"});
  CHECK_FALSE(loaded.graph.find("b")->files_by.contains("steps"));
}

TEST_CASE("of what a loop names, only what can be set is told: what the loop goes over, not its variable") {
  const TemporaryFolder folder;
  fs::create_directories(folder.path() / "in");
  for (const char* name : {"a.png", "b.png"}) write_text(folder.path() / "in" / name, "");
  const LoadedGraph loaded = load_fake(
      document(R"("all": {"type": "photo", "foreach": {"files": "$photos/*.png", "as": "scan"}, "file": "$scan"},
      "some": {"type": "photo", "foreach": {"files": "in/*.png", "as": "scan"}, "file": "$scan"},
      "other": {"type": "photo", "foreach": {"files": "in/*.png", "as": "scan"}, "file": "$second"},
      "g": {"type": "gather", "images": ["@all", "@some", "@other"]},
      "w": {"type": "write", "material": "@g", "path": "x"})",
               R"("photos": {"type": "path", "default": "in", "help": "."},
      "second": {"type": "path", "default": "in/a.png", "help": "."})"),
      {}, folder.path() / "test.json");
  CHECK(by(loaded, "all[a]", "file") == PathNames{"photos"});
  CHECK(by(loaded, "all[b]", "file") == PathNames{"photos"});
  CHECK(by(loaded, "some[a]", "file").empty());
  CHECK(by(loaded, "other[a]", "file") == PathNames{"second"});
  CHECK(by(loaded, "w", "material") == PathNames{"photos", "second"});
}

TEST_CASE("of a subgraph's parameters those of the document behind them are told, through a loop too") {
  const TemporaryFolder folder;
  fs::create_directories(folder.path() / "in");
  write_text(folder.path() / "in/a.png", "");
  const std::string text = R"({"terrazzo": 1,
    "parameters": {"photos": {"type": "path", "default": "in", "help": "."},
                   "one": {"type": "path", "default": "in/a.png", "help": "."}},
    "graphs": {"g": {
      "parameters": {"file": {"type": "path", "default": "in/a.png", "help": "."}},
      "nodes": {"p": {"type": "photo", "file": "$file"}},
      "outputs": {"image": {"from": "@p"}}}},
    "nodes": {
      "given": {"type": "g", "file": "$one"},
      "looped": {"type": "g", "foreach": {"files": "$photos/*.png", "as": "one_of"}, "file": "$one_of"},
      "usual": {"type": "g"},
      "all": {"type": "gather", "images": ["@given", "@looped", "@usual"]}}})";
  const LoadedGraph loaded = load_fake(text, {}, folder.path() / "test.json");
  CHECK(by(loaded, "given/p", "file") == PathNames{"one"});
  CHECK(by(loaded, "looped[a]/p", "file") == PathNames{"photos"});
  CHECK(by(loaded, "usual/p", "file").empty());
  CHECK(by(loaded, "all", "images") == PathNames{"one", "photos"});
}
