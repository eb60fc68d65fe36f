#pragma once

#include <vector>

#include "core/procedural/surface.h"

namespace terrazzo {

/// The layout of blocks in courses.
struct CourseSpec {
  double length = 0.2;                ///< mean length of a block, in units of the canvas
  double height = 0.1;                ///< mean height of a course, in units of the canvas
  std::vector<double> heights = {1};  ///< the possible heights of courses, relative to each other
  double height_spread = 0;           ///< 0..1: random deviation from these heights
  double length_spread = 0.4;         ///< 0..1: variation of lengths
  double tall_share = 0;              ///< 0..1: share of pairs of courses with blocks as high as both
};

/// Rectangular blocks that fill the canvas in courses, some of them two courses high. Immutable.
class BlockCourses {
 public:
  BlockCourses(const Canvas& canvas, const CourseSpec& spec, uint64_t salt);

  struct Block {
    double left, right, top, bottom;
    uint64_t id;
  };
  struct Place {
    const Block* block;
    double x, y;  ///< from the block's centre
  };
  Place at(double u, double v) const;

 private:
  struct Row {
    double top, bottom;
    std::vector<Block> blocks;  ///< from left to right, without gaps
  };
  struct Span {
    double from, to;
  };
  std::vector<double> row_heights(const CourseSpec& spec, double total, Dice& dice) const;
  std::vector<double> joints(Span span, const CourseSpec& spec, const std::vector<double>& avoided, Dice& dice) const;
  void lay_course(const CourseSpec& spec, Row& row, Dice& dice);
  void lay_pair(const CourseSpec& spec, Row& upper, Row& lower, Dice& dice);
  void lay_run(const CourseSpec& spec, Row& row, Span span, const std::vector<double>& avoided, Dice& dice);

  bool wraps_;
  double aspect_;
  Span across_;  ///< what a course covers; 1 long where the canvas wraps
  std::vector<Row> rows_;
  uint64_t count_ = 0;
};

}  // namespace terrazzo
