#include "core/file/path_relation.h"

#include <doctest/doctest.h>

using namespace terrazzo;

TEST_CASE("what lies in a folder is told by names") {
  CHECK(lies_in("/a/b", "/a/b"));
  CHECK(lies_in("/a/b", "/a/b/c/d.png"));
  CHECK(lies_in("a", "a/..b"));
  CHECK_FALSE(lies_in("/a/b", "/a"));
  CHECK_FALSE(lies_in("/a/b", "/a/bc"));
  CHECK_FALSE(lies_in("/a/b", "/a/b/../c"));
  CHECK_FALSE(lies_in("/a/b", "a/b"));
}
