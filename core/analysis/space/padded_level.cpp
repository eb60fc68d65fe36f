#include "core/analysis/space/padded_level.h"

#include "core/base/tuning.h"
#include "core/numeric/distance_transform.h"

namespace terrazzo {

namespace {

struct PaddedLevelTuning {
  int coarse_side = 64;
};
const Tunable<PaddedLevelTuning> padded_level_tuning(
    "padded_level", {
                        {&PaddedLevelTuning::coarse_side, "coarse_side", "pixels",
                         "of a level, up to which places keep off the border by one pixel, not two. Higher: "
                         "more places; lower: windows see less of what is mirrored beyond the border",
                         "What each rule decides"},
                    });

/// The coordinate that one beyond the border shows.
int shown_at(int i, int length, bool wraps) {
  if (wraps) return wrap(i, length);
  const int last = length - 1;
  return std::clamp(i < 0 ? -i : i > last ? 2 * last - i : i, 0, last);
}

}  // namespace

PaddedLevel::PaddedLevel(const AppearanceLevel& level, bool wraps)
    : size_(level.size),
      wraps_(wraps),
      keep_off_(wraps                                                                               ? 0
                : std::min(level.size.width, level.size.height) <= padded_level_tuning->coarse_side ? 1
                                                                                                    : 2),
      masked_(!level.usable.empty()),
      stride_(level.size.width + 2 * margin) {
  vectors_.reserve(size_t(stride_) * (size_.height + 2 * margin));
  for (int y = -margin; y < size_.height + margin; y++)
    for (int x = -margin; x < size_.width + margin; x++) {
      const int u = shown_at(x, size_.width, wraps), v = shown_at(y, size_.height, wraps);
      vectors_.push_back(level.vectors[size_t(v) * size_.width + size_t(u)]);
    }
  if (!masked_) return;
  nearest_usable_ = nearest_set(level.usable, size_, wraps);
  for (size_t i = 0; i < level.usable.size(); i++)
    if (level.usable[i]) usable_.push_back(uint32_t(i));
}

void PaddedLevel::settle_usable(int& x, int& y) const {
  const uint32_t at = nearest_usable_[size_t(y) * size_.width + x];
  x = int(at % size_.width);
  y = int(at / size_.width);
}

std::array<int, 2> PaddedLevel::usable_place(uint64_t bits) const {
  const uint32_t at = usable_[below(uint32_t(bits), uint32_t(usable_.size()))];
  return {int(at % size_.width), int(at / size_.width)};
}

}  // namespace terrazzo
