#pragma once

#include <cstdint>
#include <vector>

namespace terrazzo {

/// What a course may show that goes around the exemplar: all that lies between two of its joints, in random order, each
/// as often as the others and none twice in a row. `joints`: columns of the exemplar, ascending, at least one;
/// `around`: columns after which the exemplar comes again; `step`: columns of the exemplar to one of the result.
/// Returns the exemplar's column for each of `length` columns of the result.
std::vector<int> random_sequence(const std::vector<int>& joints, int around, int length, int step, uint64_t bits);

}  // namespace terrazzo
