#pragma once

#include <functional>
#include <vector>

#include "core/analysis/repeats/regularity.h"
#include "core/exemplar/repeats.h"
#include "core/image/image_facts.h"

namespace terrazzo {

/// One of several exemplars in an atlas, and its lattice.
struct ExemplarPart {
  Rect place;
  ExemplarView view;
  Lattice lattice;
};

/// The lattices of all parts.
struct BroughtTogether {
  std::vector<LatticePart> parts;
  size_t kinds = 0;      ///< number of different lattices
  bool too_few = false;  ///< in any part, see FoundLattice
};

/// Merges similar lattices: parts with cells of the same size and shape share one lattice, shifted to where their cells
/// match best, so that joints continue from part to part whatever their colours. Parts that have only course height or
/// column width in common share that; others keep their own lattice. Throws Cancelled.
BroughtTogether brought_together(const std::vector<ExemplarPart>& parts, const Task& task);

/// The rectangle of each label, ordered by value: the exemplars in an atlas. Throws Error about "labels" unless they
/// have one channel, the exemplar's size, and at most most_lattice_parts rectangles. Throws Cancelled.
std::vector<Rect> label_places(const ImagePtr& labels, Size exemplar, const Task& task);
/// What of that can be said without pixels.
void require_labels(const ImageFacts& labels, std::optional<Size> exemplar);

/// Finds the lattice of one exemplar, or of several of one surface.
using LatticeFinder = std::function<FoundLattice(const std::vector<ExemplarView>&)>;

/// Finds each exemplar's lattice and merges them; if they show one surface (`alike`) and disagree, finds one lattice
/// from all of them together. Throws Cancelled.
BroughtTogether find_part_lattices(const Features& features, const std::vector<Rect>& places,
                                   const LatticeFinder& finder, bool alike, const Task& task);

}  // namespace terrazzo
