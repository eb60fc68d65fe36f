#pragma once

#include <cstdint>

#include "core/image/image.h"

/// The channels in which samples of a map are blended: stored values, but for normals, which are told by direction and
/// length. Thread-safe; the same on every machine.
namespace terrazzo {

/// Whether samples of a map can be blended. Masks, guidance and data may hold labels: such maps show the sample of the
/// greatest weight.
bool blends_samples(const ImageInfo& info);

/// The map in blending space, computed when pulled, with as many channels. Normals in three channels or more become the
/// encoded x and y of their direction, and their length: 1 but in maps that were filtered carelessly.
ImagePtr in_blending_space(const ImagePtr& map);

/// The way back, in place, for `count` pixels.
void from_blending_space(const ImageInfo& info, float* pixels, int64_t count);

}  // namespace terrazzo
