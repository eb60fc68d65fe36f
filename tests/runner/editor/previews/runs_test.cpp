#include "runner/editor/previews/runs.h"

#include <algorithm>
#include <filesystem>
#include <mutex>
#include <thread>
#include <vector>

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tests/run_node.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr auto long_time = std::chrono::seconds(60);

/// A small brick wall, laid out anew and written to out/.
std::string wall_text(int seed, int size = 96, const std::string& more = "", const std::string& exemplar = "") {
  return fmt::format(
      R"({{"terrazzo": 1,
  "nodes": {{
    "exemplar": {{{}}},
    "weighted": {{"type": "weight", "material": "@exemplar"}},
    "space":    {{"type": "pca", "features": "@weighted"}},
    "index":    {{"type": "index", "appearance": "@space"}},
    "layout":   {{"type": "synthesize", "index": "@index", "size": {}, "seed": {}}},
    "result":   {{"type": "resolve_uv", "uv": "@layout", "material": "@exemplar"}},
    {}
    "files":    {{"type": "export", "material": "@result", "path": "out/{{map}}.png"}}
  }}
}})",
      exemplar.empty() ? R"("type": "pattern", "size": 64)" : exemplar, size, seed, more);
}

/// The runs of one document, and all that was told about them.
class WatchedRuns {
 public:
  explicit WatchedRuns(const fs::path& folder)
      : folder_(folder),
        session({.cache = folder / ".cache", .threads = 2}),
        sandbox(folder),
        runs(
            session, sandbox, store,
            [this](const std::string& event, const Json& data, bool) {
              const std::lock_guard lock(mutex_);
              events_.emplace_back(event, data);
            },
            [this] { found_++; }) {}

  void change(const std::string& text) { runs.changed(text, folder_ / "graph.json"); }
  void look_at(const std::string& node, const std::string& level = "", int side = 96) {
    runs.show({{"tab", "a"}, {"looked", {{"level", level}, {"node", node}}}, {"side", side}});
  }
  void wait() { REQUIRE(runs.wait_until_idle(long_time)); }
  std::vector<Json> all(const std::string& event) const {
    const std::lock_guard lock(mutex_);
    std::vector<Json> out;
    for (const auto& [kind, data] : events_)
      if (kind == event) out.push_back(data);
    return out;
  }
  size_t count(const std::string& event, const std::string& node) const {
    return size_t(std::ranges::count_if(all(event), [&](const Json& e) { return e.at("node") == node; }));
  }
  std::vector<Json> pictures(const std::string& node, bool coarse = false) const {
    std::vector<Json> out;
    for (const Json& e : all("picture"))
      if (e.at("node") == node && e.at("coarse") == coarse) out.push_back(e);
    return out;
  }
  ImagePtr last_base_colour(const std::string& node) {
    std::vector<Json> shown = pictures(node);
    std::erase_if(shown, [](const Json& e) { return e.at("map") != "base_color"; });
    REQUIRE(!shown.empty());
    return store.image(shown.back().at("digest"));
  }
  void forget_events() {
    const std::lock_guard lock(mutex_);
    events_.clear();
  }

 private:
  fs::path folder_;
  mutable std::mutex mutex_;
  std::vector<std::pair<std::string, Json>> events_;
  std::atomic<int> found_{0};

 public:
  Session session;
  Sandbox sandbox;
  PictureStore store;
  Runs runs;
};

/// The base colour that a run of the text gives, by itself and without a cache.
ImagePtr base_colour_of_run(const std::string& text, const fs::path& folder) {
  const LoadedGraph loaded = load_graph_text(text, folder / "graph.json");
  Session alone({.use_cache = false});
  const RunResult result = alone.run(loaded.graph, {.only = {"result"}, .keep = {"result"}});
  return std::get<MaterialPtr>(result.kept.at("result").at("material"))->find(Semantic::base_color);
}

}  // namespace

