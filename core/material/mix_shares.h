#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace terrazzo {

/// The transition between mixed materials.
enum class Border : uint8_t {
  hard,    ///< every pixel shows one material
  soft,    ///< one material fades into the other
  height,  ///< near the border the higher material shows
};

/// Parameters of the transition between materials.
struct BorderShape {
  Border border = Border::hard;
  double width = 0;     ///< of the border in pixels; below 1 it is hard
  double softness = 0;  ///< height: the height difference within which materials mix, as a fraction of `range`
  double offset = 0;    ///< height: how much each material is raised over the previous one, as a fraction of `range`
  double lowest = 0;    ///< height: minimum over all materials; heights are clamped to [lowest, lowest + range]
  double range = 0;     ///< height: difference between highest and lowest

  double half() const { return border == Border::hard || width < 1 ? 0 : width / 2; }
};

/// The share of each material at a pixel. Bit-exact. Not thread-safe.
///
/// Soft: a smoothstep of the distance from the border. By height: a material is lowered beyond the border, slowly at
/// first, until it can no longer show at the border's far end; materials whose heights differ by less than `softness`
/// are mixed (Mishkinis, Advanced terrain texture splatting, 2013, with the distance from the border in place of
/// painted opacity).
class MixShares {
 public:
  MixShares(size_t materials, const BorderShape& shape) : shape_(shape), shares_(materials), sunk_(materials) {}

  /// `distance[i]`: signed distance in pixels to the outline of the area of material i, positive inside. `height`: of
  /// each material at the pixel, for borders by height.
  void set(const float* distance, const float* height);

  /// After `set`. Shares sum to 1; a single visible material has exactly 1.
  float share(size_t material) const { return shares_[material]; }
  /// How far the material is lowered, in units of heights.
  float sunk(size_t material) const { return sunk_[material]; }

 private:
  void fade(const float* distance);
  void compare(const float* distance, const float* height);
  void normalise();

  BorderShape shape_;
  std::vector<float> shares_, sunk_;
};

}  // namespace terrazzo
