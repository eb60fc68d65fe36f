#pragma once

#include "core/filter/slow_light.h"
#include "core/image/image.h"

namespace terrazzo {

/// The direction of the light in which a base colour was photographed, found from the surface's normals: slopes towards
/// the light are brighter than those away from it. A surface's own tones know no direction, but they may depend on the
/// steepness, which is therefore left alone.
struct ReliefLight {
  double x = 0, y = 0;        ///< change of brightness per unit of the normal's x and y (up), relative to a flat place
  double explained = 0;       ///< share of the variance of log luminance
  double mean_logarithm = 0;  ///< of `shading`

  /// Whether there is any.
  bool is_any() const { return x != 0 || y != 0; }
  /// The brightness of a place with this unit normal, relative to a flat place. Above 0.
  double shading(double normal_x, double normal_y) const;
  /// Where the light comes from, in degrees counter-clockwise from the right, 0..360.
  double azimuth() const;
};

/// Fits the light to log luminance less `slow`, by least squares. `normals`: encoded, y up, of the colour's size;
/// `opacity` as for SlowLight. None unless the same light is found all over the picture and explains enough. Reads
/// every pixel once, and holds at most a million of them. The same result on every machine. Throws Cancelled.
ReliefLight relief_light(const ImagePtr& color, const ImagePtr& opacity, const ImagePtr& normals, const SlowLight& slow,
                         const Task& task);

/// Normals of a height map of unknown scale, y up: as steep as surfaces usually are. Computed when pulled.
ImagePtr normals_of_usual_slope(const ImagePtr& height, Outside outside);

}  // namespace terrazzo
