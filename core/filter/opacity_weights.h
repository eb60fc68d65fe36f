#pragma once

#include <string>

#include "core/image/image.h"

/// Colours are averaged by how much of them is seen: what lies hidden under transparent pixels must not show at their
/// edges (Porter & Duff, Compositing digital images, 1984). Thread-safe.
namespace terrazzo {

/// How much a colour image's pixels count, one channel of its size: its own alpha, else the first channel of `opacity`,
/// which may be null. Null if nothing needs weights: no colours, no opacity, or one that is 0 or 1 everywhere. Looks at
/// every pixel of the opacity.
ImagePtr opacity_weights(const ImagePtr& image, const ImagePtr& opacity);

/// The image's colours in linear light times their weights, and the weights as the last channel. Computed when pulled.
ImagePtr premultiplied(const ImagePtr& image, const ImagePtr& weights);

/// The way back: premultiplied colours as `info` describes them; its alpha, if it has one, is the weight. Pixels of
/// which nothing is seen take the colour that `hidden`, an image like the result of any size, has there; null: black.
/// Computed when pulled.
ImagePtr unpremultiplied(const ImagePtr& premultiplied, const ImageInfo& info, const ImagePtr& hidden);

/// As `resampled` (core/filter/resample.h), weighted. Pixels of which nothing is seen keep what is hidden there.
ImagePtr resampled_by_weight(const ImagePtr& source, const ImagePtr& weights, Size size, const std::string& filter,
                             Outside outside, const Digest& recipe);

}  // namespace terrazzo
