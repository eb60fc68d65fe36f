#include "core/exemplar/elements.h"

#include <cmath>
#include <set>
#include <vector>

namespace terrazzo {

int whole_elements(const Elements& elements, bool wraps) {
  if (wraps) return elements.count;
  std::set<uint16_t> cut;
  const auto width = size_t(elements.size.width), height = size_t(elements.size.height);
  for (size_t x = 0; x < width; x++) cut.insert({elements.at[x], elements.at[(height - 1) * width + x]});
  for (size_t y = 0; y < height; y++) cut.insert({elements.at[y * width], elements.at[y * width + width - 1]});
  return elements.count - int(cut.size());
}

double typical_side(const Elements& elements) {
  std::vector<int64_t> areas(size_t(elements.count));
  for (const uint16_t e : elements.at) areas[e]++;
  double squares = 0;
  for (const int64_t a : areas) squares += double(a) * double(a);
  return std::sqrt(squares / double(elements.at.size()));
}

}  // namespace terrazzo
