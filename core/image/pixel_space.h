#pragma once

#include <cstdint>

#include "core/image/image.h"

/// The space in which pixels can be averaged: linear light for colours stored with the sRGB curve (colour space
/// "srgb_texture"), vectors for normals, and the stored values for everything else. Thread-safe.
namespace terrazzo {

/// The number of channels that carry values. Alpha, the last of a colour image's two or four channels, does not count.
int value_channels(const ImageInfo& info);

/// Whether pixels can be averaged. Masks and guidance cannot: they label pixels and are sampled instead.
bool can_be_averaged(const ImageInfo& info);

/// Converts `count` stored pixels of info.channels values to that space, in place. Normals stay as they are: decoding
/// them is affine and commutes with averaging.
void to_linear(const ImageInfo& info, float* pixels, int64_t count);

/// The inverse: encodes colours, normalises normals, and clamps 8- and 16-bit images to [0, 1].
void to_stored(const ImageInfo& info, float* pixels, int64_t count);

/// Clamps pixels of 8- and 16-bit images to [0, 1]. Leaves float images unchanged.
void keep_in_range(const ImageInfo& info, float* pixels, int64_t count);

}  // namespace terrazzo