TEST_CASE("what a tab looks at is computed, coarse levels first, and is what a run gives") {
  const TemporaryFolder folder;
  WatchedRuns watched(folder.path());
  watched.change(wall_text(1, 1024));
  watched.look_at("result", "", 1024);
  watched.wait();
  const std::vector<Json> coarse = watched.pictures("result", true), whole = watched.pictures("result");
  REQUIRE(!coarse.empty());
  CHECK(coarse.back().at("semantic") == "base_color");
  CHECK(coarse.back().at("map") == "base_color");  // in the place of which the true one comes
  for (const Json& e : coarse) {
    CHECK(e.at("width") == 1024);
    CHECK(watched.store.find(e.at("digest")) != nullptr);
  }
  REQUIRE(whole.size() >= 4);
  CHECK(whole[0].at("map") == "base_color");
  CHECK(whole[0].at("width") == 1024);
  CHECK(whole[0].at("url") == "/picture/" + whole[0].at("digest").get<std::string>());
  const ImagePtr shown = watched.store.image(whole[0].at("digest"));
  REQUIRE(shown);
  CHECK(shown->digest() == base_colour_of_run(wall_text(1, 1024), folder.path())->digest());
  CHECK(shown->pixels() == base_colour_of_run(wall_text(1, 1024), folder.path())->pixels());
  CHECK(watched.count("done", "layout") == 1);
  CHECK(watched.all("ran").back().at("ok") == true);
  CHECK(!fs::exists(folder.path() / "out"));

  // Nothing is computed again for another look, or for a change that has no influence.
  watched.forget_events();
  watched.look_at("layout", "", 1024);
  watched.wait();
  CHECK(watched.pictures("layout").size() == 1);
  CHECK(watched.pictures("layout")[0].at("semantic") == "uv");
  watched.change(wall_text(1, 1024, "// a comment"));
  watched.wait();
  CHECK(watched.count("done", "layout") == 0);
  CHECK(watched.pictures("layout").size() >= 2);
  REQUIRE(watched.runs.current_pictures().size() == 1);
  CHECK(contains(watched.runs.current_pictures()[0], R"("node":"layout")"));
  watched.runs.forget("a");
  watched.wait();
  CHECK(watched.runs.current_pictures().empty());
}

TEST_CASE("every kind of value has a picture") {
  const TemporaryFolder folder;
  WatchedRuns watched(folder.path());
  watched.change(wall_text(1, 64, R"("lit": {"type": "preview", "material": "@result", "size": 64},)"));
  Json pinned = Json::array();
  for (const char* node :
       {"exemplar", "weighted", "space", "index", "layout", "result", "lit", "files", "no such node"})
    pinned.push_back({{"level", ""}, {"node", node}});
  watched.runs.show({{"tab", "a"}, {"pinned", pinned}, {"side", 64}});
  watched.wait();
  for (const char* node : {"exemplar", "weighted", "space", "index", "layout", "result", "lit"}) {
    INFO(node);
    CHECK(watched.pictures(node).size() == 1);
  }
  CHECK(watched.pictures("files").empty());
  for (const Json& request : std::vector<Json>{Json::object(),
                                               {{"tab", 1}},
                                               {{"tab", "a"}, {"looked", {{"level", ""}}}},
                                               {{"tab", "a"}, {"pinned", 1}},
                                               {{"tab", "a"}, {"side", "x"}}})
    CHECK_THROWS_AS(watched.runs.show(request), Error);
}

TEST_CASE("every pixel is shown without loss where it is asked for") {
  const TemporaryFolder folder;
  WatchedRuns watched(folder.path());
  watched.change(wall_text(1, 300));
  watched.runs.show(
      {{"tab", "a"}, {"looked", {{"level", ""}, {"node", "result"}, {"map", "height"}}}, {"side", 64}, {"full", true}});
  watched.wait();
  const std::vector<Json> pictures = watched.pictures("result");
  REQUIRE(!pictures.empty());
  CHECK(pictures[0].at("map") == "height");
  CHECK(pictures[0].at("of") == "full");
  CHECK(watched.store.find(pictures[0].at("digest"))->type == "image/png");
  CHECK(pictures[1].at("of") == "preview");
}

