#include "core/base/hash.h"

#include <set>

#include <doctest/doctest.h>

using namespace terrazzo;

TEST_CASE("a digest survives the way to text and back") {
  const Digest d = Hasher().add("brick").add(3).digest();
  Digest back;
  REQUIRE(Digest::parse(d.hex(), back));
  CHECK(back == d);
  CHECK_FALSE(Digest::parse("xyz", back));
  CHECK_FALSE(Digest::parse(d.hex().substr(1) + "g", back));
}

TEST_CASE("texts are delimited, so joining them differently gives another digest") {
  CHECK(Hasher().add("ab").add("c").digest() != Hasher().add("a").add("bc").digest());
  CHECK(Hasher().add(0.0).digest() == Hasher().add(-0.0).digest());
}

TEST_CASE("random bits depend on every counter") {
  std::set<uint64_t> seen;
  for (int seed = 0; seed < 4; seed++)
    for (int x = 0; x < 16; x++)
      for (int y = 0; y < 16; y++) seen.insert(random_bits(seed, x, y));
  CHECK(seen.size() == 4 * 16 * 16);
}
