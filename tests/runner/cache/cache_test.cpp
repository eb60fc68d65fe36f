#include "runner/cache/cache.h"

#include <csignal>
#include <cstdlib>
#include <fstream>

#include <doctest/doctest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/block_file/bytes.h"
#include "runner/cache/cache_folder.h"
#include "runner/cache/cache_records.h"
#include "test_paths.h"
#include "tests/run_node.h"
#include "tests/runner/cache/environment.h"
#include "tests/runner/cache/without_writing.h"
#include "tests/sample_values.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

StageRecord sample_record() {
  return {{{"index", {1, 2}}, {"space", {3, 4}}}, {"found 4 maps"}, {{"out/a.png", 77, {5, 6}}}, 1.5};
}

int64_t entries(const std::filesystem::path& folder) {
  return std::distance(std::filesystem::recursive_directory_iterator(folder),
                       std::filesystem::recursive_directory_iterator());
}

void flip_bit(const std::filesystem::path& path) {
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
  file.seekg(40);
  const int byte = file.get();
  file.seekp(40);
  file.put(char(byte ^ 16));
}

}  // namespace

TEST_CASE("the default folder is where the environment says") {
  const Environment home("HOME", "/home/somebody");
  const Environment own("TERRAZZO_CACHE", "");
  {
    const Environment base("XDG_CACHE_HOME", "/var/caches");
    CHECK(Cache::default_folder() == "/var/caches/terrazzo");
    const Environment given("TERRAZZO_CACHE", "/big/disk");
    CHECK(Cache::default_folder() == "/big/disk");
  }
  const Environment relative("XDG_CACHE_HOME", "caches");
  CHECK(Cache::default_folder() == "/home/somebody/.cache/terrazzo");
}

TEST_CASE("what was stored is found by this and by a later cache object") {
  const TemporaryFolder folder;
  const std::vector<Value> values = sample_values();
  {
    Cache cache(folder.path() / "made" / "here");
    CHECK_FALSE(cache.find_stage({7, 7}));
    cache.store_stage({7, 7}, sample_record());
    for (const Value& v : values) {
      CHECK_FALSE(cache.has_value(digest_of(v)));
      CHECK_FALSE(cache.load_value(digest_of(v)));
      cache.store_value(v, 1, Task());
      CHECK(cache.has_value(digest_of(v)));
    }
    CHECK(cache.take_warnings().empty());
  }
  Cache cache(folder.path() / "made" / "here");
  const auto found = cache.find_stage({7, 7});
  REQUIRE(found);
  CHECK(found->outputs == sample_record().outputs);
  CHECK(found->notes == sample_record().notes);
  CHECK(found->seconds == 1.5);
  REQUIRE(found->files.size() == 1);
  CHECK(found->files[0].path == "out/a.png");
  CHECK(found->files[0].bytes == 77);
  CHECK(found->files[0].content == Digest{5, 6});
  for (const Value& v : values) {
    const auto loaded = cache.load_value(digest_of(v));
    REQUIRE(loaded);
    CHECK(same_content(*loaded, v));
  }
  const CacheStatus status = cache.status();
  CHECK(status.stages == 1);
  CHECK(status.values == int64_t(values.size()));
  CHECK(status.bytes > 0);
  CHECK(status.limit == uint64_t{10} << 30);
}

TEST_CASE("a stage may be stored again, and the last record counts") {
  const TemporaryFolder folder;
  Cache cache(folder.path());
  cache.store_stage({7, 7}, sample_record());
  cache.store_stage({7, 7}, {});
  REQUIRE(cache.find_stage({7, 7}));
  CHECK(cache.find_stage({7, 7})->outputs.empty());
  CHECK(cache.status().stages == 1);
}

TEST_CASE("a damaged entry is a miss, is removed with a warning, and can be stored anew") {
  const TemporaryFolder folder;
  Cache cache(folder.path());
  const CacheFolder layout(folder.path());
  const Value value = sample_values()[0];
  cache.store_stage({7, 7}, sample_record());
  cache.store_value(value, 1, Task());
  const auto stage_path = layout.path_of(EntryKind::stage, {7, 7});
  const auto value_path = layout.path_of(EntryKind::value, digest_of(value));
  flip_bit(stage_path);
  flip_bit(value_path);
  CHECK_FALSE(cache.find_stage({7, 7}));
  CHECK_FALSE(cache.load_value(digest_of(value)));
  CHECK(cache.take_warnings().size() == 2);
  CHECK_FALSE(std::filesystem::exists(stage_path));
  CHECK_FALSE(std::filesystem::exists(value_path));
  cache.store_value(value, 1, Task());
  REQUIRE(cache.load_value(digest_of(value)));
}

