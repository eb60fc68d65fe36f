#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/material/material.h"
#include "core/material/material_files.h"
#include "core/node/node.h"

/// Which files the node `load_material` reads, by its parameters `path`, `name`, `maps`,
/// `ignore` and `interpret`.
namespace terrazzo {

/// What messages of find_maps advise those who write a graph.
inline constexpr std::string_view advice_on_map_names = "the parameter `maps` names files explicitly";
inline constexpr std::string_view advice_on_several_materials =
    "The parameter `name` picks one of them; `\"name\": \"*\"` takes all files as one material";
inline constexpr std::string_view advice_on_one_file = "load_map reads a single file";

std::filesystem::path folder_of(const Params& params);

/// The names of a folder's image files, sorted.
std::vector<std::string> image_names(const std::filesystem::path& folder);

/// A message for each name in `maps` that is not a map name.
std::vector<std::string> problems_with_map_names(const Params& params);

/// A message for each text in `interpret` that says nothing about its map.
std::vector<std::string> problems_with_interpretations(const Params& params);

/// What a folder holds of a material.
struct FoundMaterial {
  std::vector<RecognisedMap> maps{};
  std::string name{};     ///< the folder's, or that of the material that was picked
  PhysicalSize metres{};  ///< that the maps show, if a file says it
  Texts ignored{};        ///< images whose names say no map
  Texts unnamed{};        ///< those of them that may belong to the material and have three channels or more
};

/// Finds the maps of the folder: by its sidecar if it has one, else by what the files say of themselves and their
/// names. Throws Error about the parameter if the folder or files named in `maps` are missing, nothing is recognised,
/// or it is not clear which of several materials is meant. Adds what the user should know to `notes`.
FoundMaterial find_maps(const Params& params, Texts& notes);

/// The words in names that say a map: "base_color: basecolor, albedo, ...; normal: ...".
std::string words_for_maps();

/// Tells which images were ignored, and what to do about it.
std::string note_on_ignored(const Texts& ignored);

/// All files that the material depends on, sorted: the folder's images, those named in
/// `maps`, and the sidecar.
std::vector<std::filesystem::path> files_of_material(const Params& params);

}  // namespace terrazzo
