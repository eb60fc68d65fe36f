#include "core/exemplar/element_lattice.h"

#include <cmath>

#include "core/base/tuning.h"
#include "core/exemplar/joint_map.h"

namespace terrazzo {

namespace {

struct ElementLatticeTuning {
  double least_in_step = 0.75;
  int few = 12;
};
const Tunable<ElementLatticeTuning> element_lattice_tuning(
    "element_lattice",
    {{&ElementLatticeTuning::least_in_step, "least_in_step", "share of joints",
      "that come again one step of a lattice further, from which on elements lie in its cells however unsure it is. "
      "Higher: tiles of thin joints overlap; lower: rough bricks stand in rows",
      "element_layout", 0, 1},
     {&ElementLatticeTuning::few, "few", "elements of an exemplar that tiles",
      "up to which their joints tell a lattice. Higher: costs time; lower: walls of few stones are torn", "regularity",
      1, 100}});

/// Whether the cells of a lattice are as high as such courses, or as wide as such columns.
bool keeps_bands(const Lattice& l, const Lattice& bands) {
  if (bands.rank != 1) return true;
  const double breadth = bands.first.sum();
  return std::abs(l.level_bands(bands.first.y() != 0).first.sum() - breadth) < breadth / 2;
}

}  // namespace

bool are_in_step(const Elements& elements, const Lattice& lattice, bool wraps) {
  return JointMap(elements, wraps).in_step(lattice) >= element_lattice_tuning->least_in_step;
}

int most_few_elements() {
  return element_lattice_tuning->few;
}

Lattice lattice_of_few(const Elements& elements, const Lattice& bands) {
  if (elements.count > element_lattice_tuning->few) return {};
  const JointMap joints(elements, true, bands);
  for (int cells = elements.count; cells > 1; cells--) {
    Lattice best;
    best.certainty = element_lattice_tuning->least_in_step;
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