TEST_CASE("a damaged value is replaced when the same is stored, though nobody has read it") {
  const TemporaryFolder folder;
  Cache cache(folder.path());
  const Value value = sample_values()[0];
  cache.store_value(value, 1, Task());
  flip_bit(CacheFolder(folder.path()).path_of(EntryKind::value, digest_of(value)));
  cache.store_value(value, 1, Task());
  CHECK(cache.load_value(digest_of(value)));
}

TEST_CASE("an entry under another's name is a miss, never a wrong value") {
  const TemporaryFolder folder;
  Cache cache(folder.path());
  const CacheFolder layout(folder.path());
  const std::vector<Value> values = sample_values();
  for (const Value& v : values) cache.store_value(v, 1, Task());
  std::filesystem::copy_file(layout.path_of(EntryKind::value, digest_of(values[0])),
                             layout.path_of(EntryKind::value, digest_of(values[1])),
                             std::filesystem::copy_options::overwrite_existing);
  CHECK_FALSE(cache.load_value(digest_of(values[1])));
  cache.store_stage({7, 7}, sample_record());
  cache.store_stage({7, 8}, {});
  std::filesystem::copy_file(layout.path_of(EntryKind::stage, {7, 7}), layout.path_of(EntryKind::stage, {7, 8}),
                             std::filesystem::copy_options::overwrite_existing);
  CHECK_FALSE(cache.find_stage({7, 8}));
}

TEST_CASE("a stage record is refused when truncated at any length or with any bit flipped") {
  std::vector<uint8_t> bytes = stage_to_bytes({7, 7}, sample_record());
  CHECK(stage_from_bytes({7, 7}, bytes).outputs == sample_record().outputs);
  for (size_t size = 0; size < bytes.size(); size++)
    REQUIRE_THROWS_AS(stage_from_bytes({7, 7}, {bytes.begin(), bytes.begin() + ptrdiff_t(size)}), DamagedFile);
  for (size_t bit = 0; bit < bytes.size() * 8; bit++) {
    bytes[bit / 8] ^= uint8_t(1 << bit % 8);
    REQUIRE_THROWS_AS(stage_from_bytes({7, 7}, bytes), DamagedFile);
    bytes[bit / 8] ^= uint8_t(1 << bit % 8);
  }
}

TEST_CASE("verify finds and removes what is damaged and nothing else") {
  const TemporaryFolder folder;
  Cache cache(folder.path());
  const CacheFolder layout(folder.path());
  const std::vector<Value> values = sample_values();
  for (const Value& v : values) cache.store_value(v, 1, Task());
  cache.store_stage({7, 7}, sample_record());
  cache.store_stage({7, 8}, sample_record());
  CHECK(cache.verify(Task()).damaged.empty());
  flip_bit(layout.path_of(EntryKind::stage, {7, 8}));
  flip_bit(layout.path_of(EntryKind::value, digest_of(values[2])));
  const std::vector<std::string> found = cache.verify(Task()).damaged;
  REQUIRE(found.size() == 2);
  CHECK(found[0].find(digest_of(values[2]).hex()) != std::string::npos);
  CHECK(cache.status().values == int64_t(values.size()) - 1);
  CHECK(cache.status().stages == 1);
  CHECK(cache.verify(Task()).damaged.empty());
}

TEST_CASE("a cache folder that cannot be made is an error") {
  const TemporaryFolder folder;
  write_text(folder.path() / "file", "");
  CHECK_THROWS_WITH_AS(Cache(folder.path() / "file"), doctest::Contains("cannot make the cache folder"), Error);
}

TEST_CASE("a cache that may only be read serves what it has, and says once that it keeps nothing") {
  const TemporaryFolder folder;
  std::filesystem::permissions(folder.path(), std::filesystem::perms(0755));
  const std::vector<Value> values = sample_values();
  Cache(folder.path()).store_value(values[0], 1, Task());
  std::vector<std::string> warnings;
  {
    const WithoutWriting nothing_can_be_written(folder.path());
    Cache cache(folder.path());
    cache.store_value(values[1], 1, Task());
    cache.store_value(values[2], 1, Task());
    cache.store_stage({7, 7}, sample_record());
    CHECK(cache.load_value(digest_of(values[0])));
    CHECK_FALSE(cache.has_value(digest_of(values[1])));
    warnings = cache.take_warnings();
    CHECK(cache.clear() == 0);
  }
  REQUIRE(warnings.size() == 1);
  CHECK(warnings[0].find("Permission denied") != std::string::npos);
}

