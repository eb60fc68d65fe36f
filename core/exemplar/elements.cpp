#include "core/exemplar/elements.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace terrazzo {

std::vector<uint8_t> cut_elements(const Elements& elements, bool wraps) {
  std::vector<uint8_t> out(size_t(elements.count), 0);
  if (wraps) return out;
  const auto width = size_t(elements.size.width), height = size_t(elements.size.height);
  for (size_t x = 0; x < width; x++) out[elements.at[x]] = out[elements.at[(height - 1) * width + x]] = 1;
  for (size_t y = 0; y < height; y++) out[elements.at[y * width]] = out[elements.at[y * width + width - 1]] = 1;
  return out;
}

int whole_elements(const Elements& elements, bool wraps) {
  return int(std::ranges::count(cut_elements(elements, wraps), 0));
}

double typical_side(const Elements& elements) {
  std::vector<int64_t> areas(size_t(elements.count));
  for (const uint16_t e : elements.at) areas[e]++;
  double squares = 0;
  for (const int64_t a : areas) squares += double(a) * double(a);
  return std::sqrt(squares / double(elements.at.size()));
}

}  // namespace terrazzo
