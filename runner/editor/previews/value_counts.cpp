#include "runner/editor/previews/value_counts.h"

#include <algorithm>
#include <cmath>

namespace terrazzo {

namespace {

constexpr int64_t most_pixels_counted = int64_t{1} << 20;

}  // namespace

ValueCounts value_counts(const Image& image, int bins) {
  const int width = image.width(), height = image.height(), channels = image.channels();
  const int64_t rows = std::clamp<int64_t>(most_pixels_counted / std::max(width, 1), 1, height);
  std::vector<float> values(size_t(width) * size_t(channels) * size_t(rows));
  for (int64_t r = 0; r < rows; r++)
    image.read({0, int(r * height / rows), width, 1}, values.data() + r * width * channels);
  ValueCounts out;
  out.counts.assign(size_t(channels), std::vector<int64_t>(size_t(bins)));
  for (const float v : values)
    if (std::isfinite(v)) out.low = std::min(out.low, double(v)), out.high = std::max(out.high, double(v));
  const double scale = bins / (out.high - out.low);
  for (size_t i = 0; i < values.size(); i++)
    if (std::isfinite(values[i]))
      out.counts[i % size_t(channels)][size_t(std::clamp(int((values[i] - out.low) * scale), 0, bins - 1))]++;
  return out;
}

}  // namespace terrazzo
