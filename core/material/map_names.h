#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/material/material.h"

/// Checks of a material's maps by name and size, for messages that are the same before a run and during it: nothing
/// here looks at pixels.
namespace terrazzo {

std::vector<std::string> names_of(const std::vector<Map>& maps);

/// Throws Error about `param` if any of `wanted` is not among the `known` maps of `whose` material, naming them all.
void require_maps(const std::string& param, const std::vector<std::string>& wanted,
                  const std::vector<std::string>& known, const std::string& whose = "the material");

/// What is known of a material.
struct KnownMaps {
  std::string name{};
  std::vector<std::string> maps{};  ///< that it has
  /// Maps that it may have besides; none if there is no telling which.
  std::optional<std::vector<std::string>> possible_maps{};
};

/// Throws Error about `port`, naming what is missing or too much, if materials surely have other maps than the first.
void require_same_maps(const std::string& port, const std::vector<KnownMaps>& materials);

/// Throws Error about `port`, naming all maps and their sizes, unless all have one shape, at whatever sizes.
void require_one_shape(const std::string& port, const std::vector<std::pair<std::string, Size>>& maps);
void require_one_shape(const std::string& port, const Material& material);

}  // namespace terrazzo
