#include <chrono>
#include <fstream>

#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "core/file/atomic_file.h"
#include "runner/cache/cache.h"
#include "runner/cache/cache_folder.h"
#include "runner/cache/cache_pins.h"
#include "runner/plan/history.h"
#include "test_paths.h"
#include "tests/run_node.h"
#include "tests/runner/fakes.h"
#include "tests/sample_values.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

/// Values of one size, each of which cost one second more than the one before.
std::vector<Value> store_row(const std::filesystem::path& folder, int count) {
  std::vector<Value> values;
  Cache cache(folder);
  for (int i = 0; i < count; i++) {
    values.push_back(sample_image({20, 20}, i));
    cache.store_value(values.back(), i + 1, Task());
  }
  return values;
}

void make_older(const std::filesystem::path& path, int days) {
  std::filesystem::last_write_time(path, std::filesystem::file_time_type::clock::now() - std::chrono::hours(24 * days));
}

/// Which of the values are there, as a row of 0 and 1; pins nothing.
std::string present(const std::filesystem::path& folder, const std::vector<Value>& values) {
  std::string row;
  for (const Value& v : values)
    row += std::filesystem::exists(CacheFolder(folder).path_of(EntryKind::value, digest_of(v))) ? '1' : '0';
  return row;
}

}  // namespace

TEST_CASE("nothing is evicted within the limit") {
  const TemporaryFolder folder;
  const std::vector<Value> values = store_row(folder.path(), 4);
  CHECK(Cache(folder.path()).collect() == 0);
  CHECK(present(folder.path(), values) == "1111");
}

TEST_CASE("over the limit the values that are quickest to compute again go first, down to nine tenths") {
  const TemporaryFolder folder;
  const std::vector<Value> values = store_row(folder.path(), 10);
  const uint64_t bytes = Cache(folder.path()).status().bytes;
  Cache cache(folder.path(), bytes - 1);
  CHECK(cache.collect() >= bytes / 10);
  CHECK(present(folder.path(), values).substr(0, 3) == "001");
  CHECK(cache.status().bytes <= (bytes - 1) * 9 / 10);
  Cache half(folder.path(), bytes / 2);
  half.collect();
  CHECK(present(folder.path(), values) == "0000001111");
}

TEST_CASE("a value loses half its worth with every week it is not used, and use makes it young again") {
  const TemporaryFolder folder;
  const std::vector<Value> values = store_row(folder.path(), 3);
  const CacheFolder layout(folder.path());
  const auto path_of = [&](int i) { return layout.path_of(EntryKind::value, digest_of(values[size_t(i)])); };
  make_older(path_of(2), 14);  // 3 s count as 0.75 s
  make_older(path_of(0), 14);
  CHECK(Cache(folder.path()).has_value(digest_of(values[0])));  // 1 s
  const uint64_t bytes = Cache(folder.path()).status().bytes;
  Cache(folder.path(), bytes - 1).collect();
  CHECK(present(folder.path(), values) == "110");
}

TEST_CASE("a large value goes before a small one that took as long") {
  const TemporaryFolder folder;
  const std::vector<Value> values = {sample_image({20, 20}), sample_image({60, 60})};
  for (const Value& v : values) Cache(folder.path()).store_value(v, 1, Task());
  const uint64_t bytes = Cache(folder.path()).status().bytes;
  Cache(folder.path(), bytes - 1).collect();
  CHECK(present(folder.path(), values) == "10");
}

TEST_CASE("what a living cache object has asked for is neither collected nor cleared") {
  const TemporaryFolder folder;
  const std::vector<Value> values = store_row(folder.path(), 4);
  {
    Cache user(folder.path());
    CHECK(user.has_value(digest_of(values[0])));
    CHECK(user.load_value(digest_of(values[2])));
    Cache(folder.path(), 1).collect();
    CHECK(present(folder.path(), values) == "1010");
    Cache(folder.path()).clear();
    CHECK(present(folder.path(), values) == "1010");
    CHECK(user.load_value(digest_of(values[0])));
  }
  CHECK(Cache(folder.path()).clear() > 0);
  CHECK(present(folder.path(), values) == "0000");
  CHECK(std::filesystem::is_empty(folder.path() / "v1" / "pins"));
}

TEST_CASE("an image that was loaded can be pulled after its entry is gone") {
  const TemporaryFolder folder;
  const ImagePtr image = sample_image({900, 700});
  Cache(folder.path()).store_value(image, 1, Task());
  const auto loaded = Cache(folder.path()).load_value(image->digest());
  REQUIRE(loaded);
  CHECK(Cache(folder.path()).clear() > 1000000);
  CHECK(same_content(*loaded, image));
}

