#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/filter/exemplar_faults.h"
#include "core/material/material.h"
#include "core/stochastic/method.h"

namespace terrazzo {

/// Findings about an exemplar.
struct ExemplarFindings {
  MaterialPtr exemplar;
  std::filesystem::path folder;                    ///< of its maps, as spelled in the graph
  std::string name{};                              ///< of the requested material in the folder, if any
  std::map<std::string, std::string> interpret{};  ///< the user's interpretation of maps, see load_material
  std::vector<std::string> notes;                  ///< of load_material
  std::vector<std::string> lattice_notes;          ///< of regularity
  bool repeats = false;                            ///< a lattice was found
  bool streaks = false;                            ///< it continues along an axis
  bool tiles = false;                              ///< opposite borders match
  MethodChoice method{};                           ///< the recommended method
  ExemplarFaults faults{};                         ///< of the base colour

  /// A sentence on what kind of exemplar it is.
  std::string nature() const;
  /// A sentence that recommends the stock graph `material` or `noise`, with the reason.
  std::string advice() const;
  /// A sentence on light that was baked in; empty if there is none.
  std::string light() const;
};

/// Whether a graph has a parameter for an exemplar's folder, or for a single picture, and declares no inputs.
bool takes_an_exemplar(std::string_view graph, bool is_picture);

/// Adapts a stock graph to this exemplar: sets its folder or picture, weights, and whether to search for a lattice.
/// Takes out baked-in light. Adds comments on the findings, the choices with their reasons, and parameters worth
/// changing.
std::string starting_graph(const ExemplarFindings& look, std::string_view stock);

}  // namespace terrazzo
