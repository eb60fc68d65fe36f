#include "core/exemplar/elements.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "core/base/tuning.h"
#include "core/exemplar/joint_map.h"

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
