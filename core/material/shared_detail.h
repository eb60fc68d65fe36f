#pragma once

#include "core/image/image.h"

namespace terrazzo {

/// How much of their detail two maps of the same area have in common, 0..1: the correlation of their values, or of
/// their slopes, at 256x256 points. Maps of one material have 0.12 to 1 in common with at least one of the others
/// (measured on 12 exemplars), those of different ones mostly below 0.03, and up to 0.3 where both repeat alike. 1 if
/// one of them is flat and so says nothing. Thread-safe.
double shared_detail(const ImagePtr& a, const ImagePtr& b);

}  // namespace terrazzo
