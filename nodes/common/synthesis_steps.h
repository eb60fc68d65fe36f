#pragma once

#include <vector>

#include "core/node/node.h"

namespace terrazzo {

/// The table of the synthesis' steps (core/synthesis/steps.h) for the reference of nodes that synthesize: where each
/// applies is found by asking it, for every level, quality and kind of exemplar.
std::vector<NodeStep> described_synthesis_steps();

}  // namespace terrazzo
