#pragma once

#include <optional>

#include "core/base/task.h"
#include "core/material/material.h"

namespace terrazzo {

struct EdgeOptions {
  std::vector<std::string> maps{};  ///< which maps to look for edges in; empty = all
  /// On edge strength, which is relative to the strongest; none = automatic (Otsu 1979).
  std::optional<double> threshold{};
  double smoothing = 1;  ///< standard deviation of the Gaussian before differentiation, in pixels
  bool wraps = false;    ///< the exemplar tiles
  ImagePtr mask{};       ///< where its first channel is 0.5 or less there are no edges; of the maps' shape; null: none
};

struct Edges {
  std::vector<float> strength;   ///< 0..1, row by row
  std::vector<uint8_t> mask;     ///< strength above the threshold
  std::vector<float> gradients;  ///< x and y, of the channels' leading principal component, per pixel
  double threshold = 0;
};

/// The material's edges: gradient magnitude over all channels of the chosen maps in analysis space, each map brought to
/// unit variance. Throws Error if a map is unknown.
Edges find_edges(const Material& material, const EdgeOptions& options, const Task& task);

/// The signed feature distance of Lefebvre & Hoppe 2006, section 5: the Euclidean distance to the nearest edge,
/// negative inside edges that have a width, in pixels, limited to `limit`. It tells pixels apart that look alike but
/// lie at different places between features. The image has semantic guidance.
ImagePtr feature_distance(const Edges& edges, Size size, bool wraps, float limit);

}  // namespace terrazzo
