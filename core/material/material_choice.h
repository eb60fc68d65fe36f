#pragma once

#include <string>
#include <vector>

#include "core/material/map_candidates.h"

/// Which material of a folder the candidates belong to. Each function changes the candidates in place and is called in
/// this order. Reads no files.
namespace terrazzo {

/// Settles what two files of one stem mean: words such as "texture" in front count only where the stems would clash
/// without them (rock_color, texture_rock_color), and so do words behind a keyword that stands there plain as well
/// (basecolor, basecolor-boosted).
void settle_stems(std::vector<Candidate>& maps);

/// A picture named just like a material that has no base colour, and of the size of its maps, is its base colour.
void add_colors_named_like_materials(Candidates& candidates);

/// Marks maps whose names say no material, unlike most others', and leaves out those whose size the others don't have.
void leave_out_strangers(Candidates& candidates);

/// What a folder holds, and what is meant of it.
struct MaterialChoice {
  std::vector<FolderMaterial> all{};
  std::vector<FolderMaterial> meant{};
  std::string name{};     ///< of the material, if one was asked for
  bool is_clear = false;  ///< whether it is clear which is meant
};

/// Leaves out the candidates of other materials than `name` means; empty: there is only one.
MaterialChoice keep_one_material(Candidates& candidates, const std::string& name);

}  // namespace terrazzo
