#pragma once

#include <string>

#include "core/node/node.h"

/// What to say of a node that takes more memory than there is.
namespace terrazzo {

/// "it takes about 408 MiB ..., and --memory gives 64 MiB. Give --memory 408M, or ...". `least`: the result of
/// memory_ahead for these inputs, in bytes; `budget` in bytes.
std::string memory_advice(const NodeType& type, const Params& params, const InputForecasts& inputs, uint64_t least,
                          uint64_t budget);

}  // namespace terrazzo
