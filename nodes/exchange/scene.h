#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "nodes/exchange/export_preset.h"

/// Documents that show a material to other programs. All are functions of what they are given: the same text every
/// time. Thread-safe.
namespace terrazzo {

/// A file of maps as a document names it.
struct SceneFile {
  std::string name;  ///< with extension; it lies beside the document
  const FileContent* content = nullptr;
};

/// A material on a plane.
struct MaterialScene {
  std::string name;
  PhysicalSize metres;                     ///< of the maps
  std::array<double, 2> repeats = {1, 1};  ///< how often the plane shows them, along x and y
  double relief = 0;                       ///< metres from the lowest height to the highest; 0: no displacement
  std::vector<SceneFile> files{};

  /// The file that holds a map; null if none does.
  const SceneFile* find(std::string_view map) const;
  /// The file that holds a map, and it alone.
  const SceneFile* find_alone(std::string_view map) const;
  PhysicalSize plane() const { return metres * repeats; }
};

/// A name as identifiers in MaterialX, USD and Python allow it: letters, digits and "_", no digit first.
std::string identifier(const std::string& name);

/// Whether a glTF material takes a file.
bool gltf_takes(const FileContent& file);
/// glTF 2.0 (Khronos): the plane stands upright and faces +z; tangents written, textures repeat. The geometry lies in
/// the text, images beside it. All of the scene's files must be taken.
std::string gltf_text(const MaterialScene& scene);
/// The same as one binary file. `images`: the files' bytes, PNG or JPEG. All of the scene's files must be taken.
std::string glb_bytes(const MaterialScene& scene, const std::vector<std::string>& images);

/// MaterialX 1.38: tiledimage nodes with physical sizes, and a surface shader.
std::string materialx_text(const MaterialScene& scene, bool open_pbr);

/// USD as text: UsdPreviewSurface and the plane, y up, in metres.
std::string usd_text(const MaterialScene& scene);

/// A script for Blender's Python that makes the material, and the plane.
std::string blender_script(const MaterialScene& scene);

}  // namespace terrazzo
