#pragma once

#include <optional>

#include "core/base/task.h"
#include "core/material/material.h"

namespace terrazzo {

struct EdgeOptions {
  std::vector<std::string> maps{};  ///< which maps to look for edges in; empty = all
  /// On edge strength, 0..1 of the strongest; none = automatic (Otsu 1979).
  std::optional<double> threshold{};
  double smoothing = 1;  ///< standard deviation of the Gaussian before differentiation, in pixels
  bool wraps = false;    ///< the exemplar tiles
  ImagePtr
      mask{};  ///< no edges where its first channel is 0.5 or less; of the maps' aspect ratio; null: edges anywhere
};

struct Edges {
  std::vector<float> strength;   ///< 0..1, row by row
  std::vector<uint8_t> mask;     ///< strength above the threshold
  std::vector<float> gradients;  ///< x and y, of the channels' leading principal component, per pixel
  double threshold = 0;
};

/// Gradient magnitude over all channels of the chosen maps in analysis space, each map at unit variance. Throws Error
/// if a map is unknown.
Edges find_edges(const Material& material, const EdgeOptions& options, const Task& task);

/// The signed feature distance of Lefebvre & Hoppe 2006, section 5: Euclidean distance to the nearest edge in pixels,
/// negative inside wide edges, limited to `limit`. Distinguishes pixels that look alike but lie differently between
/// features. Semantic guidance.
ImagePtr feature_distance(const Edges& edges, Size size, bool wraps, float limit);

}  // namespace terrazzo
