#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/material/material.h"

/// Checks of a material's maps that need only names and sizes, so that messages are the same before and during a run.
/// Thread-safe.
namespace terrazzo {

std::vector<std::string> names_of(const std::vector<Map>& maps);

/// Throws Error about `param`, listing the `known` maps, unless they include all `wanted`. `whose`: the material, for
/// the message.
void require_maps(const std::string& param, const std::vector<std::string>& wanted,
                  const std::vector<std::string>& known, const std::string& whose = "the material");

/// The known maps of a material.
struct KnownMaps {
  std::string name{};
  std::vector<std::string> maps{};  ///< certain maps
  /// Further maps that it may have; nullopt if unknown.
  std::optional<std::vector<std::string>> possible_maps{};
};

/// Throws Error about `port`, naming the differences, if a material's maps are known to differ from the first's.
void require_same_maps(const std::string& port, const std::vector<KnownMaps>& materials);

/// Throws Error about `port`, listing maps and sizes, unless all have one aspect ratio.
void require_one_shape(const std::string& port, const std::vector<std::pair<std::string, Size>>& maps);
void require_one_shape(const std::string& port, const Material& material);

}  // namespace terrazzo
