#pragma once

#include <cmath>
#include <vector>

#include "core/base/hash.h"
#include "core/exemplar/elements.h"
#include "tests/exemplars.h"

namespace terrazzo::test {

/// A wall of irregular stones with dark joints, each stone of its own shade: the cells around scattered points. It
/// tiles. Which stone each pixel belongs to is known.
class DrawnStones {
 public:
  /// `across`: stones along each side.
  explicit DrawnStones(Size size, int across = 6, uint64_t seed = 1) : size_(size) {
    for (int j = 0; j < across; j++)
      for (int i = 0; i < across; i++)
        sites_.push_back({(i + 0.2 + 0.6 * unit_double(random_bits(seed, i, j, 0))) * size.width / across,
                          (j + 0.2 + 0.6 * unit_double(random_bits(seed, i, j, 1))) * size.height / across});
    for (int y = 0; y < size.height; y++)
      for (int x = 0; x < size.width; x++) {
        double nearest = 1e9, second = 1e9;
        size_t stone = 0;
        for (size_t s = 0; s < sites_.size(); s++) {
          const double d = distance(x, y, sites_[s]);
          if (d < nearest) {
            second = nearest;
            nearest = d;
            stone = s;
          } else if (d < second) {
            second = d;
          }
        }
        elements_.at.push_back(uint16_t(stone));
        joint_.push_back(second - nearest < joint);
      }
    elements_.size = size;
    elements_.count = int(sites_.size());
    elements_.certainty = 1;
  }

  const Elements& elements() const { return elements_; }
  ImagePtr image() const {
    return make_image(size_, 1, [&](int x, int y, int) {
      const size_t i = size_t(y) * size_t(size_.width) + size_t(x);
      const auto noise = float(unit_double(random_bits(7, x, y)));
      if (joint_[i]) return 0.1f + 0.04f * noise;
      return 0.5f + 0.4f * float(unit_double(random_bits(9, elements_.at[i]))) + 0.05f * noise;
    });
  }

  static constexpr double joint = 5;  ///< by how much farther the next stone's site may be in a joint

 private:
  struct Site {
    double x, y;
  };
  double distance(int x, int y, const Site& s) const {
    const auto around = [](double d, int length) {
      d = std::abs(d);
      return std::min(d, length - d);
    };
    return std::hypot(around(x - s.x, size_.width), around(y - s.y, size_.height));
  }

  Size size_;
  std::vector<Site> sites_;
  Elements elements_;
  std::vector<uint8_t> joint_;
};

}  // namespace terrazzo::test
