#pragma once

#include <vector>

#include "core/base/task.h"
#include "core/exemplar/features.h"

namespace terrazzo {

/// The weighted channels of one exemplar level, interleaved: value(x, y, c) = values[(y * width + x) * channels + c].
struct ExemplarPlanes {
  Size size;
  int channels = 0;
  bool wraps = false;  ///< the exemplar tiles: what lies outside is the other side; else the border continues
  std::vector<float> values;

  const float* at(int x, int y) const { return values.data() + (size_t(y) * size.width + x) * channels; }
  float* at(int x, int y) { return values.data() + (size_t(y) * size.width + x) * channels; }
  int column(int x) const { return wraps ? wrap(x, size.width) : std::clamp(x, 0, size.width - 1); }
  int row(int y) const { return wraps ? wrap(y, size.height) : std::clamp(y, 0, size.height - 1); }
};

/// Pulls the features' weighted channels. Every image is first brought to unit total variance, so that a weight of 1
/// means the same for each; nearly constant images are not blown up beyond what their 8-bit noise is worth. What the
/// features' mask forbids does not count; such pixels continue the nearest one that is allowed.
ExemplarPlanes weighted_planes(const Features& features, const Task& task);

/// The same for guidance images (signed feature distances, control maps), which come with one weight. They must have
/// the features' size.
ExemplarPlanes guidance_planes(const Features& features, const std::vector<ImagePtr>& guidance, const Task& task);

/// A part of the planes, whose borders continue unless it is all of them.
ExemplarPlanes cropped(const ExemplarPlanes& planes, const Rect& part);

/// Half the size (rounded up), filtered with the binomial kernel 1 3 3 1 in each direction. Normals are averaged as
/// vectors: their length then tells how much they agree.
ExemplarPlanes halved(const ExemplarPlanes& planes);

/// The planes' values along their first principal component: what all channels together vary in most. Throws Cancelled.
std::vector<float> leading_component(const ExemplarPlanes& planes, const Task& task);

}  // namespace terrazzo
