#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/material/material.h"
#include "core/material/material_files.h"

/// The file beside the maps of a material that says what they are; `export` writes it.
namespace terrazzo {

/// Its name: "terrazzo-material.json", of a UDIM tile "terrazzo-material.1002.json". `material`: the material's name.
std::string sidecar_name(std::string_view material = "");
bool is_sidecar(const std::filesystem::path& file);

/// What a sidecar says.
struct Sidecar {
  std::string name;                ///< of the material; empty if it says none
  PhysicalSize metres;             ///< that the maps show
  std::vector<std::string> files;  ///< all that it names
  /// The maps in the order of `files`; a map may occur in several.
  std::vector<RecognisedMap> maps;
};

/// That of the folder, or of the tile that `material` names. Nullopt if there is none. Keys that are not known are
/// skipped. Throws Error about the parameter `path` that says what is wrong and where.
std::optional<Sidecar> read_sidecar(const std::filesystem::path& folder, std::string_view material = "");

/// The files that the sidecar names, if an export of that material wrote it; none if there is no such sidecar, or it
/// cannot be read.
std::vector<std::string> files_exported_before(const std::filesystem::path& folder, const std::string& material);

}  // namespace terrazzo
