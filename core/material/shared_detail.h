#pragma once

#include "core/image/image.h"

namespace terrazzo {

/// How well the details of two maps match, 0..1: the correlation of their values or of their slopes, sampled at 256x256
/// points. Each map of a material reaches 0.12 to 1 with at least one of the others (measured on 12 exemplars). Maps of
/// different materials mostly stay below 0.03, but reach 0.3 if both repeat alike. Returns 1 if one of them is flat,
/// since nothing can be compared. Thread-safe.
double shared_detail(const ImagePtr& a, const ImagePtr& b);

}  // namespace terrazzo
