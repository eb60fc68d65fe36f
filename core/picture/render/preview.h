#pragma once

#include <vector>

#include "core/base/task.h"
#include "core/image/image.h"
#include "core/material/material.h"

namespace terrazzo {

/// plane: the material from above, one texel per pixel if picture and material have the same size. sphere: the material
/// mapped to the visible half of a ball (azimuthal equidistant, so without poles).
enum class PreviewShape : uint8_t { plane, sphere };

struct PreviewSpec {
  PreviewShape shape = PreviewShape::plane;
  Size size{512, 512};              ///< of the picture of one light; both sides above 0
  std::vector<double> lights{135};  ///< azimuths in degrees, counter-clockwise from the right; one picture each
  double elevation = 45;            ///< of the light above the picture plane, degrees, 0..90
  double intensity = 1;             ///< a facing white surface under light 1 is white
  double ambient = 0.25;            ///< brightness of the surroundings
  double exposure = 0;              ///< in stops
  double relief = 1;    ///< depth of parallax and shadows, as a multiple of the depth that the normals imply
  double tile = 1;      ///< repeats of the material across the picture or the ball
  double tilt = 0;      ///< plane only: backward tilt in degrees, 0..75
  double distance = 4;  ///< sphere only: of the camera from the centre, in radii, above 1
  double background[3] = {0.12, 0.12, 0.13};  ///< sRGB, 0..1
};

/// Replaces a side of 0 in `size` so that a plane shows the material once in its own proportions; for a sphere the
/// picture is square. At most `largest_preview`.
Size completed(Size size, PreviewShape shape, Size material);
inline constexpr int largest_preview = 8192;

/// Renders the material under a directional light and even surroundings: GGX, normal mapping in either convention,
/// occlusion, metals, emission, parallax and shadows from the height map. Several lights give a nearly square sheet of
/// pictures with thin borders. Missing maps get defaults; a material without colour, normal and height is a grey
/// surface. The result is an 8-bit base_color in srgb_texture, the same on every machine.
ImagePtr render_preview(const Material& material, const PreviewSpec& spec, const Task& task);

}  // namespace terrazzo
