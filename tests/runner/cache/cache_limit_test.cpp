#include "runner/cache/cache_limit.h"

#include <doctest/doctest.h>

#include "runner/cache/cache.h"
#include "tests/run_node.h"
#include "tests/runner/cache/environment.h"
#include "tests/runner/fakes.h"

using namespace terrazzo;
using namespace terrazzo::test;

TEST_CASE("the size of the cache is what is given, else what the environment says, else the folder's settings") {
  const TemporaryFolder folder;
  const auto settings = folder.path() / "settings.txt";
  const Environment none("TERRAZZO_CACHE_SIZE", "");
  CHECK(cache_limit(folder.path()).bytes == uint64_t{10} << 30);
  CHECK(cache_limit(folder.path()).from == "the default");
  write_text(settings, "# of the render farm\n\n  size = 2G  # two\n");
  CHECK(cache_limit(folder.path()).bytes == uint64_t{2} << 30);
  CHECK(cache_limit(folder.path()).from == settings.string());
  const Environment variable("TERRAZZO_CACHE_SIZE", "3M");
  CHECK(cache_limit(folder.path()).bytes == uint64_t{3} << 20);
  CHECK(Cache(folder.path()).limit() == uint64_t{3} << 20);
  CHECK(Cache(folder.path(), 7).limit() == 7);
}

TEST_CASE("a size that cannot be understood is said with the place where it stands") {
  const TemporaryFolder folder;
  const auto settings = folder.path() / "settings.txt";
  const Environment none("TERRAZZO_CACHE_SIZE", "");
  write_text(settings, "\nsize = lots\n");
  CHECK_THROWS_WITH_AS(cache_limit(folder.path()), doctest::Contains("settings.txt:2: size takes a number with a unit"),
                       Error);
  write_text(settings, "sice = 2G\n");
  CHECK_THROWS_WITH_AS(cache_limit(folder.path()),
                       doctest::Contains("settings.txt:1: unknown setting \"sice\" (did you mean \"size\"?)"), Error);
  const Environment variable("TERRAZZO_CACHE_SIZE", "3");
  CHECK_THROWS_WITH_AS(cache_limit(folder.path()), doctest::Contains("TERRAZZO_CACHE_SIZE takes a number with a unit"),
                       Error);
}
