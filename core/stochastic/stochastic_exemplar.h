#pragma once

#include <array>
#include <vector>

#include "core/image/float_planes.h"
#include "core/material/material.h"
#include "core/numeric/eigen.h"
#include "core/stochastic/histogram_transform.h"
#include "core/stochastic/triangle_grid.h"

namespace terrazzo {

/// An exemplar in the space in which samples are blended. The channels of all maps that can be blended (see
/// core/stochastic/blending_space.h), each in units of its standard deviation, are stacked and decorrelated by their
/// principal components; each component is Gaussianised by its own histogram (Heitz & Neyret 2018, Deliot & Heitz
/// 2019). Smaller maps are enlarged to the exemplar's size by nearest samples. Held in memory: a float for each
/// component of each pixel. Immutable; thread-safe.
class StochasticExemplar {
 public:
  /// `wraps`: the exemplar tiles. Else samples keep away from its borders, as far as there is room. `cell`: the edge of
  /// the triangles in pixels. Throws Error if the maps hold values that are not finite; Cancelled.
  StochasticExemplar(const Material& exemplar, bool wraps, int cell, const Task& task);

  Size size() const { return components_.size; }
  /// Of all blended maps, one after the other.
  int channels() const { return int(means_.size()); }
  /// Where the channels of the exemplar's map of that number begin.
  int first_channel(size_t map) const { return first_channels_[map]; }

  /// The pixel of the exemplar, counted row by row, that a vertex shows.
  size_t sample(const GridVertex& vertex) const;
  /// `count` channels, at most 4, from `first` on where three samples meet: blended, with their histograms restored.
  void blend(const std::array<GridVertex, 3>& vertices, int first, int count, float* out) const;

 private:
  void measure(const std::vector<ImagePtr>& maps, const Task& task);
  void decorrelate(const std::vector<ImagePtr>& maps, const Task& task);
  void gaussianise(const Task& task);
  void restore_histograms(const std::vector<ImagePtr>& maps, const TriangleGrid& grid, const Task& task);
  /// As blend, but for the histograms.
  void blend_raw(const std::array<GridVertex, 3>& vertices, int first, int count, double* out) const;

  /// Along one axis, the first of the places that a vertex may show and how many there are.
  struct Places {
    int first = 0, count = 1;
  };
  static Places places(int length, int reach, bool wraps);

  Places x_, y_;
  std::vector<int> first_channels_;
  std::vector<double> means_, deviations_;      ///< of each channel
  MatrixXd axes_;                               ///< a column for each component, in deviations of the channels
  Planes components_;                           ///< Gaussianised; wraps if the exemplar tiles
  std::vector<HistogramTransform> transforms_;  ///< of each component
  std::vector<PiecewiseLinear> restoring_;      ///< of each channel
};

}  // namespace terrazzo
