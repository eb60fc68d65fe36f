#pragma once

#include <map>
#include <string>
#include <vector>

#include "graphs/text/graph.h"
#include "runner/terminal/command.h"

/// How commands look at an exemplar before they choose.
namespace terrazzo {

/// The folder of an exemplar, and what the command line says about it.
struct ExemplarFlags {
  std::string folder;
  std::string name{};                    ///< which material of the folder; empty: the only one
  std::vector<std::string> interpret{};  ///< MAP=HOW

  /// The parameter `interpret` of load_material. Throws UsageError.
  std::map<std::string, std::string> interpretations() const;
};

/// The argument FOLDER, --name and --interpret.
void add_exemplar_flags(Command& command, ExemplarFlags& flags);

/// Reads the maps of a folder ("exemplar"), weights them ("weighted"), and looks for what repeats ("lattice") and for
/// elements ("elements"), as graphs/material.json does. Throws UsageError.
Graph inspection_graph(const ExemplarFlags& flags);

}  // namespace terrazzo
