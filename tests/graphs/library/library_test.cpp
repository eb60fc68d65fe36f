#include "graphs/library/library.h"

#include <thread>

#include <doctest/doctest.h>

#include "core/file/file_io.h"
#include "core/node/serialize.h"
#include "tests/run_node.h"
#include "tests/sample_values.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

struct Place {
  TemporaryFolder folder;
  const fs::path& path = folder.path();
  Library library{{path / "own", path / "shared"}};

  Place() { fs::create_directories(path / "maps"); }

  /// An entry whose files wait to be added.
  LibraryEntry entry(const std::string& name, ValueType type = ValueType::index) const {
    static std::atomic<int> count = 0;
    LibraryEntry e;
    e.name = name;
    e.summary = "about \"" + name + "\"";
    e.tags = {"stone", "old"};
    const std::string file = std::to_string(count++);
    e.analysis = path / file;
    save_value(sample_values()[size_t(type)], e.analysis, Task());
    e.picture = path / (file + ".png");
    write_text(e.picture, "picture " + file);
    write_text(path / "maps/height.png", "pixels");
    e.material = path / "maps";
    e.files["height.png"] = *content_digest(path / "maps/height.png");
    e.versions["pca"] = 3;
    e.settings = {"weighted.weights.height=2"};
    e.maps = {"height"};
    e.size = {16, 12};
    e.added = "2026-11-25";
    return e;
  }
};

std::string message_of(const std::function<void()>& act) {
  try {
    act();
    return "";
  } catch (const Error& e) {
    return e.what();
  }
}

size_t count_files(const fs::path& folder) {
  size_t count = 0;
  for (const auto& f : fs::recursive_directory_iterator(folder))
    count += f.is_regular_file() && !f.path().filename().string().starts_with('.');
  return count;
}

}  // namespace

TEST_CASE("a library gives back what was added") {
  const Place p;
  p.library.add(p.entry("wall/rubble"), true);
  p.library.add(p.entry("sand"), true);
  std::vector<std::string> faults;
  const std::vector<LibraryEntry> all = p.library.entries(faults);
  CHECK(faults.empty());
  REQUIRE(all.size() == 2);
  CHECK(all[0].name == "sand");
  const LibraryEntry e = p.library.find("wall/rubble");
  const LibraryEntry given = p.entry("wall/rubble");
  CHECK(e.summary == given.summary);
  CHECK(e.tags == given.tags);
  CHECK(e.material == given.material);
  CHECK(e.files == given.files);
  CHECK(e.versions == given.versions);
  CHECK(e.settings == given.settings);
  CHECK(e.maps == given.maps);
  CHECK(e.size == given.size);
  CHECK(e.added == given.added);
  CHECK(e.content == content_digest(e.analysis));
  CHECK(e.analysis.parent_path() == p.path / "own/wall");
  CHECK(Library::faults_of(e).empty());
}

TEST_CASE("an entry is replaced with its files, and removed with them and its folders") {
  const Place p;
  p.library.add(p.entry("wall/rubble"), true);
  const LibraryEntry old = p.library.find("wall/rubble");
  LibraryEntry other = p.entry("wall/rubble");
  save_value(sample_values()[size_t(ValueType::index)], other.analysis, Task(), 7);  // the same with another duration
  p.library.add(other, true);
  CHECK(p.library.find("wall/rubble").content != old.content);
  CHECK_FALSE(fs::exists(old.analysis));
  CHECK(count_files(p.path / "own") == 3);
  write_text(p.path / "own/wall/other.txt", "");
  p.library.remove("wall/rubble");
  CHECK(count_files(p.path / "own") == 1);
  p.library.add(p.entry("a/b/c"), true);
  write_text(p.path / "own/a/b/c.json", "{");  // one that cannot be read goes as well
  p.library.remove("a/b/c");
  CHECK_FALSE(fs::exists(p.path / "own/a"));
  CHECK(contains(message_of([&] { p.library.remove("a/b/c"); }), "there is no analysis a/b/c"));
}

TEST_CASE("the first of several folders hides those after it") {
  const Place p;
  Library({p.path / "shared"}).add(p.entry("sand"), true);
  CHECK(p.library.find("sand").library == p.path / "shared");
  p.library.add(p.entry("sand"), true);
  CHECK(p.library.find("sand").library == p.path / "own");
  std::vector<std::string> faults;
  CHECK(p.library.entries(faults).size() == 1);
  CHECK(contains(message_of([&] { p.library.find("snad"); }), "did you mean \"sand\"?"));
}

