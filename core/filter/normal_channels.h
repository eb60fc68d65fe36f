#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/image/image.h"

/// Normal maps that store only x and y, as BC5 and DXT5nm do; z is derived from them. Thread-safe.
namespace terrazzo {

/// The storage of normals in a file's channels.
enum class NormalChannels : uint8_t {
  xyz,     ///< in its first three channels
  xy,      ///< x and y in its first two
  dxt5nm,  ///< x in alpha, y in green, or of grey and alpha in grey
};
inline constexpr std::array<std::string_view, 3> normal_channels_names = {"xyz", "xy", "dxt5nm"};

/// The channels of an image that hold x, y and z.
struct NormalLayout {
  int x = 0, y = 1;
  bool has_z = true;      ///< in the third channel
  std::string reason{};   ///< why the image has no z: "it has no z", "its blue is 0 throughout"
  double overlong = 0;    ///< without z: fraction of pixels where (x, y) is clearly longer than 1
  bool is_given = false;  ///< determined by `given`
  std::string doubt{};    ///< with z: why the third channel may not be z, "its blue ..."
};

/// Throws Error with a clause beginning with "it" unless a file of so many channels can store normals so.
void require_channels(NormalChannels given, int channels);

/// Determines the layout from `given`, else from the channels' names and the pixels. `names`: channel names in the
/// file; empty: unknown. `height`: of the same surface; may be null. Throws Error with a clause beginning with "it" if
/// the image is no normal map, or does not fit `given`. `advice`: how to specify the layout, for ambiguous images.
NormalLayout normal_layout(const ImagePtr& image, const std::vector<std::string>& names, const Image* height,
                           std::optional<NormalChannels> given, const std::string& advice);

/// Encoded normals of three channels: x and y unchanged, and z = sqrt(1 - x^2 - y^2) from x and y decoded to -1..1; 0
/// where (x, y) is longer than 1. Computed when pulled.
ImagePtr with_z_rebuilt(const ImagePtr& image, const NormalLayout& layout);

}  // namespace terrazzo
