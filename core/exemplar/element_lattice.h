#pragma once

#include "core/exemplar/elements.h"
#include "core/exemplar/lattice.h"

namespace terrazzo {

/// Whether joints come again one step of a lattice of rank 2 further, along both of its steps: more surely than by
/// chance. `wraps`: the exemplar tiles. False of another rank.
bool are_in_step(const Elements& elements, const Lattice& lattice, bool wraps);

/// How many elements count as few.
int most_few_elements();

/// Of few elements of an exemplar that tiles: the densest lattice that they are in step with, of as many cells as there
/// are elements or fewer; its certainty is the share of joints that come again. `bands`: if of rank 1, courses or
/// columns that are known: cells are as high, or as wide, and their own joints say nothing. Rank 0 if there is none of
/// two cells.
Lattice lattice_of_few(const Elements& elements, const Lattice& bands = {});

}  // namespace terrazzo
