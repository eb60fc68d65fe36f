#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/material/material_files.h"

/// The file beside the maps of a material that says what they are; `export` writes it.
namespace terrazzo {

inline constexpr std::string_view sidecar_name = "terrazzo-material.json";

/// What a sidecar says.
struct Sidecar {
  std::string name;                             ///< of the material; empty if it says none
  std::optional<std::array<double, 2>> metres;  ///< that the maps show
  std::vector<std::string> files;               ///< all that it names
  /// The maps in the order of `files`; a map may occur in several.
  std::vector<RecognisedMap> maps;
};

/// Nullopt if the folder has none. Keys that are not known are skipped. Throws Error about the parameter `path` that
/// says what is wrong and where.
std::optional<Sidecar> read_sidecar(const std::filesystem::path& folder);

}  // namespace terrazzo
