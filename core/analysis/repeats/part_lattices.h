#pragma once

#include <functional>
#include <vector>

#include "core/analysis/repeats/regularity.h"
#include "core/exemplar/repeats.h"

namespace terrazzo {

/// An exemplar that lies beside others in one, and how it repeats.
struct ExemplarPart {
  Rect place;
  ExemplarView view;
  Lattice lattice;
};

struct BroughtTogether {
  std::vector<LatticePart> parts;
  size_t kinds = 0;      ///< how many different ways to repeat are left
  bool too_few = false;  ///< in any of them, as FoundLattice says
};

/// Brings parts that repeat alike together: cells of the same size and shape are shown as the same ones, moved by what
/// makes them most alike, so that joints of one part go on in another whatever their colours; parts that have only the
/// height of their courses in common, or the width of their columns, share these. What differs more keeps its own
/// lattice. Throws Cancelled.
BroughtTogether brought_together(const std::vector<ExemplarPart>& parts, const Task& task);

/// The rectangle of each label, in the order of their values: where exemplars lie that an atlas is made of. Throws
/// Error about "labels" unless they are an image of one channel and the exemplar's size, of at most most_lattice_parts
/// rectangles, and Cancelled.
std::vector<Rect> label_places(const ImagePtr& labels, Size exemplar, const Task& task);

/// The lattice of what is seen of one exemplar, or of several of one surface.
using LatticeFinder = std::function<FoundLattice(const std::vector<ExemplarView>&)>;

/// What is found of each exemplar by itself, brought together; or, if they are of one surface (`alike`) and do not
/// agree, of all of them together. Throws Cancelled.
BroughtTogether find_part_lattices(const Features& features, const std::vector<Rect>& places,
                                   const LatticeFinder& finder, bool alike, const Task& task);

}  // namespace terrazzo
