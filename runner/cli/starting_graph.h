#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/material/material.h"
#include "core/stochastic/method.h"

namespace terrazzo {

/// What has been found out about an exemplar.
struct ExemplarFindings {
  MaterialPtr exemplar;
  std::filesystem::path folder;                    ///< of its maps, as a graph should name it
  std::string name{};                              ///< of the material in the folder, where one was asked for
  std::map<std::string, std::string> interpret{};  ///< what the user says of maps, see load_material
  std::vector<std::string> notes;                  ///< of load_material
  std::vector<std::string> lattice_notes;          ///< of regularity
  bool repeats = false;                            ///< a lattice was found
  bool streaks = false;                            ///< it goes on along an axis
  bool tiles = false;                              ///< opposite borders fit
  MethodChoice method{};                           ///< which way suits it

  /// A sentence on what kind of exemplar it is.
  std::string nature() const;
  /// A sentence on which of the stock graphs material and noise suits it, and why.
  std::string advice() const;
};

/// Whether a graph has a parameter for the folder of an exemplar, and is none that is a node of others.
bool takes_a_folder(std::string_view graph);

/// A stock graph for this exemplar: its folder, weights, and whether a lattice is looked for, with comments on what was
/// found, what was chosen and why, and what is worth changing.
std::string starting_graph(const ExemplarFindings& look, std::string_view stock);

}  // namespace terrazzo
