#include "runner/progress.h"

#include <sstream>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "tests/runner/fakes.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

/// What a run of a graph with one note and one failure writes.
std::string progress_of(ProgressMode mode, bool terminal, bool fails) {
  FakeTypes t;
  TemporaryFolder folder;
  write_text(folder.path() / "in.txt", "4");
  Graph g;
  add(g, "read", t.file, {{"path", (folder.path() / "in.txt").string()}});
  add(g, "last", fails ? t.fail : t.sum, {}, {"read"});
  std::ostringstream out;
  const std::unique_ptr<Progress> progress = make_progress(mode, out, terminal);
  RunOptions options;
  options.observer = progress.get();
  options.threads = 1;
  progress->closed(run_graph(g, options));
  return out.str();
}

std::vector<std::string> event_names(const std::string& text) {
  std::vector<std::string> names;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) names.push_back(nlohmann::json::parse(line)["event"]);
  return names;
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("json progress tells every event in order") {
  CHECK(event_names(progress_of(ProgressMode::json, false, false)) ==
        std::vector<std::string>{"plan", "start", "done", "note", "start", "done", "finished"});
  const std::string text = progress_of(ProgressMode::json, false, true);
  CHECK(event_names(text) == std::vector<std::string>{"plan", "start", "done", "note", "start", "failed", "finished"});
  CHECK(has(text, "these numbers cannot be added"));
  CHECK(has(text, "\"ok\":false"));
}

TEST_CASE("plain progress is a line per stage, and notes") {
  const std::string text = progress_of(ProgressMode::plain, true, false);
  CHECK(has(text, "[1/2] read (file) "));
  CHECK(has(text, "note: node \"read\": read a number\n"));
  CHECK(has(text, "[2/2] last (sum) "));
}

TEST_CASE("the bar erases itself, notes stay") {
  const std::string text = progress_of(ProgressMode::bar, true, false);
  CHECK(has(text, "\x1b[K"));
  CHECK(has(text, "note: node \"read\": read a number\n"));
  const size_t last_line = text.rfind('\r');
  REQUIRE(last_line != std::string::npos);
  CHECK(text.substr(last_line) == "\r\x1b[K");
}

TEST_CASE("automatic is the bar on a terminal only, and none is silent") {
  CHECK(has(progress_of(ProgressMode::automatic, true, false), "\x1b[K"));
  CHECK_FALSE(has(progress_of(ProgressMode::automatic, false, false), "\x1b[K"));
  CHECK(progress_of(ProgressMode::none, true, true) == "");
  CHECK(progress_mode_from("auto") == ProgressMode::automatic);
  CHECK_FALSE(progress_mode_from("loud"));
}