TEST_CASE("a value that does not fit on the disk is a warning and leaves nothing behind") {
  const TemporaryFolder folder;
  Cache cache(folder.path());
  const Value value = sample_image({100, 100});
  rlimit old;
  REQUIRE(::getrlimit(RLIMIT_FSIZE, &old) == 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{1000, old.rlim_max};
  REQUIRE(::setrlimit(RLIMIT_FSIZE, &small) == 0);
  cache.store_value(value, 1, Task());
  ::setrlimit(RLIMIT_FSIZE, &old);
  std::signal(SIGXFSZ, handler);
  CHECK(cache.take_warnings().size() == 1);
  CHECK(cache.status().bytes == 0);
  cache.store_value(value, 1, Task());
  CHECK(cache.has_value(digest_of(value)));
}

TEST_CASE("a file's digest follows its content, not its times") {
  const TemporaryFolder folder, cache_folder;
  Cache cache(cache_folder.path());
  const auto path = folder.path() / "map.png";
  write_text(path, "one");
  const Digest one = cache.file_digest(path);
  CHECK(one == file_content_digest(path));
  std::filesystem::last_write_time(path, std::filesystem::file_time_type::clock::now() - std::chrono::hours(5));
  CHECK(cache.file_digest(path) == one);
  const auto time = std::filesystem::last_write_time(path);
  write_text(path, "two");
  std::filesystem::last_write_time(path, time);
  const Digest two = cache.file_digest(path);
  CHECK(two != one);
  CHECK(two == file_content_digest(path));
  std::filesystem::remove(path);
  const Digest missing = cache.file_digest(path);
  CHECK(missing != two);
  CHECK(missing == cache.file_digest(folder.path()));
  CHECK(missing == file_content_digest(folder.path() / "none"));
  CHECK(cache.take_warnings().empty());
}

TEST_CASE("a file that has just changed is not memoised, an older one is") {
  const TemporaryFolder folder, cache_folder;
  Cache cache(cache_folder.path());
  write_text(folder.path() / "new", "new");
  cache.file_digest(folder.path() / "new");
  CHECK(entries(cache_folder.path() / "v1" / "files") == 0);
  const std::filesystem::path old = std::filesystem::path(TERRAZZO_SOURCE_DIR) / "LICENSE";
  const Digest digest = cache.file_digest(old);
  CHECK(digest == file_content_digest(old));
  CHECK(entries(cache_folder.path() / "v1" / "files") == 2);
  CHECK(cache.file_digest(old) == digest);
}

TEST_CASE("a memo is believed only if size, times and inode are the same") {
  const TemporaryFolder folder, cache_folder;
  Cache cache(cache_folder.path());
  CacheFolder layout(cache_folder.path());
  const auto path = folder.path() / "map.png";
  write_text(path, "content");
  struct stat status;
  REQUIRE(::stat(path.c_str(), &status) == 0);
  const auto ns = [](const timespec& t) { return int64_t{t.tv_sec} * ns_per_second + t.tv_nsec; };
  const FileStamp stamp{uint64_t(status.st_size), ns(status.st_mtim), ns(status.st_ctim), uint64_t(status.st_ino)};
  const Digest name = Hasher().add(path.native()).digest(), told{1, 2};
  const auto memo_path = layout.path_of(EntryKind::file, name);
  const auto asked = [&](const FileStamp& s) {
    layout.write(memo_path, memo_to_bytes(name, {s, told}), "test", false);
    return cache.file_digest(path);
  };
  CHECK(asked(stamp) == told);
  const Digest content = file_content_digest(path);
  FileStamp other = stamp;
  other.bytes++;
  CHECK(asked(other) == content);
  other = stamp;
  other.modified_ns++;
  CHECK(asked(other) == content);
  other = stamp;
  other.changed_ns++;
  CHECK(asked(other) == content);
  other = stamp;
  other.inode++;
  CHECK(asked(other) == content);
  CHECK(asked(stamp) == told);
  flip_bit(memo_path);
  CHECK(cache.file_digest(path) == content);
}
