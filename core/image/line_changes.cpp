#include "core/image/line_changes.h"

#include <algorithm>
#include <array>
#include <vector>

namespace terrazzo {

LineChanges line_changes(const Planes& image, bool rows, int side, const Task& task) {
  const int length = rows ? image.size.width : image.size.height, count = rows ? image.size.height : image.size.width;
  const std::array<int, 3> runs = {1, std::max(1, side / 16), std::max(1, side / 2)};
  const int lines = count - (image.wraps ? 0 : 1);
  if (lines < 1 || length < runs.back()) return {};
  const auto channels = size_t(image.channels);
  const auto at = [&](int line, int place) { return rows ? image.at(place, line) : image.at(line, place); };
  // Sums of all changes before each place, around the border.
  std::vector<double> before(size_t(length + runs.back() + 1) * channels, 0.0);
  std::array<double, 3> sums{};
  for (int line = 0; line < lines; line++) {
    task.check();
    for (int i = 0; i < length + runs.back(); i++) {
      const float *a = at(line, i % length), *b = at((line + 1) % count, i % length);
      for (size_t c = 0; c < channels; c++)
        before[size_t(i + 1) * channels + c] = before[size_t(i) * channels + c] + (double(b[c]) - double(a[c]));
    }
    for (size_t k = 0; k < runs.size(); k++) {
      const int starts = image.wraps ? length : length - runs[k] + 1;
      const size_t run = size_t(runs[k]) * channels;
      double sum = 0;
      for (size_t i = 0; i < size_t(starts) * channels; i++) {
        const double change = before[i + run] - before[i];
        sum += change * change;
      }
      sums[k] += sum / (double(starts) * runs[k] * runs[k] * lines);
    }
  }
  return {sums[0], sums[1], sums[2]};
}

}  // namespace terrazzo
