#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "runner/cli/exemplar/exemplar_inspection.h"

/// The graphs that `synth` runs: stock graphs, changed where the command line asks for what they have no parameter for.
namespace terrazzo {

/// The names of export presets that --engine takes.
std::vector<std::string> engine_names();

/// The stock graph ("material", "noise"), which reads a single picture if the exemplar is one, and writes what `engine`
/// takes unless that is empty. As JSON text.
std::string synth_graph(std::string_view stock, const ExemplarFlags& exemplar, const std::string& engine);

}  // namespace terrazzo
