#pragma once

#include <cstdint>

#include "core/image/image.h"

/// The space in which averaging pixels means something: linear light for colours stored with the sRGB curve
/// (colour space "srgb_texture"), vectors for normals, and the stored values for everything else. Thread-safe.
namespace terrazzo {

/// The channels that carry values; the last of a colour image's two or four is coverage and is not counted.
int value_channels(const ImageInfo& info);

/// Whether an average of two pixels means anything: masks and guidance tell pixels apart, and are sampled instead.
bool can_be_averaged(const ImageInfo& info);

/// Stored pixels to that space, in place. `count` pixels of info.channels values. Normals need no change: decoding them
/// is affine, and commutes with averaging.
void to_linear(const ImageInfo& info, float* pixels, int64_t count);

/// The way back: encodes colours, makes normals unit length again, and keeps images of 8 and 16 bit within [0, 1].
void to_stored(const ImageInfo& info, float* pixels, int64_t count);

/// Keeps pixels of 8 and 16 bit images within [0, 1]; float images may hold anything.
void keep_in_range(const ImageInfo& info, float* pixels, int64_t count);

}  // namespace terrazzo
