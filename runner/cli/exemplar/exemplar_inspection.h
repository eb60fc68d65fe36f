#pragma once

#include <map>
#include <string>
#include <vector>

#include "graphs/text/graph.h"
#include "runner/terminal/command.h"

/// Inspects an exemplar before choosing a graph and its parameters.
namespace terrazzo {

/// The exemplar, and the options about it.
struct ExemplarFlags {
  std::string folder;                    ///< of its maps, or a picture
  std::string name{};                    ///< the material in the folder; empty: the only one
  std::vector<std::string> interpret{};  ///< MAP=HOW

  /// Whether the exemplar is a single picture, its base colour.
  bool is_picture() const;
  /// The folder, or that of the picture.
  std::string folder_of_maps() const;

  /// The parameter `interpret` of load_material. Throws UsageError.
  std::map<std::string, std::string> interpretations() const;
};

/// The argument FOLDER, --name and --interpret.
void add_exemplar_flags(Command& command, ExemplarFlags& flags);

/// Throws UsageError if the exemplar is a picture and options say what only folders have.
void check_picture_flags(const ExemplarFlags& flags);

/// A graph that reads the maps of a folder ("exemplar"), weights them ("weighted"), and detects a lattice ("lattice")
/// and elements ("elements"), as graphs/material.json does. Throws UsageError.
Graph inspection_graph(const ExemplarFlags& flags);

}  // namespace terrazzo
