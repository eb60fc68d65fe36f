#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/filter/normal_channels.h"

/// The user's interpretation of a file's pixels, where the file's name and pixels leave it open.
namespace terrazzo {

struct Interpretation {
  std::optional<NormalChannels> normal{};
  std::optional<bool> inverted{};   ///< values are 1 - v
  std::optional<bool> as_stored{};  ///< ignores the orientation tag; false: applies it
};

/// Parses comma-separated words: for normals xyz, xy, dxt5nm; for maps of one value inverted, not_inverted; for
/// heights also depth, the same as inverted; for all maps as_stored, as_tagged. Throws Error that lists the words for
/// this semantic.
Interpretation interpretation_from(std::string_view words, Semantic semantic);

/// Help text for parameters.
inline constexpr std::string_view interpretation_help =
    "Of normals: xyz, xy (the first two channels hold x and y, z is rebuilt), dxt5nm (x in alpha, y in green, z is "
    "rebuilt). Of height, roughness and other maps of one value: inverted (values are 1 - v; of height also called "
    "depth), not_inverted. Of all maps: as_stored ignores the file's orientation tag, as_tagged follows it. Several "
    "with commas between";

/// Advice for messages on how to set an interpretation: by the parameter `interpret` of load_material or, in commands
/// that take a folder, by --interpret. `map` is empty for the parameter of load_map.
std::string advice_to_interpret(std::string_view map, std::string_view word);

}  // namespace terrazzo
