#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "core/exemplar/elements.h"
#include "core/exemplar/lattice.h"
#include "tests/exemplars.h"

namespace terrazzo::test {

/// A wall whose every brick is known: bricks of several lengths in courses of one height, light joints between them.
class DrawnWall {
 public:
  static constexpr int course = 24, joint = 4, shortest = 30, longest = 60;
  static constexpr int no_brick = -1;

  explicit DrawnWall(Size size, bool upright = false) : size_(size), upright_(upright) {
    const int length = upright ? size.height : size.width, breadth = upright ? size.width : size.height;
    for (int c = 0; c * course < breadth; c++) {
      std::vector<int> ends;
      for (int at = -int(below(uint32_t(random_bits(11, c)), longest)); at < length;) {
        at += shortest + int(below(uint32_t(random_bits(12, c, ends.size())), longest - shortest + 1));
        ends.push_back(at);
      }
      ends_.push_back(std::move(ends));
    }
  }

  Size size() const { return size_; }
  bool upright() const { return upright_; }
  Lattice lattice() const { return {1, upright_ ? Vector2d{course, 0} : Vector2d{0, course}, {}, 0.9}; }

  /// Bricks are numbered by course and by their place in it.
  int brick(int x, int y) const {
    const int along = upright_ ? y : x, across = upright_ ? x : y, c = across / course;
    if (across % course < joint) return no_brick;
    const std::vector<int>& ends = ends_[size_t(c)];
    const auto after = std::upper_bound(ends.begin(), ends.end(), along);
    return after != ends.begin() && along - *(after - 1) < joint ? no_brick : c * 1000 + int(after - ends.begin());
  }
  /// Where bricks begin in a course: the first column of each joint across that the wall shows as a whole.
  std::vector<int> joints(int c) const {
    std::vector<int> out;
    const int length = upright_ ? size_.height : size_.width;
    for (const int at : ends_[size_t(c)])
      if (at >= 0 && at + joint <= length) out.push_back(at);
    return out;
  }

  ImagePtr image() const {
    return make_image(
        size_, 3,
        [&](int x, int y, int c) {
          const double speckle = 0.06 * unit_double(random_bits(6, x, y, c)), number = brick(x, y);
          if (number == no_brick) return float(0.8 + speckle);
          return float(0.2 + 0.25 * unit_double(random_bits(5, int(number), c)) + speckle);
        },
        Semantic::base_color, "srgb_texture");
  }
  /// Each brick with its part of the joints around it, numbered course by course.
  Elements elements() const {
    Elements out{size_, {}, 0, 1};
    std::map<std::pair<int, int>, int> numbers;  // of a brick, by its course and its place in it
    const auto courses = int(ends_.size());
    for (int y = 0; y < size_.height; y++)
      for (int x = 0; x < size_.width; x++) {
        const int along = (upright_ ? y : x) - joint / 2, across = (upright_ ? x : y) - joint / 2;
        const int c = std::clamp(across / course, 0, courses - 1);
        const std::vector<int>& ends = ends_[size_t(c)];
        const auto place = int(std::ranges::upper_bound(ends, along) - ends.begin());
        out.at.push_back(uint16_t(numbers.emplace(std::pair(c, place), int(numbers.size())).first->second));
      }
    out.count = int(numbers.size());
    return out;
  }
  FeaturesPtr features() const {
    return plain_features(image())->with(lattice())->with(std::make_shared<const Elements>(elements()));
  }
  AppearancePtr appearance() const { return make_appearance(*features(), {}, {}, Task()); }

 private:
  Size size_;
  bool upright_;
  std::vector<std::vector<int>> ends_;  // of each course, where bricks end and joints begin
};

}  // namespace terrazzo::test
