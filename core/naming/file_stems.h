#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/naming/file_words.h"

/// Which material of a folder a file belongs to.
namespace terrazzo {

/// What a file's name says besides the map: "Bricks075" of Bricks075_2K-PNG_Color.png. Resolutions, formats and
/// versions aside. UDIM tiles are materials of their own: "wall.1002" of wall_color.1002.exr.
struct Stem {
  std::vector<std::string> words;
  std::string shown;  ///< as the name spells it; empty for color.png

  std::string key() const;  ///< the same for all spellings
};

/// Whether a stem has the words that name nothing: texture, tex, map, ...
enum class Fillers : uint8_t { stripped, kept };

/// The stem of a file whose words [first, last) say which map it is. Where no word stands before them, those behind
/// count: color_sand.png.
Stem stem_of(std::string_view name, const std::vector<NameWord>& words, size_t first, size_t last,
             Fillers fillers = Fillers::stripped);

/// The stem that a text means.
Stem stem_in(std::string_view text, Fillers fillers = Fillers::stripped);

/// Whether the longer of the two begins with the words of the other: wall, wall_fine. Not so stone, wall_stone.
bool is_extension(const Stem& a, const Stem& b);

/// The UDIM tile that a material's name ends in: "1002" of "wall.1002"; empty if it names none.
std::string udim_tile_of(std::string_view name);

/// The name without it: "wall".
std::string without_udim_tile(std::string_view name);

/// A map and the stem of its file.
struct StemmedMap {
  Stem stem;
  std::string map;
  bool is_color = false;  ///< the base colour
};

/// Files that make one material.
struct FolderMaterial {
  std::string name;                ///< the stem as most of its files spell it
  std::vector<std::string> stems;  ///< the keys of all its stems
  std::vector<std::string> maps;   ///< without repetitions
};

/// Whether `material` has a stem with which the file's name begins, or one without words.
bool may_belong_to(std::string_view file, const FolderMaterial& material);

/// Sorts files by material. Files of one stem belong together. So do stems of which one has all words of the other
/// (wall, wall_fine), unless both have a base colour, or both have a map and numbers or words in front tell them apart
/// (stone, wall_stone), or it is not clear which: then they are several. The order of `maps` does not matter.
std::vector<FolderMaterial> materials_among(const std::vector<StemmedMap>& maps);

/// The materials that `name` means: a stem in any spelling, a pattern with the wildcards * and ?, or the name of one
/// of its files, `file_stems` its possible stems.
struct MeantMaterials {
  std::vector<FolderMaterial> materials{};
  std::string stem{};  ///< the key of the stem that was named; empty for patterns
};
MeantMaterials materials_named(const std::vector<FolderMaterial>& all, const std::string& name,
                               const std::vector<Stem>& file_stems);

/// What a file's name says besides the name of its material: "translucency" of wall_2K_translucency.png; the whole name
/// if that is all.
std::string rest_of_name(std::string_view file, const std::vector<FolderMaterial>& materials);

}  // namespace terrazzo
