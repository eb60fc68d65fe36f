#include "runner/report/progress.h"

#include <algorithm>
#include <sstream>

#include <doctest/doctest.h>
#include <fmt/format.h>
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

}  // namespace

TEST_CASE("json progress tells every event in order") {
  CHECK(event_names(progress_of(ProgressMode::json, false, false)) ==
        std::vector<std::string>{"plan", "start", "done", "note", "start", "done", "finished"});
  const std::string text = progress_of(ProgressMode::json, false, true);
  CHECK(event_names(text) == std::vector<std::string>{"plan", "start", "done", "note", "start", "failed", "finished"});
  CHECK(contains(text, "these numbers cannot be added"));
  CHECK(contains(text, "\"ok\":false"));
}

TEST_CASE("plain progress is a line per stage, and notes") {
  const std::string text = progress_of(ProgressMode::plain, true, false);
  CHECK(contains(text, "[1/2] read (file) "));
  CHECK(contains(text, "note: node \"read\": read a number\n"));
  CHECK(contains(text, "[2/2] last (sum) "));
}

TEST_CASE(
    "of what was made before and is made again for a new reader, plain progress tells once, and the total stays") {
  FakeTypes t;
  TemporaryFolder folder;
  Cache cache(folder.path() / "cache");
  Graph g;
  add(g, "source", t.quick, {{"value", 4.0}});
  add(g, "unread", t.lazy_sum, {}, {"source"});
  add(g, "lazy", t.lazy_sum, {}, {"source"});
  add(g, "old", t.sum, {}, {"lazy", "unread"});
  add(g, "file", t.write, {{"path", (folder.path() / "out.txt").string()}}, {"old"});
  const auto lines_of_run = [&] {
    std::ostringstream out;
    const std::unique_ptr<Progress> progress = make_progress(ProgressMode::plain, out, false);
    RunOptions options;
    options.cache = &cache;
    options.observer = progress.get();
    options.threads = 1;
    REQUIRE(run_graph(g, options).ok());
    std::vector<std::string> lines;
    std::istringstream text(out.str());
    for (std::string line; std::getline(text, line);) lines.push_back(line.substr(0, line.rfind(") ") + 1));
    return lines;
  };
  const auto check_lines = [&](std::vector<std::string> lines, const std::vector<std::string>& stages) {
    REQUIRE(lines.size() == stages.size());
    CHECK(lines.back().starts_with(fmt::format("[{0}/{0}] ", g.nodes.size())));
    for (const std::string& s : stages) {
      CAPTURE(s);
      CHECK(std::count_if(lines.begin(), lines.end(), [&](const std::string& l) { return l.ends_with(s); }) == 1);
    }
    for (const std::string& l : lines) CHECK(contains(l, fmt::format("/{}] ", g.nodes.size())));
  };
  const std::vector<std::string> all = {"] source (quick)", "] unread (lazy_sum)", "] lazy (lazy_sum)", "] old (sum)",
                                        "] file (write)"};
  check_lines(lines_of_run(), all);
  check_lines(lines_of_run(), all);
  // The new reader asks for "lazy", and so for "source"; nobody asks for "unread" again.
  add(g, "new", t.sum, {{"plus", 1.0}}, {"lazy"});
  add(g, "second", t.write, {{"path", (folder.path() / "second.txt").string()}}, {"new"});
  std::vector<std::string> more = all;
  more.insert(more.end(), {"] new (sum)", "] second (write)"});
  check_lines(lines_of_run(), more);
}

TEST_CASE("the bar erases itself, notes stay") {
  const std::string text = progress_of(ProgressMode::bar, true, false);
  CHECK(contains(text, "\x1b[K"));
  CHECK(contains(text, "note: node \"read\": read a number\n"));
  const size_t last_line = text.rfind('\r');
  REQUIRE(last_line != std::string::npos);
  CHECK(text.substr(last_line) == "\r\x1b[K");
}

TEST_CASE("one file is watched, or several files are") {
  std::ostringstream one, two;
  write_watching(ProgressMode::plain, one, 1);
  write_watching(ProgressMode::plain, two, 2);
  CHECK(one.str() == "watching 1 file; Ctrl-C ends it\n");
  CHECK(two.str() == "watching 2 files; Ctrl-C ends it\n");
}

TEST_CASE("automatic is the bar on a terminal only, and none is silent") {
  CHECK(contains(progress_of(ProgressMode::automatic, true, false), "\x1b[K"));
  CHECK_FALSE(contains(progress_of(ProgressMode::automatic, false, false), "\x1b[K"));
  CHECK(progress_of(ProgressMode::none, true, true) == "");
  CHECK(progress_mode_from("auto") == ProgressMode::automatic);
  CHECK_FALSE(progress_mode_from("loud"));
}
