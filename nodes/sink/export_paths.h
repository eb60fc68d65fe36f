#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/image_io/image_file.h"
#include "core/node/node.h"

/// Output paths of the node `export`, from its parameters. All functions throw Error naming the parameter.
namespace terrazzo {

/// The values of a pattern's placeholders.
struct PathValues {
  std::string map;
  std::string material;
  Size size;
};

/// Fills in {map}, {material}, {width}, {height} and <UDIM>, the tile at the end of the material's name; with <UDIM>,
/// {material} is the name without the tile. Throws for unknown placeholders, unmatched braces, and materials without a
/// tile.
std::string filled(const char* param, const std::string& pattern, const PathValues& values);

/// The format of a path's extension.
FileFormat required_format(const char* param, const std::filesystem::path& path);

/// Throws unless `path` gives each map a file of its own. `maps`: the names of the maps to write, as far as they are
/// known.
void require_pattern_for(const std::string& path, const std::vector<std::string>& maps);

/// The parameter with the uv map's path: `uv_path`, else `path`, with "uv" as the map's name.
const char* param_of_uv(const Params& params);

/// Throws Error about "uv_path" unless the file's format holds a uv map exactly.
void require_exact_format(const std::filesystem::path& path);

/// Whether a report goes to a .csv file rather than a .json file.
bool is_csv(const std::filesystem::path& report_path);
void require_report_path(const std::filesystem::path& report_path);

/// Throws if nothing is connected.
void require_some_input(bool connected);

/// The node's preflight, see NodeType.
Forecast foresee_export(const Params& params, const InputForecasts& inputs);

}  // namespace terrazzo
