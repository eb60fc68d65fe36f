#include "core/synthesis/steps/course_sequence.h"

#include <numeric>
#include <utility>

#include "core/base/geometry.h"
#include "core/base/hash.h"

namespace terrazzo {

std::vector<int> random_sequence(const std::vector<int>& joints, int around, int length, int step, uint64_t bits) {
  const auto count = int(joints.size());
  std::vector<int> order(joints.size()), out;
  std::iota(order.begin(), order.end(), 0);
  uint64_t drawn = 0;
  const auto draw = [&](int n) { return int(below(uint32_t(more_random_bits(bits, drawn++)), uint32_t(n))); };
  const auto shuffle = [&] {
    const int last = order.back();
    for (int i = count - 1; i > 0; i--) std::swap(order[size_t(i)], order[size_t(draw(i + 1))]);
    if (order.front() == last) std::swap(order.front(), order.back());
  };
  shuffle();
  for (int at = 0; int(out.size()) < length; at = (at + 1) % count) {
    if (at == 0 && !out.empty()) shuffle();
    const int begin = joints[size_t(order[size_t(at)])], next = joints[size_t((order[size_t(at)] + 1) % count)];
    const int end = next > begin ? next : next + around;
    // The result's border cuts the first one anywhere.
    for (int u = begin + (out.empty() ? draw(end - begin) : 0); u < end && int(out.size()) < length; u += step)
      out.push_back(wrap(u, around));
  }
  return out;
}

}  // namespace terrazzo
