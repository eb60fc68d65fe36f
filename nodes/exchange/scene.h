#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "nodes/exchange/export_preset.h"

/// Documents that describe a material to other programs. Pure functions: equal input gives equal text. Thread-safe.
namespace terrazzo {

/// A file of maps, as referenced by a document.
struct SceneFile {
  std::string name;  ///< with extension; it lies beside the document
  const FileContent* content = nullptr;
};

/// A material on a plane.
struct MaterialScene {
  std::string name;
  PhysicalSize metres;                     ///< size of the maps' surface
  std::array<double, 2> repeats = {1, 1};  ///< repeats of the maps on the plane along x and y
  double relief = 0;                       ///< metres from the lowest height to the highest; 0: no displacement
  std::vector<SceneFile> files{};

  /// The file that holds a map; null if none does.
  const SceneFile* find(std::string_view map) const;
  /// The file that holds only this map; null if there is none.
  const SceneFile* find_alone(std::string_view map) const;
  PhysicalSize plane() const { return metres * repeats; }
};

/// Converts a name to an identifier for MaterialX, USD and Python: letters, digits and "_", not starting with a digit.
std::string identifier(const std::string& name);

/// Whether a glTF material can use a file.
bool gltf_takes(const FileContent& file);
/// glTF 2.0 (Khronos) with an upright plane facing +z, tangents and repeating textures. The geometry is embedded,
/// images are separate files. gltf_takes must hold for all files of the scene.
std::string gltf_text(const MaterialScene& scene);
/// The same as one binary file. `images`: the files' bytes, PNG or JPEG. gltf_takes must hold for all files of the
/// scene.
std::string glb_bytes(const MaterialScene& scene, const std::vector<std::string>& images);

/// MaterialX 1.38: tiledimage nodes with physical sizes, and a surface shader.
std::string materialx_text(const MaterialScene& scene, bool open_pbr);

/// USD as text: UsdPreviewSurface and the plane, y up, in metres.
std::string usd_text(const MaterialScene& scene);

/// A Python script for Blender that creates the material and the plane.
std::string blender_script(const MaterialScene& scene);
/// The Python function that makes a material in Blender, which the script and the add-on share:
/// examples/blender/terrazzo_blender/build_material.py.
std::string_view blender_material_builder();

}  // namespace terrazzo
