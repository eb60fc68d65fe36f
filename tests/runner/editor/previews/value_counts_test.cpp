#include "runner/editor/previews/value_counts.h"

#include <limits>
#include <numeric>

#include <doctest/doctest.h>

#include "core/image/image.h"

using namespace terrazzo;

TEST_CASE("values are counted by channel, and the range covers all of them") {
  ImageInfo info;
  info.size = {4, 1};
  info.channels = 2;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const ImagePtr image = Image::from_floats(info, std::vector<float>{0, 1, 0.49f, 1, 0.51f, nan, 1, 3});
  const ValueCounts found = value_counts(*image, 4);
  CHECK(found.low == 0);
  CHECK(found.high == 3);
  CHECK(found.counts == std::vector<std::vector<int64_t>>{{3, 1, 0, 0}, {0, 2, 0, 1}});
}