TEST_CASE("clearing leaves an empty, usable cache") {
  const TemporaryFolder folder;
  const std::vector<Value> values = store_row(folder.path(), 2);
  {
    Cache cache(folder.path());
    cache.store_stage({1, 1}, {{{"image", digest_of(values[0])}}, {}, {}, 1});
    cache.file_digest(std::filesystem::path(TERRAZZO_SOURCE_DIR) / "LICENSE");
  }
  Cache cache(folder.path());
  const uint64_t bytes = cache.status().bytes;
  CHECK(cache.clear() == bytes);
  CHECK(cache.status().bytes == 0);
  CHECK(cache.status().stages == 0);
  cache.store_value(values[0], 1, Task());
  CHECK(cache.has_value(digest_of(values[0])));
}

TEST_CASE("clearing keeps the record of a stage whose value is in use") {
  const TemporaryFolder folder;
  const std::vector<Value> values = store_row(folder.path(), 2);
  Cache user(folder.path());
  user.store_stage({1, 1}, {{{"image", digest_of(values[0])}}, {}, {}, 1});
  user.store_stage({1, 2}, {{{"image", digest_of(values[1])}}, {}, {}, 1});
  CHECK(user.has_value(digest_of(values[0])));
  Cache(folder.path()).clear();
  CHECK(user.find_stage({1, 1}));
  CHECK_FALSE(user.find_stage({1, 2}));
}

TEST_CASE("records of stages outlive their values for a month after their last use") {
  const TemporaryFolder folder;
  const std::vector<Value> values = store_row(folder.path(), 1);
  const CacheFolder layout(folder.path());
  Cache cache(folder.path());
  for (uint64_t key : {1, 2, 3}) cache.store_stage({key, 0}, {{{"image", {9, 9}}}, {}, {}, 1});
  cache.store_stage({4, 0}, {{{"image", digest_of(values[0])}}, {}, {}, 1});
  for (uint64_t key : {2, 3, 4}) make_older(layout.path_of(EntryKind::stage, {key, 0}), 40);
  CHECK(cache.find_stage({3, 0}));
  cache.collect();
  CHECK(cache.find_stage({1, 0}));
  CHECK_FALSE(cache.find_stage({2, 0}));
  CHECK(cache.find_stage({3, 0}));
  CHECK(cache.find_stage({4, 0}));
}

TEST_CASE("what a dead process left half-written is removed, what a living one writes is not") {
  const TemporaryFolder folder;
  Cache cache(folder.path());
  const auto values = folder.path() / "v1" / "values" / "ab";
  std::filesystem::create_directories(values);
  const auto dead = values / "elsewhere-123-0-7.tmp";
  std::ofstream(dead) << "half a value";
  std::string living;
  for (const auto& pin : std::filesystem::directory_iterator(folder.path() / "v1" / "pins"))
    living = pin.path().filename().string();
  std::ofstream(values / (living + "-7.tmp")) << "half a value";
  CHECK(cache.collect() == 12);
  CHECK_FALSE(std::filesystem::exists(dead));
  CHECK(std::filesystem::exists(values / (living + "-7.tmp")));
}

TEST_CASE(
    "the pins of a dead process go, though nothing else is to be removed; those that may be of a living one stay") {
  const TemporaryFolder folder;
  Cache cache(folder.path());
  const auto pins = folder.path() / "v1" / "pins";
  const std::string mine = std::filesystem::directory_iterator(pins)->path().filename();
  const std::string host = mine.substr(0, mine.rfind('-', mine.rfind('-') - 1));
  for (const std::string& name : {host + "-123-7", std::string("elsewhere-123-0"), std::string("elsewhere-123-1")})
    std::ofstream(pins / name) << "some digest      ";
  make_older(pins / "elsewhere-123-1", 2);
  cache.collect();
  CHECK(listing(pins).size() == 2);
  CHECK(std::filesystem::exists(pins / "elsewhere-123-0"));
  make_older(pins / "elsewhere-123-0", 2);
  cache.clear();
  CHECK(listing(pins) == std::vector<std::string>{mine});
}

