#include "runner/editor/previews/sweeps.h"

#include <mutex>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "tests/run_node.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

using Json = nlohmann::ordered_json;

constexpr auto longest_sheet = std::chrono::seconds(60);

const std::string swept_wall = R"t({"terrazzo": 1,
  "parameters": {"seed": {"type": "int", "default": 1, "min": 0}, "unused": {"type": "int", "default": 0}},
  "nodes": {
    "exemplar": {"type": "pattern", "size": 64},
    "weighted": {"type": "weight", "material": "@exemplar"},
    "space":    {"type": "pca", "features": "@weighted"},
    "index":    {"type": "index", "appearance": "@space"},
    "layout":   {"type": "synthesize", "index": "@index", "size": 256, "seed": "$seed"},
    "result":   {"type": "resolve_uv", "uv": "@layout", "material": "@exemplar"},
    "files":    {"type": "export", "material": "@result", "path": "out/{map}.png"}
  }
})t";

class WatchedSweeps {
 public:
  explicit WatchedSweeps(const std::filesystem::path& at)
      : folder(at),
        session({.cache = folder / ".cache", .threads = 2}),
        sandbox(folder),
        sweeps(session, sandbox, store, [this](const std::string& event, const Json& data, bool) {
          const std::lock_guard lock(mutex_);
          events_.emplace_back(event, data);
        }) {}
  Json start(const std::string& id, const std::vector<std::string>& values, const std::string& node = "result") {
    return sweeps.start({{"id", id}, {"node", node}, {"map", "height"}, {"side", 64}, {"sweeps", values}}, swept_wall,
                        folder / "graph.json");
  }
  std::vector<Json> all(const std::string& event, const std::string& id) const {
    const std::lock_guard lock(mutex_);
    std::vector<Json> out;
    for (const auto& [kind, data] : events_)
      if (kind == event && data.at("id") == id) out.push_back(data);
    return out;
  }

 private:
  std::filesystem::path folder;
  mutable std::mutex mutex_;
  std::vector<std::pair<std::string, Json>> events_;

 public:
  Session session;
  Sandbox sandbox;
  PictureStore store;
  Sweeps sweeps;
};

}  // namespace

TEST_CASE("a sheet shows what each value gives") {
  const TemporaryFolder folder;
  WatchedSweeps watched(folder.path());
  const Json cells = watched.start("a", {"seed=1..2", "layout.quality=draft,normal"}).at("cells");
  REQUIRE(cells.size() == 4);
  CHECK(cells[1].at("values") == Json{{"seed", "1"}, {"layout.quality", "normal"}});
  REQUIRE(watched.sweeps.wait_until_idle(longest_sheet));
  REQUIRE(watched.all("swept", "a").size() == 1);
  CHECK(watched.all("swept", "a")[0].at("cancelled") == false);
  CHECK(watched.all("sweep_failed", "a").empty());
  for (size_t cell = 0; cell < cells.size(); cell++) {
    INFO(cell);
    ImagePtr last;
    for (const Json& e : watched.all("sweep_picture", "a"))
      if (e.at("cell") == cell && e.at("coarse") == false) last = watched.store.image(e.at("digest"));
    REQUIRE(last);
    // As a run with these values gives it.
    std::vector<Override> values;
    for (const auto& [name, value] : cells[cell].at("values").items())
      values.push_back(override_of(name, value.get<std::string>()));
    const LoadedGraph loaded = load_graph_text(swept_wall, folder.path() / "graph.json", values);
    Session alone({.use_cache = false});
    const RunResult result = alone.run(loaded.graph, {.only = {"result"}, .keep = {"result"}});
    CHECK(last->pixels() ==
          std::get<MaterialPtr>(result.kept.at("result").at("material"))->find(Semantic::height)->pixels());
  }
  CHECK(!std::filesystem::exists(folder.path() / "out"));
}

TEST_CASE("a sheet ends when another begins or it is cancelled, and says what is wrong") {
  const TemporaryFolder folder;
  WatchedSweeps watched(folder.path());
  watched.start("a", {"seed=1..40"});
  watched.start("b", {"seed=1..40"});
  watched.sweeps.cancel();
  REQUIRE(watched.sweeps.wait_until_idle(longest_sheet));
  for (const char* id : {"a", "b"})
    for (const Json& e : watched.all("swept", id)) CHECK(e.at("cancelled") == true);
  CHECK(watched.all("sweep_picture", "b").size() < 40);
  CHECK_THROWS_AS(watched.start("c", {"no such thing=1..3"}), Error);
  CHECK_THROWS_AS(watched.start("c", {"luck=1..3"}), Error);
  CHECK_THROWS_AS(watched.start("c", {"seed=1..1000"}), Error);
  CHECK_THROWS_AS(watched.start("c", {}), Error);
  watched.start("d", {"unused=1,2"}, "files");
  REQUIRE(watched.sweeps.wait_until_idle(longest_sheet));
  CHECK(watched.all("sweep_failed", "d").size() >= 2);
  CHECK(watched.all("sweep_picture", "d").empty());
}
