#pragma once

#include <string>
#include <vector>

#include "core/material/map_candidates.h"

/// Groups the candidates of a folder into materials and chooses one. The functions change the candidates in place and
/// are called in this order. They read no files.
namespace terrazzo {

/// Resolves clashes between stems. A leading filler word such as "texture" counts only if the stems would be equal
/// without it (rock_color, texture_rock_color). A word after the keyword counts only if the plain keyword also occurs
/// (basecolor, basecolor-boosted).
void settle_stems(std::vector<Candidate>& maps);

/// Uses a picture named like a material, and of the size of its maps, as base colour if the material has none.
void add_colors_named_like_materials(Candidates& candidates);

/// Marks maps whose names contain no material name although most others' do. Removes those whose size differs from the
/// others'.
void leave_out_strangers(Candidates& candidates);

/// The materials in a folder, and the requested ones.
struct MaterialChoice {
  std::vector<FolderMaterial> all{};
  std::vector<FolderMaterial> meant{};
  std::string name{};     ///< of the requested material, if any
  bool is_clear = false;  ///< whether the request is unambiguous
};

/// Removes candidates that do not belong to the material `name`; empty: the only material.
MaterialChoice keep_one_material(Candidates& candidates, const std::string& name);

}  // namespace terrazzo