TEST_CASE("changes cancel what is stale and queue nothing") {
  const TemporaryFolder folder;
  WatchedRuns watched(folder.path());
  watched.change(wall_text(0, 384));
  watched.look_at("result");
  watched.wait();
  watched.forget_events();
  constexpr int last = 30;
  for (int seed = 1; seed <= last; seed++) {
    watched.change(wall_text(seed, 384));
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  watched.wait();
  CHECK(watched.count("done", "layout") < last / 2);
  CHECK(watched.last_base_colour("result")->pixels() ==
        base_colour_of_run(wall_text(last, 384), folder.path())->pixels());
}

TEST_CASE("pictures follow changes that come faster than they can be shown") {
  const TemporaryFolder folder;
  WatchedRuns watched(folder.path());
  watched.change(wall_text(0, 128));
  watched.look_at("result");
  watched.wait();
  watched.forget_events();
  const auto shown = [&] { return watched.pictures("result", true).size() + watched.pictures("result").size(); };
  const auto until = std::chrono::steady_clock::now() + long_time;
  int seed = 0;
  while (shown() < 3 && std::chrono::steady_clock::now() < until) {
    watched.change(wall_text(++seed, 128));
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  CHECK(shown() >= 3);
  CHECK(int(watched.count("start", "layout")) < seed);
  watched.wait();
  CHECK(watched.last_base_colour("result")->pixels() ==
        base_colour_of_run(wall_text(seed, 128), folder.path())->pixels());
}

TEST_CASE("a change that has no influence on what is being made lets it go on") {
  const TemporaryFolder folder;
  WatchedRuns watched(folder.path());
  watched.change(wall_text(1, 512));
  watched.look_at("layout");
  const auto until = std::chrono::steady_clock::now() + long_time;
  while (watched.count("start", "layout") == 0 && std::chrono::steady_clock::now() < until)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  for (int i = 0; i < 5; i++) {
    watched.change(wall_text(1, 512, fmt::format(R"("grey{}": {{"type": "solid"}},)", i)));
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  watched.wait();
  CHECK(watched.count("start", "layout") == 1);
  CHECK(watched.count("done", "layout") == 1);
}

TEST_CASE("sinks run when the user says so, and only then") {
  const TemporaryFolder folder;
  WatchedRuns watched(folder.path());
  watched.change(wall_text(1));
  watched.look_at("files");
  watched.wait();
  watched.runs.run({}, false);
  watched.wait();
  CHECK(watched.count("done", "layout") == 1);
  CHECK(!fs::exists(folder.path() / "out"));
  watched.runs.run({{"", "files"}}, false);
  watched.wait();
  CHECK(!fs::exists(folder.path() / "out"));
  watched.runs.run({{"", "files"}}, true);
  watched.wait();
  CHECK(fs::exists(folder.path() / "out/base_color.png"));
  const std::vector<Json> ran = watched.all("ran");
  CHECK(std::ranges::any_of(ran, [](const Json& e) { return e.contains("files") && e.at("files").size() >= 4; }));
  watched.forget_events();
  watched.runs.run({{"", "no such node"}}, false);
  watched.wait();
  CHECK(watched.all("ran").front().at("ok") == false);
}

TEST_CASE("a running job ends when it is cancelled") {
  const TemporaryFolder folder;
  WatchedRuns watched(folder.path());
  watched.change(wall_text(1, 2048));
  watched.look_at("result");
  watched.runs.run({}, false);
  const auto until = std::chrono::steady_clock::now() + long_time;
  while (watched.count("start", "layout") == 0 && std::chrono::steady_clock::now() < until)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  watched.runs.cancel();
  while (watched.all("ran").empty() && std::chrono::steady_clock::now() < until)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  REQUIRE(!watched.all("ran").empty());
  CHECK(watched.all("ran").front().at("cancelled") == true);
}

TEST_CASE("a graph with mistakes shows what has none") {
  const TemporaryFolder folder;
  WatchedRuns watched(folder.path());
  watched.change(wall_text(1, 64, R"("wrong": {"type": "no such type"}, "odd": {"type": "blur", "image": "@gone"},)"));
  watched.look_at("result");
  watched.wait();
  CHECK(!watched.pictures("result").empty());
  CHECK(watched.runs.findings().errors.size() >= 2);
  // The others are planned all the same, and so is what nobody looks at.
  const Json planned = watched.runs.plan().at("stages");
  CHECK(planned.size() == 7);
  CHECK(planned.back().at("node") == "files");
  watched.change("{");
  watched.wait();
  CHECK(watched.runs.findings().errors.size() == 1);
  CHECK(watched.runs.plan().at("stages").empty());
  watched.change(wall_text(1, 64));
  watched.wait();
  CHECK(watched.runs.findings().errors.empty());
  const Json stages = watched.runs.plan().at("stages");
  CHECK(stages.size() == 7);
  CHECK(stages.back().at("node") == "files");
  CHECK(stages.back().at("state") == "run");
  // Runs with mistakes write nothing.
  watched.change(wall_text(1, 64, R"("wrong": {"type": "no such type"},)"));
  watched.runs.run({}, true);
  watched.wait();
  CHECK(!fs::exists(folder.path() / "out"));
}

TEST_CASE("what needs a parameter without a value waits for it, and mistakes elsewhere come and go") {
  const auto text = [](const std::string& features) {
    return R"({"terrazzo": 1, "parameters": {"material": {"type": "path"}},
  "nodes": {
    "given":  {"type": "load_material", "path": "$material"},
    "walls":  {"type": "weight", "material": "@given"},
    "bricks": {"type": "pattern", "size": 64},
    "space":  {"type": "pca")" +
           features + R"(},
    "files":  {"type": "export", "material": "@given", "path": "out/{map}.png"}
  }
})";
  };
  const TemporaryFolder folder;
  WatchedRuns watched(folder.path());
  watched.look_at("bricks");
  for (int i = 0; i < 2; i++) {
    watched.change(text(""));
    watched.wait();
    CHECK(watched.runs.findings().errors.size() == 1);
    watched.change(text(R"(, "features": "@walls")"));
    watched.wait();
    const RunFindings found = watched.runs.findings();
    CHECK(found.errors.empty());
    REQUIRE(found.warnings.size() == 1);
    CHECK(found.warnings.front().parameter == "material");
  }
  CHECK(!watched.pictures("bricks").empty());
  watched.forget_events();
  watched.runs.run({}, true);
  watched.wait();
  const std::vector<Json> ran = watched.all("ran");
  CHECK(std::ranges::any_of(ran, [](const Json& e) {
    return e.at("ok") == false && e.value("message", "").find("\"material\"") != std::string::npos;
  }));
  CHECK(!fs::exists(folder.path() / "out"));
}

TEST_CASE("a graph reads nothing outside of the folders it may use") {
  const TemporaryFolder folder, outside;
  write_text(outside.path() / "secret.png", "no picture");
  fs::create_symlink(outside.path() / "secret.png", folder.path() / "link.png");
  WatchedRuns watched(folder.path());
  for (const std::string& path : {(outside.path() / "secret.png").string(), std::string("link.png"),
                                  "../" + outside.path().filename().string() + "/secret.png"}) {
    INFO(path);
    watched.forget_events();
    watched.change(wall_text(1, 64, "", fmt::format(R"("type": "load_map", "path": "{}")", path)));
    watched.look_at("exemplar");
    watched.wait();
    CHECK(watched.pictures("exemplar").empty());
    const std::vector<Problem> errors = watched.runs.findings().errors;
    REQUIRE(!errors.empty());
    CHECK(contains(errors[0].message, "may not read"));
    CHECK(!contains(errors[0].message, "PNG"));  // it was not looked at: it is no picture
    watched.runs.run({}, true);
    watched.wait();
    CHECK(!fs::exists(folder.path() / "out"));
  }
}

TEST_CASE("nodes of subgraphs are shown where they are used") {
  const TemporaryFolder folder;
  WatchedRuns watched(folder.path());
  watched.change(R"({"terrazzo": 1,
    "graphs": {"soft": {"inputs": {"material": {"type": "material"}},
                        "nodes": {"colour": {"type": "get_map", "material": "@material", "map": "base_color"},
                                  "smooth": {"type": "blur", "image": "@colour", "radius": 2}},
                        "outputs": {"image": "@smooth"}}},
    "nodes": {"exemplar": {"type": "pattern", "size": 64},
              "one": {"type": "soft", "material": "@exemplar"},
              "dark": {"type": "grayscale", "image": "@one"}}})");
  watched.runs.show(Json::parse(R"({"tab": "a", "pinned": [{"level": "soft", "node": "colour"},
    {"level": "", "node": "one"}, {"level": "none", "node": "one"}]})"));
  watched.wait();
  CHECK(watched.pictures("colour").size() == 1);
  CHECK(watched.pictures("colour")[0].at("level") == "soft");
  CHECK(watched.pictures("one").size() == 1);
  CHECK(watched.pictures("one")[0].at("digest") != watched.pictures("colour")[0].at("digest"));
}
