#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/image/image.h"

/// Normal maps that hold x and y alone, as BC5 and DXT5nm do: z follows from the two. Thread-safe.
namespace terrazzo {

/// How a file holds normals.
enum class NormalChannels : uint8_t {
  xyz,     ///< in its first three channels
  xy,      ///< x and y in its first two
  dxt5nm,  ///< x in alpha, y in green, or of grey and alpha in grey
};
inline constexpr std::array<std::string_view, 3> normal_channels_names = {"xyz", "xy", "dxt5nm"};

/// Which channels of an image hold what.
struct NormalLayout {
  int x = 0, y = 1;
  bool has_z = true;      ///< in the third channel
  std::string reason{};   ///< why z is not taken from the image, "it has no z", "its blue is 0 throughout"
  double overlong = 0;    ///< without z: the share of the pixels whose x and y are clearly longer than 1
  bool is_given = false;  ///< told by `given`
  std::string doubt{};    ///< with z: why the third channel does not seem to be it, "its blue ..."
};

/// Told by `given`, else by the channels' names and by the pixels. `names`: as the file has them; empty: not known.
/// `height`: of the same surface; may be null. Throws Error that begins with "it" where the image is no normal map, or
/// `given` does not fit it; `advice`: how to say what it is, for what the pixels do not tell.
NormalLayout normal_layout(const ImagePtr& image, const std::vector<std::string>& names, const Image* height,
                           std::optional<NormalChannels> given, const std::string& advice);

/// Encoded normals of three channels: x and y as they are, z = sqrt(1 - x^2 - y^2) of the two decoded to -1..1, 0 where
/// they are longer than 1.
ImagePtr with_z_rebuilt(const ImagePtr& image, const NormalLayout& layout);

}  // namespace terrazzo
