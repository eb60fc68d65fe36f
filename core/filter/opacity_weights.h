#pragma once

#include <string>

#include "core/image/image.h"

/// Averages colours weighted by opacity, so that hidden colours of transparent pixels do not bleed into their edges
/// (Porter & Duff, Compositing digital images, 1984). Thread-safe.
namespace terrazzo {

/// The weights of a colour image's pixels, as one channel of the same size: its own alpha, else the first channel of
/// `opacity`, which may be null. Null if no weights are needed: no colours, no opacity, or constant opacity of 0 or 1.
/// Reads all pixels of the opacity.
ImagePtr opacity_weights(const ImagePtr& image, const ImagePtr& opacity);

/// The image's colours in linear light, multiplied by the weights, with the weights as last channel. Computed when
/// pulled.
ImagePtr premultiplied(const ImagePtr& image, const ImagePtr& weights);

/// The inverse: converts premultiplied colours to the description `info`; its alpha, if any, is the weight. Fully
/// transparent pixels take their colour from `hidden`, an image like the result of any size; null: black. Computed when
/// pulled.
ImagePtr unpremultiplied(const ImagePtr& premultiplied, const ImageInfo& info, const ImagePtr& hidden);

/// As `resampled` (core/filter/resample.h), but weighted. Fully transparent pixels keep their hidden colours.
ImagePtr resampled_by_weight(const ImagePtr& source, const ImagePtr& weights, Size size, const std::string& filter,
                             Outside outside, const Digest& recipe);

}  // namespace terrazzo
