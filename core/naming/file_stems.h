#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/naming/file_words.h"

/// Groups the files of a folder into materials by their names.
namespace terrazzo {

/// The part of a file's name that identifies the material: "Bricks075" in Bricks075_2K-PNG_Color.png, without map,
/// resolution, format and version. UDIM tiles are materials of their own: "wall.1002" in wall_color.1002.exr.
struct Stem {
  std::vector<std::string> words;
  std::string shown;  ///< as spelled in the name; empty for color.png

  std::string key() const;  ///< the same for all spellings
};

/// Whether a stem includes filler words: texture, tex, map, ...
enum class Fillers : uint8_t { stripped, kept };

/// The stem of a file whose words [first, last) are the map keyword: the words before it, or, if there are none, the
/// words after it (color_sand.png).
Stem stem_of(std::string_view name, const std::vector<NameWord>& words, size_t first, size_t last,
             Fillers fillers = Fillers::stripped);

/// The stem of any text.
Stem stem_in(std::string_view text, Fillers fillers = Fillers::stripped);

/// Whether the longer stem begins with the words of the shorter one: wall, wall_fine, but not stone, wall_stone.
bool is_extension(const Stem& a, const Stem& b);

/// The UDIM tile at the end of a material's name: "1002" in "wall.1002"; empty if there is none.
std::string udim_tile_of(std::string_view name);

/// The name without the tile: "wall".
std::string without_udim_tile(std::string_view name);

/// A map and the stem of its file.
struct StemmedMap {
  Stem stem;
  std::string map;
  bool is_color = false;  ///< the base colour
};

/// Files that belong to one material.
struct FolderMaterial {
  std::string name;                ///< the stem in the spelling of most of its files
  std::vector<std::string> stems;  ///< the keys of all its stems
  std::vector<std::string> maps;   ///< without repetitions
};

/// Whether the file's name begins with a stem of `material`, or the material has an empty stem.
bool may_belong_to(std::string_view file, const FolderMaterial& material);

/// Groups files by material. Files with the same stem belong together. Stems where one contains all words of the other
/// (wall, wall_fine) also do, unless both have a base colour, both have the same map and differ by numbers or leading
/// words (stone, wall_stone), or the match is ambiguous. The order of `maps` does not matter.
std::vector<FolderMaterial> materials_among(const std::vector<StemmedMap>& maps);

/// The materials that `name` selects: by a stem in any spelling, a pattern with the wildcards * and ?, or the name of
/// one of their files, whose possible stems are `file_stems`.
struct MeantMaterials {
  std::vector<FolderMaterial> materials{};
  std::string stem{};  ///< key of the selected stem; empty for patterns
};
MeantMaterials materials_named(const std::vector<FolderMaterial>& all, const std::string& name,
                               const std::vector<Stem>& file_stems);

/// A file's name without that of its material: "translucency" for wall_2K_translucency.png; the whole name if nothing
/// else remains.
std::string rest_of_name(std::string_view file, const std::vector<FolderMaterial>& materials);

}  // namespace terrazzo
