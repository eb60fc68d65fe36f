#include "core/exemplar/elements.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "core/base/tuning.h"
#include "core/numeric/distance_transform.h"
#include "core/numeric/watershed.h"

namespace terrazzo {

namespace {

struct ElementsTuning {
  double least_in_step = 0.75;
  int few = 12;
};
const Tunable<ElementsTuning> elements_tuning(
    "elements",
    {{&ElementsTuning::least_in_step, "least_in_step", "share of joints",
      "that come again one step of a lattice further, from which on elements lie in its cells however unsure it is. "
      "Higher: tiles of thin joints overlap; lower: rough bricks stand in rows",
      "element_layout", 0, 1},
     {&ElementsTuning::few, "few", "elements of an exemplar that tiles",
      "up to which their joints tell a lattice. Higher: costs time; lower: walls of few stones are torn", "regularity",
      1, 100}});

}  // namespace

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

namespace {

/// Where an exemplar has joints, and how near any pixel is to one. `bands`: courses or columns that are known, if any.
class JointMap {
 public:
  JointMap(const Elements& elements, bool wraps, const Lattice& bands = {})
      : size_(elements.size),
        wraps_(wraps),
        near_(std::max(1.5, typical_side(elements) / 16)),
        joints_(border_pixels(elements.at, size_, wraps)),
        squared_(squared_distances(joints_, size_, wraps)),
        by_rows_(bands.first.y() != 0) {
    if (bands.rank == 1) near_of_line_ = near_shares();
  }

  /// How surely joints come again a step further: 0, no more than by chance; 1, all of them. Chance is that of any
  /// pixel or, of bands, of any in the same row or column: joints along them say nothing of cells.
  double in_step(const Vector2d& step) const {
    const int dx = int(std::floor(step.x() + 0.5)), dy = int(std::floor(step.y() + 0.5));
    const int margin = int(std::ceil(near_));  // a joint along the border is no border between regions
    int64_t all = 0, again = 0, pixels = 0, near_ones = 0;
    double expected = 0;
    for (int y = 0; y < size_.height; y++)
      for (int x = 0; x < size_.width; x++) {
        int u = x + dx, v = y + dy;
        if (wraps_)
          u = wrap(u, size_.width), v = wrap(v, size_.height);
        else if (u < margin || v < margin || u >= size_.width - margin || v >= size_.height - margin)
          continue;
        const bool near = is_near(u, v);
        pixels++;
        near_ones += near;
        if (!joints_[size_t(y) * size_t(size_.width) + size_t(x)]) continue;
        all++;
        again += near;
        if (!near_of_line_.empty()) expected += near_of_line_[size_t(by_rows_ ? v : u)];
      }
    if (all == 0 || near_ones == pixels) return 0;  // nothing is told where all pixels are near a joint
    if (near_of_line_.empty()) expected = double(all) * double(near_ones) / double(pixels);
    return std::max(0.0, (double(again) - expected) / std::max(1.0, double(all) - expected));
  }
  double in_step(const Lattice& lattice) const {
    return lattice.rank < 2 ? 0 : std::min(in_step(lattice.first), in_step(lattice.second));
  }

 private:
  bool is_near(int x, int y) const {
    return double(squared_[size_t(y) * size_t(size_.width) + size_t(x)]) <= near_ * near_;
  }
  /// Of each row, or column: the share of its pixels that are near a joint.
  std::vector<double> near_shares() const {
    std::vector<double> out(size_t(by_rows_ ? size_.height : size_.width), 0.0);
    const double length = by_rows_ ? size_.width : size_.height;
    for (int y = 0; y < size_.height; y++)
      for (int x = 0; x < size_.width; x++) out[size_t(by_rows_ ? y : x)] += is_near(x, y) / length;
    return out;
  }

  Size size_;
  bool wraps_;
  double near_;
  std::vector<uint8_t> joints_;
  std::vector<int64_t> squared_;
  bool by_rows_;                      // bands are courses
  std::vector<double> near_of_line_;  // empty without bands
};

/// Whether the cells of a lattice are as high as such courses, or as wide as such columns.
bool keeps_bands(const Lattice& l, const Lattice& bands) {
  if (bands.rank != 1) return true;
  const double breadth = bands.first.sum();
  return std::abs(l.level_bands(bands.first.y() != 0).first.sum() - breadth) < breadth / 2;
}

}  // namespace

bool are_in_step(const Elements& elements, const Lattice& lattice, bool wraps) {
  return JointMap(elements, wraps).in_step(lattice) >= elements_tuning->least_in_step;
}

int most_few_elements() {
  return elements_tuning->few;
}

Lattice lattice_of_few(const Elements& elements, const Lattice& bands) {
  if (elements.count > elements_tuning->few) return {};
  const JointMap joints(elements, true, bands);
  for (int cells = elements.count; cells > 1; cells--) {
    Lattice best;
    best.certainty = elements_tuning->least_in_step;
    for (const Lattice& l : lattices_around(elements.size, cells)) {
      if (!keeps_bands(l, bands)) continue;
      if (const double in_step = joints.in_step(l); in_step >= best.certainty) {
        best = l;
        best.certainty = in_step;
      }
    }
    if (best.rank > 0) return best;
  }
  return {};
}

}  // namespace terrazzo
