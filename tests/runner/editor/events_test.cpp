#include "runner/editor/events.h"

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

constexpr std::chrono::milliseconds at_once{0};

std::function<std::string()> saying(std::string text) {
  return [text = std::move(text)] { return text; };
}

}  // namespace

TEST_CASE("what is published while a stream begins comes after its beginning") {
  EventStreams events;
  const HttpStream tab = events.open("a", [&] {
    events.publish("state", "2", true);
    return EventStreams::formatted("state", "1");
  });
  CHECK(tab(at_once) == EventStreams::formatted("state", "1") + EventStreams::formatted("state", "2"));
}

TEST_CASE("a tab that is behind gets only the last of the events of which only the last counts") {
  EventStreams events;
  const HttpStream tab = events.open("a", saying("retry: 1\n\n"));
  CHECK(tab(at_once) == "retry: 1\n\n");
  CHECK(tab(at_once) == "");
  for (const char* revision : {"1", "2", "3"}) {
    events.publish("state", revision, true);
    events.publish("note", revision);
  }
  CHECK(tab(at_once) ==
        "event: note\ndata: 1\n\nevent: note\ndata: 2\n\nevent: state\ndata: 3\n\nevent: note\ndata: 3\n\n");
}

TEST_CASE("a tab that takes nothing is cut off, the others go on") {
  EventStreams events;
  const HttpStream slow = events.open("slow", saying("")), quick = events.open("quick", saying(""));
  for (int i = 0; i < 3000; i++) {
    events.publish("note", std::to_string(i));
    CHECK(quick(at_once).has_value());
  }
  CHECK(slow(at_once) == std::nullopt);
}

TEST_CASE("streams are counted while somebody holds them, and tabs leave with their last") {
  std::vector<std::string> left;
  EventStreams events([&](const std::string& tab) { left.push_back(tab); });
  HttpStream first = events.open("a", saying("")), second = events.open("a", saying(""));
  CHECK(first(at_once) == std::nullopt);
  first = {};
  CHECK(events.count() == 1);
  CHECK(left.empty());
  second = {};
  CHECK(events.count() == 0);
  CHECK(left == std::vector<std::string>{"a"});
  std::vector<HttpStream> all;
  for (size_t i = 0; i < EventStreams::most_streams; i++) all.push_back(events.open(std::to_string(i), saying("")));
  CHECK(!events.open("one more", saying("")));
  CHECK(events.open("0", saying("")));
  const HttpStream last = events.open("1", saying(""));
  events.close();
  CHECK(last(at_once) == "event: bye\ndata: {}\n\n");
  CHECK(last(at_once) == std::nullopt);
  CHECK(!events.open("later", saying("")));
}
