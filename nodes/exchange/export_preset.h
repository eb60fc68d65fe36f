#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/image_io/image_file.h"
#include "core/material/material.h"

/// How programs take the maps of a material: which file holds what, in which channel, and which way green points. A
/// preset is a row of a table (preset_table.cpp); adding one is adding a row. Thread-safe.
namespace terrazzo {

/// Where one channel of a file comes from.
struct ChannelSource {
  std::string_view map{};  ///< empty: `otherwise` everywhere
  int channel = 0;         ///< of the map
  bool inverted = false;   ///< 1 - value: smoothness from roughness
  double otherwise = 0;    ///< where the material lacks the map
};

/// A file of a preset.
struct PresetFile {
  std::string_view suffix;              ///< of the file's name, behind the material's: "_ORM"
  std::vector<ChannelSource> channels;  ///< in the file's order; a last one from a map that is lacking is left out
  std::vector<std::string_view> needs;  ///< it is written if the material has one of these maps
};

/// A document that ties the files together.
enum class PresetDocument : uint8_t { none, gltf, glb, materialx_standard_surface, materialx_open_pbr, usd, blender };

struct ExportPreset {
  std::string_view name;     ///< "unreal"
  std::string_view summary;  ///< one line
  NormalY normal_y = NormalY::up;
  std::vector<PresetFile> files;
  PresetDocument document = PresetDocument::none;
};

/// In the order in which documentation lists them.
const std::vector<ExportPreset>& export_presets();
/// Null if there is no such preset.
const ExportPreset* find_export_preset(std::string_view name);

/// What is in one file.
struct FileContent {
  struct Channel {
    std::string map;  ///< empty: a constant
    int channel = 0;  ///< of the map
    bool inverted = false;
    double constant = 0;
  };
  std::string name;  ///< without extension
  ImagePtr image;    ///< as it is to be written; computed when pulled
  std::vector<Channel> channels;
  /// The map that fills the file alone; empty if it is packed of several.
  std::string whole_map() const;
  const Channel* find(std::string_view map) const;
};

/// The files of a material: those of the preset that its maps make, then each map that no file of the preset takes in a
/// file of its own. `name`: what files are named after. Maps of other sizes in one file are resampled to the largest by
/// nearest samples. Heights have at least 16 bits, whatever their depth was. `notes` gets what the user should know.
std::vector<FileContent> preset_files(const ExportPreset& preset, const Material& material, const std::string& name,
                                      std::vector<std::string>& notes);

/// "red: ambient occlusion, green: roughness, blue: metallic", "sRGB colours", "normals, green up (OpenGL)".
std::string described(const FileContent& file);

/// A line for a file's metadata, from which terrazzo reads the file right again: "terrazzo: normal green=up
/// color_space=raw".
std::string metadata_line(const FileContent& file, PhysicalSize metres);

/// What lies in a folder of exported maps, as JSON: see examples/guide/materials.md. `files`: with their extensions.
std::string sidecar_text(const ExportPreset& preset, const std::string& material, PhysicalSize metres,
                         const std::vector<std::pair<std::string, const FileContent*>>& files);

}  // namespace terrazzo
