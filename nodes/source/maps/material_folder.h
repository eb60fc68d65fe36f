#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/material/material.h"
#include "core/material/material_files.h"
#include "core/node/node.h"

/// Finds the files that the node `load_material` reads, by its parameters `path`, `name`, `maps`, `ignore` and
/// `interpret`.
namespace terrazzo {

/// Advice for graph authors in messages of find_maps.
inline constexpr std::string_view advice_on_map_names = "the parameter `maps` names files explicitly";
inline constexpr std::string_view advice_on_several_materials =
    "The parameter `name` picks one of them; `\"name\": \"*\"` takes all files as one material";

/// The parameter `path`, or the folder of the picture that it names.
std::filesystem::path folder_of(const Params& params);

/// The names of a folder's image files, sorted.
std::vector<std::string> image_names(const std::filesystem::path& folder);

/// A message for each name in `maps` that is not a map name.
std::vector<std::string> problems_with_map_names(const Params& params);

/// The maps found in a folder.
struct FoundMaterial {
  std::vector<RecognisedMap> maps{};
  std::string name{};     ///< of the folder, or of the selected material
  PhysicalSize metres{};  ///< physical size, if a file states it
  Texts ignored{};        ///< images without a map keyword in their names
  Texts unnamed{};        ///< the ignored images with three channels or more that may belong to the material
};

/// Finds the maps of the folder, or takes the picture that stands in its place for the base colour: by its sidecar if
/// there is one, else by the files' descriptions and names. Throws Error about the parameter if the folder or files
/// named in `maps` are missing, if nothing is recognised, or if the choice between several materials is ambiguous. Adds
/// notes for the user.
FoundMaterial find_maps(const Params& params, Texts& notes);

/// The materials of a folder that holds several, by name; "" for files without one. Empty if it holds one or none.
Texts several_materials(const std::filesystem::path& folder);

/// The keywords of all maps: "base_color: basecolor, albedo, ...; normal: ...".
std::string words_for_maps();

/// A note on the ignored images, with advice.
std::string note_on_ignored(const Texts& ignored);

/// All files that the material depends on, sorted: the folder's images, those named in
/// `maps`, and the sidecar.
std::vector<std::filesystem::path> files_of_material(const Params& params);

}  // namespace terrazzo
