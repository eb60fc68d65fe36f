#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/image/image.h"

/// Separable filters on images: scaling and Gaussian blur. Not OpenImageIO's: ImageBufAlgo::resize visits the whole
/// square of taps for every pixel, and its lanczos3 calls the C library's sine, which is not the same everywhere.
/// Pixels are filtered in the space of core/pixel_space.h. Thread-safe.
namespace terrazzo {

/// Which source pixels, with which weights, make one row or column of the result. Weights sum to 1.
struct Taps {
  int first = 0;  ///< may lie outside the image
  std::vector<float> weights;
};

/// One axis of a filter.
struct AxisFilter {
  std::function<Taps(int)> taps;  ///< of any result coordinate
  bool copies = false;            ///< every result is one source pixel as it is
  bool slides = false;            ///< the same weights everywhere, at the same distance from the result
};

/// The filters of `scaling_filter`.
const std::vector<std::string>& scaling_filter_names();

/// Scales `from` pixels to `to` pixels. `name` is one of scaling_filter_names(); "auto" takes lanczos3 to shrink and
/// mitchell to enlarge. When shrinking, the kernel is widened to cover what a result pixel covers. An axis that keeps
/// its size is copied.
AxisFilter scaling_filter(const std::string& name, int from, int to);

/// A Gaussian of standard deviation `sigma` pixels, cut off at three of them; sigma 0 copies.
AxisFilter gaussian_filter(double sigma);

/// The filtered image, computed when pulled. `info` describes the result: its size, and else what `source` says.
/// `recipe` as for Image::computed.
ImagePtr filtered(const ImagePtr& source, const ImageInfo& info, const Digest& recipe, const AxisFilter& horizontal,
                  const AxisFilter& vertical, Outside outside);

/// The image at another size, computed when pulled, by a filter of scaling_filter_names(); "auto" takes nearest for
/// masks and guidance. The image itself if it has that size.
ImagePtr resampled(const ImagePtr& source, Size size, const std::string& filter, Outside outside, const Digest& recipe);

/// An image's plain numbers at another size, whatever they mean, by the triangle filter; in memory.
ImagePtr numbers_at_size(const ImagePtr& image, Size size, const Task& task);

}  // namespace terrazzo
