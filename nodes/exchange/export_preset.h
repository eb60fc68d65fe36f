#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/image_io/image_file.h"
#include "core/material/material.h"

/// The layouts in which other programs expect a material's maps: files, channels and normal convention. Presets are
/// rows of a table (preset_table.cpp). Thread-safe.
namespace terrazzo {

/// The source of one channel of a file.
struct ChannelSource {
  std::string_view map{};  ///< empty: `otherwise` everywhere
  int channel = 0;         ///< of the map
  bool inverted = false;   ///< 1 - value: smoothness from roughness
  double otherwise = 0;    ///< value if the material lacks the map
};

/// A file of a preset. Normals need a file of their own: with other maps beside them it counts as data, and nothing
/// says any more which way its green points.
struct PresetFile {
  std::string_view suffix;              ///< appended to the material's name: "_ORM"
  std::vector<ChannelSource> channels;  ///< in the file's order; the last one is omitted if its map is missing
  std::vector<std::string_view> needs;  ///< the file is written if the material has one of these maps
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

/// All presets, in the order of the documentation.
const std::vector<ExportPreset>& export_presets();
/// Null if there is no such preset.
const ExportPreset* find_export_preset(std::string_view name);

/// The content of one file.
struct FileContent {
  struct Channel {
    std::string map;  ///< empty: a constant
    int channel = 0;  ///< of the map
    bool inverted = false;
    double constant = 0;
  };
  std::string name;  ///< without extension
  ImagePtr image;    ///< the image to write; computed when pulled
  std::vector<Channel> channels;
  /// The only map in the file; empty if several are packed.
  std::string whole_map() const;
  const Channel* find(std::string_view map) const;
};

/// The files of a material: the preset's files, then one file for each map that the preset does not use. `name`: prefix
/// of file names. Maps packed into one file are resampled to the largest size by nearest neighbour. Heights get at
/// least 16 bits. Adds notes for the user.
std::vector<FileContent> preset_files(const ExportPreset& preset, const Material& material, const std::string& name,
                                      std::vector<std::string>& notes);

/// "red: ambient occlusion, green: roughness, blue: metallic", "sRGB colours", "normals, green up (OpenGL)".
std::string described(const FileContent& file);

/// A line for a file's metadata, by which terrazzo reads the file back correctly: "terrazzo: normal green=up
/// color_space=raw".
std::string metadata_line(const FileContent& file, PhysicalSize metres);

/// The JSON description of a folder of exported maps, see examples/guide/materials.md. `files`: names with extensions.
std::string sidecar_text(const ExportPreset& preset, const std::string& material, PhysicalSize metres,
                         const std::vector<std::pair<std::string, const FileContent*>>& files);

}  // namespace terrazzo
