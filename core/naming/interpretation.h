#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/filter/normal_channels.h"

/// What the user says of a file's pixels, where its name and the pixels do not tell.
namespace terrazzo {

struct Interpretation {
  std::optional<NormalChannels> normal{};
  std::optional<bool> inverted{};   ///< values are 1 - v
  std::optional<bool> as_stored{};  ///< the orientation tag is ignored; false: it is followed
};

/// From one or several of these words with commas between: of normals xyz, xy, dxt5nm; of maps of one value inverted,
/// not_inverted; of all maps as_stored, as_tagged. Throws Error that names those that a map of that semantic takes.
Interpretation interpretation_from(std::string_view words, Semantic semantic);

/// For the help of parameters.
inline constexpr std::string_view interpretation_help =
    "Of normals: xyz, xy (the first two channels hold x and y, z is rebuilt), dxt5nm (x in alpha, y in green, z is "
    "rebuilt). Of height, roughness and other maps of one value: inverted (values are 1 - v), not_inverted. Of all "
    "maps: as_stored ignores the file's orientation tag, as_tagged follows it. Several with commas between";

/// How to say it, for messages: the parameter `interpret` of load_material and, on command lines that take a folder,
/// --interpret. `map` is empty for the parameter of load_map.
std::string advice_to_interpret(std::string_view map, std::string_view word);

}  // namespace terrazzo
