#include "core/numeric/leaf_distances.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <hwy/targets.h>

#include "core/base/hash.h"

using namespace terrazzo;

TEST_CASE("every instruction set gives a leaf's distances, to the bit, unless all are beyond the limit") {
  for (const int dimensions : {1, 8, 24, 27}) {
    CAPTURE(dimensions);
    std::vector<float> values(size_t(dimensions) * leaf_points), query(static_cast<size_t>(dimensions));
    for (size_t i = 0; i < values.size(); i++) values[i] = float(unit_double(random_bits(1, i)));
    for (size_t i = 0; i < query.size(); i++) query[i] = float(unit_double(random_bits(2, i)));
    std::array<float, leaf_points> expected{};
    for (size_t k = 0; k < query.size(); k++)
      for (size_t i = 0; i < leaf_points; i++) {
        const float apart = values[k * leaf_points + i] - query[k];
        expected[i] += apart * apart;
      }
    const float least = *std::ranges::min_element(expected);
    for (int64_t left = hwy::SupportedTargets(); left != 0; left &= left - 1) {
      hwy::SetSupportedTargetsForTest(left & -left);
      CAPTURE(std::string(hwy::TargetName(left & -left)));
      std::array<float, leaf_points> found{};
      CHECK(leaf_distances(values.data(), query.data(), dimensions, least, found.data()));
      CHECK(found == expected);
      CHECK_FALSE(leaf_distances(values.data(), query.data(), dimensions, 0.99f * least, found.data()));
    }
    hwy::SetSupportedTargetsForTest(0);
  }
}
