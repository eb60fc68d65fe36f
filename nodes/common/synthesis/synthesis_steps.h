#pragma once

#include <vector>

#include "core/node/node.h"

namespace terrazzo {

/// The table of synthesis steps (core/synthesis/steps.h) for the reference of synthesis nodes. Evaluates each step's
/// condition for every level, quality and kind of exemplar.
std::vector<NodeStep> described_synthesis_steps();

}  // namespace terrazzo
