#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/image/image.h"

/// Separable filters on images: scaling and Gaussian blur. OpenImageIO's ImageBufAlgo::resize is not used: it visits
/// the whole square of taps for every pixel, and its lanczos3 calls the C library's sine, which differs between
/// machines. Pixels are filtered in the space of core/image/pixel_space.h. Thread-safe.
namespace terrazzo {

/// The source pixels and weights of one row or column of the result. Weights sum to 1.
struct Taps {
  int first = 0;  ///< may lie outside the image
  std::vector<float> weights;
};

/// One axis of a filter.
struct AxisFilter {
  std::function<Taps(int)> taps;  ///< for any coordinate of the result
  bool copies = false;            ///< every result pixel is a copy of one source pixel
  bool slides = false;            ///< a convolution: weights and offsets are the same everywhere
};

/// The filters of `scaling_filter`.
const std::vector<std::string>& scaling_filter_names();

/// Scales `from` pixels to `to` pixels. `name` is one of scaling_filter_names(); "auto" takes lanczos3 to shrink and
/// mitchell to enlarge. When shrinking, the kernel is widened by the scale factor. An axis that keeps its size is
/// copied.
AxisFilter scaling_filter(const std::string& name, int from, int to);

/// A Gaussian of standard deviation `sigma` pixels, truncated at three sigma; sigma 0 copies.
AxisFilter gaussian_filter(double sigma);

/// The filtered image, computed when pulled. `info` describes the result: as `source`, except for its size. `recipe` as
/// for Image::computed.
ImagePtr filtered(const ImagePtr& source, const ImageInfo& info, const Digest& recipe, const AxisFilter& horizontal,
                  const AxisFilter& vertical, Outside outside);

/// The image at another size, computed when pulled, by a filter of scaling_filter_names(); "auto" takes nearest for
/// masks and guidance. The image itself if it has that size.
ImagePtr resampled(const ImagePtr& source, Size size, const std::string& filter, Outside outside, const Digest& recipe);

/// Resamples an image's raw values, regardless of its semantic, by the triangle filter, into memory. Throws Cancelled.
ImagePtr numbers_at_size(const ImagePtr& image, Size size, const Task& task);

}  // namespace terrazzo
