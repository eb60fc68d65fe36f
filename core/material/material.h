#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/image/image.h"

namespace terrazzo {

/// One map of a material. Graphs, file patterns and weights refer to it by name: its semantic, with a suffix if a
/// material has several ("mask_moss").
struct Map {
  std::string name;
  ImagePtr image;
};

/// The semantic of a map by its name, with or without a suffix; nullopt if there is none.
std::optional<Semantic> semantic_of_map(const std::string& map);

/// The largest width and height of a PhysicalSize.
inline constexpr double largest_extent = 1e6;  ///< metres
/// The physical size of a surface in metres.
struct PhysicalSize {
  double width = 0;  ///< 0: unknown
  double height = 0;

  bool is_known() const { return width > 0 && height > 0; }
  PhysicalSize operator*(std::array<double, 2> factor) const { return {width * factor[0], height * factor[1]}; }
  bool operator==(const PhysicalSize&) const = default;
};

class Material;
using MaterialPtr = std::shared_ptr<const Material>;

/// A named, ordered set of images that share one uv domain: a relative position is the same surface point in every map.
/// Sizes may differ. Immutable; thread-safe.
class Material {
 public:
  /// Throws Error if there is no map, or if two maps have the same name.
  static MaterialPtr make(std::string name, std::vector<Map> maps, PhysicalSize metres = {});
  /// A material of one map, named after the image's semantic.
  static MaterialPtr of(const ImagePtr& image);

  const std::string& name() const { return name_; }
  const std::vector<Map>& maps() const { return maps_; }
  PhysicalSize metres() const { return metres_; }  ///< of the surface that the maps show
  /// Null if there is no such map.
  ImagePtr find(std::string_view map) const;
  /// The first map of that semantic; null if there is none.
  ImagePtr find(Semantic semantic) const;
  /// The size at which the material is analysed and synthesized: that of its largest map.
  Size size() const;
  /// The names of the maps, comma separated, for messages.
  std::string map_names() const;
  const Digest& digest() const { return digest_; }

 private:
  Material(std::string name, std::vector<Map> maps, PhysicalSize metres);
  std::string name_;
  std::vector<Map> maps_;
  PhysicalSize metres_;
  Digest digest_;
};

}  // namespace terrazzo
