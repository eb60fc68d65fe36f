#include "runner/api/session.h"

#include <atomic>
#include <mutex>
#include <thread>

#include <doctest/doctest.h>
#include <fcntl.h>

#include "nodes/common/registry.h"
#include "runner/engine/checked.h"
#include "tests/run_node.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

const char* graph = R"({
  "terrazzo": 1,
  "parameters": {"seed": {"type": "int", "default": 1}},
  "nodes": {
    "noise":  {"type": "noise", "size": [64, 32], "seed": "$seed"},
    "normal": {"type": "make_normal", "height": "@noise"},
    "spare":  {"type": "noise", "size": 8, "seed": 3}
  }
})";

class Counter : public RunObserver {
 public:
  void finished(const Stage&, double) override { done++; }
  void reused(const Stage&) override { again++; }
  std::atomic<int> done = 0, again = 0;
};

}  // namespace

TEST_CASE("a session runs what it must, and keeps values that outlive it") {
  const TemporaryFolder folder;
  Value kept;
  {
    Session session({.cache = folder.path() / "cache", .threads = 2});
    const CheckedJob job = Job::from_text(graph).checked();
    Counter first, second;
    RunResult result = session.run(job, {.only = {"normal"}, .keep = {"normal"}, .observer = &first});
    REQUIRE(result.ok());
    CHECK(first.done + first.again >= 1);
    kept = result.kept.at("normal").begin()->second;
    CHECK(session.plan(job, {.only = {"noise"}}).needed() == 1);
    session.run(job, {.only = {"noise"}, .observer = &second});
    CHECK(second.done == 0);
    CHECK_THROWS_AS(session.plan(job, {.only = {"gone"}}), Error);
  }
  CHECK(std::get<ImagePtr>(kept)->read({0, 0, 4, 4}).size() == 4 * 4 * 3);
}

TEST_CASE("a run that is cancelled says so, and one session runs several jobs at once") {
  const TemporaryFolder folder;
  Session session({.cache = folder.path() / "cache"});
  const std::atomic<bool> cancelled = true;
  CHECK(session.run(Job::from_text(graph).checked(), {.cancelled = &cancelled}).cancelled);
  std::vector<std::thread> threads;
  std::atomic<int> done = 0;
  for (int i = 0; i < 4; i++)
    threads.emplace_back([&, i] {
      Job job = Job::from_text(graph);
      job.set("seed", int64_t{i % 2});
      done += session.run(job.checked()).ok();
    });
  for (std::thread& t : threads) t.join();
  CHECK(done == 4);
}

TEST_CASE("a checked session catches nodes that give something else or read what they do not declare") {
  const TemporaryFolder folder;
  const std::string secret = (folder.path() / "secret.txt").string();
  write_text(secret, "1");
  NodeType liar;
  liar.name = "session_liar";
  liar.category = "source";
  liar.origin.name = "the tests";
  liar.params = {{.name = "way", .type = ParamType::text}};
  liar.outputs = {{.name = "image"}};
  liar.compute = [secret, count = std::make_shared<int>(0)](NodeContext& n) {
    if (n.text("way") == "file") tell_opened(secret.c_str(), O_RDONLY);
    if (n.text("way") == "write") tell_opened(secret.c_str(), O_WRONLY);
    const float value = n.text("way") == "count" ? float(++*count) : 0;
    n.output("image", make_image({1, 1}, 1, [&](int, int, int) { return value; }));
  };
  register_node_type(liar);
  const auto failure = [&](const std::string& way, bool checked) {
    Session session({.cache = folder.path() / "cache", .checked = checked});
    Job job = Job::from_text(R"({"terrazzo": 1, "nodes": {"liar": {"type": "session_liar", "way": "honest"}}})");
    job.set("liar.way", way);
    const RunResult result = session.run(job.checked());
    return result.ok() ? "" : result.failures.at(0).message;
  };
  for (const char* way : {"honest", "write"}) CHECK(failure(way, true).empty());
  CHECK(contains(failure("file", true), "reads " + secret + ", which its `files_read` does not name"));
  CHECK(
      contains(failure("count", true), "node \"liar\" (session_liar): checked: session_liar gives another \"image\""));
  CHECK_FALSE(std::filesystem::exists(folder.path() / "cache"));
  for (const char* way : {"file", "count"}) CHECK(failure(way, false).empty());
}

TEST_CASE("failures of nodes are in the result, with the graph's name and place") {
  Session session({.use_cache = false});
  Job job = Job::from_text(R"({"terrazzo": 1, "nodes": {
    "file": {"type": "load_map", "path": "broken.png"}}})",
                           "somewhere/graph.json");
  const TemporaryFolder folder;
  write_text(folder.path() / "broken.png", "no picture");
  job.set("file.path", (folder.path() / "broken.png").string());
  const std::vector<Problem> problems = job.check();
  const RunResult result = problems.empty() ? session.run(job.checked()) : RunResult();
  CHECK((!problems.empty() || (!result.ok() && contains(result.failures.at(0).message, "somewhere/graph.json:2"))));
}
