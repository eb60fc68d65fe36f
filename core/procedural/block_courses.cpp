#include "core/procedural/block_courses.h"

#include <algorithm>

#include "core/base/portable_math.h"

namespace terrazzo {

using portable::floor_int;

namespace {

constexpr int draws = 8;  // random layouts of a course; the one farthest from the joints above is kept

int whole(double n) {
  return int(std::max<int64_t>(1, floor_int(n + 0.5)));
}

/// The least distance between a joint of one list and a joint of the other.
double clearance(const std::vector<double>& a, const std::vector<double>& b) {
  double least = 1e9;
  for (const double x : a)
    for (const double y : b) least = std::min(least, (x < y ? y - x : x - y));
  return least;
}

std::vector<double> inner_joints(const std::vector<BlockCourses::Block>& blocks) {
  std::vector<double> out;
  for (const BlockCourses::Block& b : blocks) out.push_back(b.left);
  return out;
}

}  // namespace

BlockCourses::BlockCourses(const Canvas& canvas, const CourseSpec& spec, uint64_t salt)
    : wraps_(canvas.wraps()), aspect_(canvas.aspect()), across_{0, 1} {
  Dice dice(lattice_bits(canvas.seed() ^ (salt * 0x9e3779b97f4a7c15ULL), 0, 0));
  const double around = wraps_ ? 0 : 2 * std::max(spec.length, spec.height);
  across_ = {-around, 1 + around};
  double y = -around;
  for (const double height : row_heights(spec, aspect_ + 2 * around, dice)) {
    rows_.push_back({y, y + height, {}});
    y += height;
  }
  for (size_t k = 0; k < rows_.size(); k++) {
    if (wraps_) across_.from = dice.unit() - 1;
    across_.to = wraps_ ? across_.from + 1 : across_.to;
    if (k + 1 < rows_.size() && dice.unit() < spec.tall_share) {
      lay_pair(spec, rows_[k], rows_[k + 1], dice);
      k++;
    } else {
      lay_course(spec, rows_[k], dice);
    }
  }
}

std::vector<double> BlockCourses::row_heights(const CourseSpec& spec, double total, Dice& dice) const {
  std::vector<double> heights(size_t(whole(total / spec.height)));
  double sum = 0;
  for (double& h : heights) {
    h = spec.heights[size_t(dice.unit() * double(spec.heights.size()))] * (1 + spec.height_spread * dice.both());
    sum += h;
  }
  for (double& h : heights) h *= total / sum;
  return heights;
}

/// The joints between the blocks of a span, without its ends.
std::vector<double> BlockCourses::joints(Span span, const CourseSpec& spec, const std::vector<double>& avoided,
                                         Dice& dice) const {
  const double length = span.to - span.from;
  const int count = whole(length / spec.length + 0.4 * spec.length_spread * dice.both());
  std::vector<double> best;
  double clearest = -1;
  for (int n = 0; n < (count > 1 ? draws : 0); n++) {
    std::vector<double> ends(static_cast<size_t>(count));
    double sum = 0;
    for (double& e : ends) e = sum += 1 + spec.length_spread * dice.both();
    for (double& e : ends) e = span.from + e * length / sum;
    ends.pop_back();
    const double clear = clearance(ends, avoided);
    if (clear <= clearest) continue;
    clearest = clear;
    best = std::move(ends);
  }
  return best;
}

void BlockCourses::lay_run(const CourseSpec& spec, Row& row, Span span, const std::vector<double>& avoided,
                           Dice& dice) {
  double left = span.from;
  std::vector<double> ends = joints(span, spec, avoided, dice);
  ends.push_back(span.to);
  for (const double right : ends) {
    row.blocks.push_back({left, right, row.top, row.bottom, count_++});
    left = right;
  }
}

void BlockCourses::lay_course(const CourseSpec& spec, Row& row, Dice& dice) {
  const size_t k = size_t(&row - rows_.data());
  lay_run(spec, row, across_, k > 0 ? inner_joints(rows_[k - 1].blocks) : std::vector<double>{}, dice);
}

/// Lays two courses between the blocks that are two courses high.
void BlockCourses::lay_pair(const CourseSpec& spec, Row& upper, Row& lower, Dice& dice) {
  const size_t k = size_t(&upper - rows_.data());
  const std::vector<double> above = k > 0 ? inner_joints(rows_[k - 1].blocks) : std::vector<double>{};
  CourseSpec bays = spec;
  bays.length = 3.2 * spec.length;
  std::vector<double> ends = joints(across_, bays, above, dice);
  ends.push_back(across_.to);
  double left = across_.from;
  for (const double right : ends) {
    const double tall = std::min(0.5 * (right - left), spec.length * (0.8 + spec.length_spread * 0.5 * dice.both()));
    const Block block{left, left + tall, upper.top, lower.bottom, count_++};
    upper.blocks.push_back(block);
    lower.blocks.push_back(block);
    lay_run(spec, upper, {left + tall, right}, above, dice);
    lay_run(spec, lower, {left + tall, right}, inner_joints(upper.blocks), dice);
    left = right;
  }
}

BlockCourses::Place BlockCourses::at(double u, double v) const {
  double y = v, x = u;
  if (wraps_) y -= aspect_ * double(floor_int(v / aspect_));
  const auto below =
      std::upper_bound(rows_.begin() + 1, rows_.end(), y, [](double a, const Row& r) { return a < r.top; });
  const Row& row = *(below - 1);
  if (wraps_) x -= double(floor_int(u - row.blocks.front().left));
  const auto next = std::upper_bound(row.blocks.begin() + 1, row.blocks.end(), x,
                                     [](double a, const Block& b) { return a < b.left; });
  const Block& block = *(next - 1);
  return {&block, x - (block.left + block.right) / 2, y - (block.top + block.bottom) / 2};
}

}  // namespace terrazzo
