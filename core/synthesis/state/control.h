#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "core/analysis/space/padded_level.h"
#include "core/base/task.h"
#include "core/synthesis/state/control_map.h"

namespace terrazzo {

/// Control values of the exemplar or the output at one level: bytes, all controls' channels interleaved.
struct ControlPlanes {
  Size size;
  int channels = 0;
  std::vector<uint8_t> values;
  const uint8_t* at(int64_t pixel) const { return &values[size_t(pixel) * channels]; }
};

/// All controls of a synthesis, at every level.
class ControlPyramid {
 public:
  /// Throws Error about "exemplar_control" or "target" if an image does not suit. Each level has half the size of the
  /// finer one, rounded up, and averages its pixels; for labels these are the areas that each label covers. `finest`:
  /// the size of the exemplar's finest level.
  ControlPyramid(const std::vector<Control>& controls, Size exemplar, Size finest, Size output, int levels,
                 const Task& task);

  /// The channels of one control.
  struct Part {
    int first = 0;
    int count = 0;
    double strength = 1;
    bool labels = false;
  };
  bool empty() const { return parts_.empty(); }
  const std::vector<Part>& parts() const { return parts_; }
  const ControlPlanes& exemplar(int level) const { return exemplar_[level]; }
  const ControlPlanes& target(int level) const { return target_[level]; }

 private:
  std::vector<Part> parts_;
  std::vector<ControlPlanes> exemplar_, target_;
};

/// The controls of one level as a cost.
class LevelControl {
 public:
  LevelControl(const ControlPyramid& pyramid, int level, const PaddedLevel& exemplar);

  const uint8_t* target(int64_t pixel) const { return target_.at(pixel); }
  /// The same with coordinates beyond the right or lower border clamped to it.
  const uint8_t* target_near(int x, int y) const {
    const Size size = target_.size;
    return target_.at(int64_t{std::min(y, size.height - 1)} * size.width + std::min(x, size.width - 1));
  }
  /// The cost of showing an exemplar pixel where `target` is wanted, on the scale of one compared vector. At strength 1
  /// a wrong label costs as much as the mean distance of two unrelated vectors. Differences of values are free up to
  /// their deviation within the exemplar's features.
  uint64_t cost(int x, int y, const uint8_t* target) const {
    const uint8_t* has = exemplar_.at(int64_t{y} * exemplar_.size.width + x);
    uint64_t sum = 0;
    for (const Part& part : parts_) {
      uint32_t squares = 0;
      for (int c = part.first; c < part.end; c++) {
        const int off = std::max(0, std::abs(has[c] - target[c]) - part.slack);
        squares += uint32_t(off * off);
      }
      sum += squares * part.weight;
    }
    return std::min<uint64_t>(sum >> weight_bits, most);
  }
  /// How often the target wants each exemplar pixel, relative to the others; 0 for pixels that are not usable.
  std::vector<double> demand(const std::vector<uint8_t>& usable) const;

 private:
  struct Part {
    int first;
    int end;
    uint64_t weight;
    bool labels;
    int slack;     ///< values may differ by so much at no cost
    int bin_bits;  ///< leading bits of a value that choose its histogram bin when demand is counted
  };
  uint64_t key(const uint8_t* values) const;
  static constexpr int weight_bits = 16;               // fraction bits of a part's weight
  static constexpr uint64_t most = uint64_t{1} << 27;  // times a window's 24 vectors it still fits 32 bits
  const ControlPlanes& exemplar_;
  const ControlPlanes& target_;
  std::vector<Part> parts_;
  double influence_ = 0;
};

}  // namespace terrazzo
