#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "core/analysis/space/appearance_space.h"
#include "core/analysis/space/weighting.h"
#include "core/base/hash.h"
#include "core/exemplar/elements.h"
#include "core/material/material.h"
#include "tests/exemplars.h"

namespace terrazzo::test {

/// Panels of three courses, 60, 100 and 44 pixels high, of which no two are alike, as a single cell that tiles.
/// `turned`: courses are columns.
class DrawnPanels {
 public:
  static constexpr Size size{200, 204};

  explicit DrawnPanels(bool turned) : turned_(turned) {}

  static int course_at(int y) { return y % size.height < 60 ? 0 : y % size.height < 160 ? 1 : 2; }

  AppearancePtr appearance() const {
    const Size s = turned_ ? Size{size.height, size.width} : size;
    const auto at = [&](int x, int y) { return turned_ ? panel(y, x) : panel(x, y); };
    const ImagePtr image = make_image(
        s, 3,
        [&](int x, int y, int c) {
          const bool joint = at(x, y) != at(x + 3, y) || at(x, y) != at(x, y + 3);
          const double speckle = 0.05 * unit_double(random_bits(6, x, y, c));
          return float(joint ? 0.05 + speckle : 0.3 + 0.4 * unit_double(random_bits(5, at(x, y), c)) + speckle);
        },
        Semantic::base_color, "srgb_texture");
    Elements elements{s, {}, 11, 1};
    for (int y = 0; y < s.height; y++)
      for (int x = 0; x < s.width; x++) {
        const int p = at(x + 2, y + 2);
        elements.at.push_back(uint16_t(p < 10 ? p : p < 20 ? p - 6 : p - 13));
      }
    const FeaturesPtr features = weighted_features(*Material::of(image), {}, true);
    const Lattice cell{2, {double(s.width), 0}, {0, double(s.height)}, 0.5};
    return make_appearance(*features->with(cell)->with(std::make_shared<const Elements>(elements)), {}, {}, Task());
  }

 private:
  static int panel(int x, int y) {
    const int course = course_at(y);
    const std::vector<int> ends = course == 0   ? std::vector{0, 50, 90, 140}
                                  : course == 1 ? std::vector{30, 110, 170}
                                                : std::vector{10, 65, 105, 160};
    const auto after = std::ranges::upper_bound(ends, x % size.width);
    return course * 10 + int(after - ends.begin() + int(ends.size()) - 1) % int(ends.size());
  }

  bool turned_;
};

}  // namespace terrazzo::test
