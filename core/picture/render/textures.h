#pragma once

#include <vector>

#include "core/base/task.h"
#include "core/material/material.h"
#include "core/picture/render/shading.h"

/// A material's maps prepared for rendering: linear colours, unit normals (y up), no finer than the picture can show.
namespace terrazzo::render {

/// One map, bilinearly sampled, repeating in both directions. Immutable.
class Texture {
 public:
  Texture() = default;
  Texture(Size size, int channels, std::vector<float> texels);
  bool empty() const { return texels_.empty(); }
  Size size() const { return size_; }
  int channels() const { return channels_; }
  const float* texel(int x, int y) const;  ///< wraps
  /// u and v in periods: the map covers [0, 1) x [0, 1), v downwards.
  Vector3d color(double u, double v) const;  ///< three channels, or one repeated
  double value(double u, double v) const;    ///< the first channel

 private:
  struct Blend;
  Blend blend(double u, double v) const;
  Size size_;
  int channels_ = 0;
  std::vector<float> texels_;
};

struct Textures {
  Texture base_color, normal, height, roughness, metallic, occlusion, emission;
  double aspect = 1;  ///< height / width of the material
  double depth = 0;   ///< from the lowest to the highest point of `height`, in widths of the material; 0 without height
  /// Whether heights continue across opposite borders; if not, the step between two repeats casts no shadow.
  bool heights_repeat_x = true, heights_repeat_y = true;

  /// Everything but the frame: `normal` is in the tangent frame (x along u, y against v, z out).
  ShadedPoint at(double u, double v) const;
  /// The stored height at (u, v), for a light ray towards a point in the repeat around (u0, v0).
  double height_at(double u, double v, double u0, double v0) const;
};

/// Maps are averaged down until they are at most `max_width` texels wide or a factor of two above it. The depth is
/// derived from normals and heights, times `relief`; without normals it is 0.05 * relief, and normals are derived from
/// the heights.
Textures load_textures(const Material& material, int max_width, double relief, const Task& task);

}  // namespace terrazzo::render
