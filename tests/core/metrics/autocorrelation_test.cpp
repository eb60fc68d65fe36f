#include "core/metrics/autocorrelation.h"

#include <cmath>

#include <doctest/doctest.h>

#include "core/base/hash.h"

using namespace terrazzo;

namespace {

/// Channels of different strengths that repeat after eight pixels along x.
Planes striped(Size size, int channels) {
  Planes out = Planes::zeros(size, channels);
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++)
      for (int c = 0; c < channels; c++)
        out.at(x, y)[c] = float((c + 1) * ((x % 8 < 4 ? 1 : -1) + 0.5 * unit_double(random_bits(c, x, y)) - 0.25));
  return out;
}

}  // namespace

TEST_CASE("channels correlate together as each does, by its variance") {
  for (const int channels : {1, 2, 3}) {
    CAPTURE(channels);
    const Planes image = striped({40, 24}, channels);
    const Size lags{20, 12};
    const std::vector<Correlogram> each = correlograms(image, lags, Task());
    const Correlogram all = pooled_correlogram(image, lags, Task());
    std::vector<double> variance(size_t(channels), 0.0);
    double total = 0;
    for (size_t i = 0; i < image.values.size(); i++) {
      const double square = double(image.values[i]) * double(image.values[i]);
      variance[i % size_t(channels)] += square;
      total += square;
    }
    REQUIRE(all.values.size() == each[0].values.size());
    for (size_t i = 0; i < all.values.size(); i++) {
      double sum = 0;
      for (size_t c = 0; c < each.size(); c++) sum += each[c].values[i] * variance[c] / total;
      REQUIRE(all.values[i] == doctest::Approx(sum).epsilon(1e-6));
    }
    CHECK(all.at(8, 0) > 0.8);
    CHECK(all.at(4, 0) < -0.8);
  }
}
