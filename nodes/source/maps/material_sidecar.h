#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/material/material.h"
#include "core/material/material_files.h"

/// The sidecar: a file beside a material's maps that describes them, written by `export`.
namespace terrazzo {

/// Its name: "terrazzo-material.json", for a UDIM tile "terrazzo-material.1002.json". `material`: the material's name.
std::string sidecar_name(std::string_view material = "");
bool is_sidecar(const std::filesystem::path& file);

/// The content of a sidecar.
struct Sidecar {
  std::string name;                ///< of the material; empty if not stated
  PhysicalSize metres;             ///< physical size of the maps' surface
  std::vector<std::string> files;  ///< all files that it names
  /// The maps in the order of `files`; a map may occur in several.
  std::vector<RecognisedMap> maps;
};

/// Reads the sidecar of the folder, or of the tile in `material`. Nullopt if there is none. Skips unknown keys. Throws
/// Error about the parameter `path` with the place of the error.
std::optional<Sidecar> read_sidecar(const std::filesystem::path& folder, std::string_view material = "");

/// The files that the sidecar names, if an export of this material wrote it; empty if there is no such sidecar or it
/// cannot be read.
std::vector<std::string> files_exported_before(const std::filesystem::path& folder, const std::string& material);

}  // namespace terrazzo