TEST_CASE("names of entries stay inside the library") {
  const Place p;
  for (const char* name :
       {"", "/", "/x", "x/", "x//y", "..", "../x", "x/../y", ".x", "x/.y", "-x", "a b", "a@b", "a\\b"}) {
    CAPTURE(name);
    CHECK(contains(message_of([&] { require_library_name(name); }), "cannot be the name of an entry"));
    CHECK(contains(message_of([&] { p.library.find(name); }), "cannot be the name of an entry"));
  }
  for (const char* name : {"x", "x/y", "x-1/y_2.3", "A"})
    CHECK(message_of([&] { require_library_name(name); }).empty());
}

TEST_CASE("faults of entries are found") {
  const Place p;
  p.library.add(p.entry("sand"), true);
  const LibraryEntry e = p.library.find("sand");
  const auto faults = [&] {
    std::string out;
    for (const std::string& f : Library::faults_of(e)) out += f + "\n";
    return out;
  };
  write_text(p.path / "maps/height.png", "other pixels");
  CHECK(contains(faults(), "height.png has changed"));
  fs::remove(p.path / "maps/height.png");
  CHECK(contains(faults(), "height.png has gone"));
  fs::remove_all(p.path / "maps");
  CHECK(contains(faults(), "what was analysed does not exist"));
  fs::remove(e.picture);
  CHECK(contains(faults(), "its picture is missing"));
  write_text(e.analysis, "damage");
  CHECK(contains(faults(), "its analysis is damaged"));
  fs::remove(e.analysis);
  CHECK(contains(faults(), "cannot be read"));
  fs::create_directories(p.path / "maps");
  p.library.add(p.entry("no-index", ValueType::uv_map), true);
  CHECK(Library::faults_of(p.library.find("no-index")).front() == "its analysis is no index");
}

TEST_CASE("an entry that somebody has changed by hand is named with what is wrong") {
  const Place p;
  p.library.add(p.entry("sand"), true);
  const fs::path file = p.path / "own/sand.json";
  const std::string good = read_text(file);
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    REQUIRE(contains(text, from));
    write_text(file, text.replace(text.find(from), from.size(), to));
    std::vector<std::string> faults;
    CHECK(p.library.entries(faults).empty());
    REQUIRE(faults.size() == 1);
    CHECK(contains(faults.front(), file.string()));
    return faults.front();
  };
  CHECK(contains(changed("\"terrazzo_library\": 1", "\"terrazzo_library\": 2"), "format version is 2"));
  CHECK(contains(changed("\"analysis\": \"sand", "\"analysis\": \"../sand"), "the name of a file beside it"));
  CHECK(contains(changed("\"content\": \"", "\"content\": \"x"), "a digest of 32 digits"));
  CHECK(contains(changed("\"summary\"", "\"sumary\""), "summary"));
  CHECK(contains(changed("[\n    16", "[\n    \"a\""), "number"));
  changed("}", "");
}

TEST_CASE("of several that replace an entry at once, one is there with its analysis") {
  const Place p;
  // Contents that come and go: what one replaces is what another has just brought.
  const auto add = [&](int content) {
    LibraryEntry e = p.entry("sand");
    save_value(sample_values()[size_t(ValueType::index)], e.analysis, Task(), content);
    p.library.add(e, true);
  };
  int without_analysis = 0;
  for (int round = 0; round < 60; round++) {
    std::vector<std::thread> adding;
    for (int t = 0; t < 3; t++) adding.emplace_back([&, t] { add((round + t) % 2); });
    for (std::thread& t : adding) t.join();
    const LibraryEntry e = p.library.find("sand");
    without_analysis += content_digest(e.analysis) != e.content || !fs::exists(e.picture);
  }
  CHECK(without_analysis == 0);
  CHECK(count_files(p.path / "own") == 3);
}

TEST_CASE("an entry that was added meanwhile is not replaced by one that may not") {
  const Place p;
  p.library.add(p.entry("sand"), false);
  CHECK(contains(message_of([&] { p.library.add(p.entry("sand"), false); }), "--force replaces it"));
}

TEST_CASE("processes that add and read one entry at once never see half of it") {
  const Place p;
  p.library.add(p.entry("sand"), true);
  std::vector<std::thread> writers;
  std::atomic<bool> done = false;
  std::atomic<int> failures = 0;
  for (int t = 0; t < 3; t++)
    writers.emplace_back([&, t] {
      for (int i = 0; i < 10; i++) {
        LibraryEntry e = p.entry("sand");
        save_value(sample_values()[size_t(ValueType::index)], e.analysis, Task(), t * 100 + i + 1);
        failures += !message_of([&] { p.library.add(e, true); }).empty();
      }
    });
  std::thread reader([&] {
    while (!done) failures += !message_of([&] { p.library.find("sand"); }).empty();
  });
  for (std::thread& t : writers) t.join();
  done = true;
  reader.join();
  CHECK(failures == 0);
  CHECK(Library::faults_of(p.library.find("sand")).empty());
}
