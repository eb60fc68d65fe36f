#pragma once

#include <vector>

#include "core/node/value.h"

namespace terrazzo::test {

/// An 8-bit colour image whose values are exact k/255.
ImagePtr sample_image(Size size, int seed = 1);

/// One small value of every type, in the order of ValueType.
std::vector<Value> sample_values();

/// Whether two values agree in every bit of content, not only in their digests.
bool same_content(const Value& a, const Value& b);

}  // namespace terrazzo::test
