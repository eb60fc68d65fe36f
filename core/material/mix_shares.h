#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace terrazzo {

/// How materials that are laid over each other by a map meet.
enum class Border : uint8_t {
  hard,    ///< every pixel shows one material
  soft,    ///< across the border one fades into the other
  height,  ///< about the border the higher one shows
};

/// What decides how much of each material a pixel shows.
struct BorderShape {
  Border border = Border::hard;
  double width = 0;     ///< of the border in pixels; below 1 it is hard
  double softness = 0;  ///< height: the difference of heights within which materials are mixed, as a share of `range`
  double offset = 0;    ///< height: how much each material counts as higher than the one before, as a share of `range`
  double lowest = 0;    ///< height: of all materials; heights outside count as these
  double range = 0;     ///< height: from the lowest to the highest

  double half() const { return border == Border::hard || width < 1 ? 0 : width / 2; }
};

/// How much of each material shows at a pixel. Deterministic to the bit.
///
/// Soft: a smooth step of the distance from the border. By height: an intruder sinks, slowly at first, so that at the
/// far end of the border none can show, and of heights that differ by less than `softness` both show (Mishkinis,
/// Advanced terrain texture splatting, 2013, with the distance from the border in place of painted opacity).
class MixShares {
 public:
  MixShares(size_t materials, const BorderShape& shape) : shape_(shape), shares_(materials), sunk_(materials) {}

  /// `distance[i]`: how far the pixel lies inside what material i covers, negative outside; 0 is the outline. `height`:
  /// of each material at the pixel, for borders by height.
  void set(const float* distance, const float* height);

  /// After `set`: shares sum to 1; of the only material that shows it is 1 exactly.
  float share(size_t material) const { return shares_[material]; }
  /// How far the material has sunk, in units of heights.
  float sunk(size_t material) const { return sunk_[material]; }

 private:
  void fade(const float* distance);
  void compare(const float* distance, const float* height);
  void normalise();

  BorderShape shape_;
  std::vector<float> shares_, sunk_;
};

}  // namespace terrazzo
