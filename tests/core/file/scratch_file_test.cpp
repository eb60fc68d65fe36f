#include "core/file/scratch_file.h"

#include <numeric>
#include <vector>

#include <doctest/doctest.h>

using namespace terrazzo;

namespace {
std::vector<int> counting_from(int first) {
  std::vector<int> out(1000);
  std::iota(out.begin(), out.end(), first);
  return out;
}
constexpr uint64_t bytes = 1000 * sizeof(int);
}  // namespace

TEST_CASE("a scratch file keeps what is written to it, uses room again and shrinks") {
  ScratchFile file;
  std::vector<uint64_t> places;
  for (int i = 0; i < 4; i++) {
    const auto at = file.take(bytes);
    REQUIRE(at);
    places.push_back(*at);
    file.write(*at, counting_from(i).data(), bytes);
  }
  const uint64_t full = file.size();
  CHECK(full == 4 * bytes);
  std::vector<int> found(1000);
  for (int i = 4; i-- > 0;) {
    file.read(places[i], found.data(), bytes);
    CHECK(found == counting_from(i));
  }
  file.give_back(places[1], bytes);
  file.give_back(places[2], bytes);
  const auto both = file.take(2 * bytes);
  REQUIRE(both);
  CHECK(*both == places[1]);
  CHECK(file.size() == full);
  file.read(places[3], found.data(), bytes);
  CHECK(found == counting_from(3));
  file.give_back(*both, 2 * bytes);
  file.give_back(places[3], bytes);
  CHECK(file.size() == bytes);
  file.give_back(places[0], bytes);
  CHECK(file.size() == 0);
}

TEST_CASE("a scratch file says when there is not as much room as is asked for") {
  ScratchFile file;
  CHECK(!file.take(uint64_t{1} << 62));
  const auto at = file.take(16);
  REQUIRE(at);
  CHECK(*at == 0);
}
