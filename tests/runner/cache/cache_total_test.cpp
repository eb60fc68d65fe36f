#include "runner/cache/cache_total.h"

#include <chrono>
#include <fstream>

#include <doctest/doctest.h>

#include "core/base/processes.h"
#include "runner/cache/cache.h"
#include "runner/cache/cache_folder.h"
#include "tests/run_node.h"
#include "tests/runner/cache/without_writing.h"
#include "tests/runner/fakes.h"
#include "tests/sample_values.h"

/// The running total, which spares runs a look at every entry.
using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

constexpr int count = 20;

/// A cache of some values and records, whose size has been counted.
struct Counted {
  TemporaryFolder folder;
  CacheFolder layout{folder.path()};

  Counted() {
    fs::permissions(folder.path(), fs::perms(0755));
    Cache cache(folder.path());
    for (int i = 0; i < count; i++) {
      const Value value = sample_image({20, 20}, i);
      cache.store_value(value, i + 1, Task());
      cache.store_stage({uint64_t(i), 0}, {{{"image", digest_of(value)}}, {}, {}, 1});
    }
    CHECK(cache.collect_if_due().looked_at == 2 * count);
  }
  uint64_t bytes() const { return layout.scan().bytes(); }
  size_t looked_at(uint64_t limit = 0) const { return Cache(folder.path(), limit).collect_if_due().looked_at; }
};

}  // namespace

TEST_CASE("runs look at no entry as long as their total is below the limit") {
  const Counted c;
  CHECK(c.looked_at() == 0);
  {
    Cache cache(c.folder.path());
    cache.store_value(sample_image({30, 30}, 100), 1, Task());
    cache.store_stage({100, 0}, {{}, {}, {}, 1});
    CHECK(cache.collect_if_due().looked_at == 0);
  }
  REQUIRE(read_total(c.layout.total()));
  CHECK(read_total(c.layout.total())->bytes == c.bytes());
  CHECK(c.looked_at(c.bytes()) == 0);
}

TEST_CASE("what a run writes beyond the limit makes it evict, and the total right again") {
  const Counted c;
  const uint64_t limit = c.bytes();
  Cache cache(c.folder.path(), limit);
  cache.store_stage({100, 0}, {{}, {}, {}, 1});
  const CacheCollection done = cache.collect_if_due();
  CHECK(done.looked_at == 2 * count + 1);
  CHECK(done.freed > 0);
  CHECK(c.bytes() <= limit * 9 / 10);
  CHECK(read_total(c.layout.total())->bytes == c.bytes());
}

TEST_CASE(
    "the entries are counted if the total is missing, damaged, a day old or of the future, and if a process died") {
  const Counted c;
  const auto set = [&](int64_t age_hours) {
    write_total(c.layout.total(), {1000, now_ns() - age_hours * 3600 * ns_per_second}, "me");
  };
  set(23);
  CHECK(c.looked_at() == 0);
  set(25);
  CHECK(c.looked_at() == 2 * count);
  CHECK(read_total(c.layout.total())->bytes == c.bytes());
  set(-1);
  CHECK(c.looked_at() == 2 * count);
  write_text(c.layout.total(), "TZTOTAL1");
  CHECK(c.looked_at() == 2 * count);
  fs::remove(c.layout.total());
  CHECK(c.looked_at() == 2 * count);
  CHECK(c.looked_at() == 0);
  const std::string host = host_name();
  write_text(c.layout.pins() / (host + "-123-7"), "");
  const fs::path left = c.layout.root() / "values" / "ab" / (host + "-123-7-1.tmp");
  fs::create_directories(left.parent_path());
  write_text(left, "half a value");
  CHECK(c.looked_at() == 2 * count);
  CHECK_FALSE(fs::exists(left));
}

TEST_CASE("in a cache that may only be read nothing is looked at") {
  const Counted c;
  fs::remove(c.layout.total());
  const WithoutWriting nothing_can_be_written(c.folder.path());
  CHECK(c.looked_at() == 0);
}

TEST_CASE("verify says of a damaged entry whether it has been removed") {
  const Counted c;
  const fs::path entry = c.layout.path_of(EntryKind::stage, {3, 0});
  write_text(entry, "not a record");
  {
    const WithoutWriting nothing_can_be_written(c.folder.path());
    Cache cache(c.folder.path());
    const CacheVerdict verdict = cache.verify(Task());
    REQUIRE(verdict.damaged.size() == 1);
    CHECK(verdict.left == 1);
    CHECK(verdict.damaged[0].find(entry.string()) == 0);
    CHECK(verdict.damaged[0].find("; it cannot be removed: Permission denied") != std::string::npos);
    cache.take_warnings();
    CHECK_FALSE(cache.find_stage({3, 0}));
    REQUIRE(cache.take_warnings().size() == 1);
  }
  CHECK(fs::exists(entry));
  const CacheVerdict verdict = Cache(c.folder.path()).verify(Task());
  CHECK(verdict.damaged.size() == 1);
  CHECK(verdict.left == 0);
  CHECK_FALSE(fs::exists(entry));
}
