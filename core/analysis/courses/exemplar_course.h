#pragma once

#include <vector>

namespace terrazzo {

/// A course of bricks (tiles, blocks), between the centres of two bed joints. Positions are pixels of the level
/// of its Coursing.
struct ExemplarCourse {
  double begin = 0, end = 0;  ///< across the courses
  int kind = 0;               ///< courses of one kind repeat with the period, as header courses may
  std::vector<float> joint;   ///< per pixel along the course, likelihood of a head joint: 0..1
};

}  // namespace terrazzo