TEST_CASE("the record of a stage goes with the last of its values, and what needs no value goes by age if need be") {
  const TemporaryFolder folder;
  const std::vector<Value> values = store_row(folder.path(), 10);
  const CacheFolder layout(folder.path());
  {
    Cache cache(folder.path());
    for (uint64_t i = 0; i < 10; i++) cache.store_stage({i, 0}, {{{"image", digest_of(values[i])}}, {}, {}, 1});
    cache.store_stage({20, 0}, {{{"image", digest_of(values[0])}, {"other", digest_of(values[9])}}, {}, {}, 1});
    cache.store_stage({30, 0}, {{{"image", {9, 9}}}, {}, {}, 1});
  }
  const auto is_there = [&](uint64_t key) {
    return std::filesystem::exists(layout.path_of(EntryKind::stage, {key, 0}));
  };
  Cache(folder.path(), layout.scan().bytes() / 2).collect();
  for (uint64_t i = 0; i < 10; i++)
    CHECK(is_there(i) == std::filesystem::exists(layout.path_of(EntryKind::value, digest_of(values[i]))));
  CHECK_FALSE(is_there(0));
  CHECK(is_there(9));
  CHECK(is_there(20));
  CHECK(is_there(30));
  for (const uint64_t i : {40, 41}) Cache(folder.path()).store_stage({i, 0}, {{}, {}, {}, 1});
  make_older(layout.path_of(EntryKind::stage, {40, 0}), 20);
  make_older(layout.path_of(EntryKind::stage, {30, 0}), 10);
  uint64_t newest = 0;
  for (const CacheEntry& e : layout.scan().entries)
    if (e.name == Digest{41, 0}) newest = e.bytes;
  Cache(folder.path(), newest * 10 / 8).collect();
  CHECK(is_there(41));
  CHECK_FALSE(is_there(40));
  CHECK_FALSE(is_there(30));
}

TEST_CASE("histories count, are verified, and go after a month without use; so do what killed processes left of them") {
  const TemporaryFolder folder;
  Cache cache(folder.path());
  FakeTypes t;
  Graph g = small_graph(t);
  RunOptions options = keeping({"total"}, &cache);
  std::vector<std::filesystem::path> files;
  for (const char* name : {"one.json", "two.json"}) {
    History history(folder.path(), folder.path() / name);
    options.history = &history;
    REQUIRE(run_graph(g, options).ok());
  }
  const std::filesystem::path histories = folder.path() / "history";
  for (const auto& e : std::filesystem::directory_iterator(histories)) files.push_back(e.path());
  REQUIRE(files.size() == 2);
  CHECK(cache.status().histories == 2);
  CHECK(cache.status().bytes >= std::filesystem::file_size(files[0]) + std::filesystem::file_size(files[1]));
  CHECK(cache.verify(Task()).damaged.empty());

  const std::filesystem::path left = temporary_beside(histories / "three.txt");
  const std::string mine = "-" + std::to_string(::getpid()) + "-";
  std::string dead = left.filename().string();
  dead.replace(dead.find(mine), mine.size(), "-999999999-");
  std::ofstream(histories / dead) << "half a history";
  std::ofstream(left) << "half a history";
  make_older(files[0], 40);
  cache.collect();
  CHECK_FALSE(std::filesystem::exists(files[0]));
  CHECK(std::filesystem::exists(files[1]));
  CHECK_FALSE(std::filesystem::exists(histories / dead));
  CHECK(std::filesystem::exists(left));

  std::fstream(files[1], std::ios::in | std::ios::out).seekp(60) << "?";
  const CacheVerdict verdict = cache.verify(Task());
  REQUIRE(verdict.damaged.size() == 1);
  CHECK(verdict.damaged[0].find("its checksum is wrong") != std::string::npos);
  CHECK(cache.status().histories == 0);
}

TEST_CASE("a graph that is run again keeps its history young") {
  const TemporaryFolder folder;
  Cache cache(folder.path());
  FakeTypes t;
  RunOptions options = keeping({"total"}, &cache);
  {
    History history(folder.path(), folder.path() / "one.json");
    options.history = &history;
    REQUIRE(run_graph(small_graph(t), options).ok());
  }
  for (const auto& e : std::filesystem::directory_iterator(folder.path() / "history")) make_older(e.path(), 40);
  CHECK(History(folder.path(), folder.path() / "one.json").seconds("total"));
  cache.collect();
  CHECK(cache.status().histories == 1);
}

TEST_CASE("a process that is stopped while it holds the folder's lock does not hold up others for ever") {
  const TemporaryFolder folder;
  const std::vector<Value> values = store_row(folder.path(), 1);
  const File stopped = File::open(CacheFolder(folder.path()).lock(), O_RDWR | O_CREAT);
  REQUIRE(lock_file(stopped, LOCK_EX));
  CHECK_FALSE(
      lock_file_soon(File::open(CacheFolder(folder.path()).lock(), O_RDWR), LOCK_SH, std::chrono::milliseconds(20)));
}
