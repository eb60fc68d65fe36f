#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/image_io/image_file.h"
#include "core/node/node.h"

/// Where the node `export` writes to, as far as its parameters say. All throw Error naming the parameter.
namespace terrazzo {

/// What stands for the placeholders of a pattern.
struct PathValues {
  std::string map;
  std::string material;
  Size size;
};

/// Fills {map}, {material}, {width}, {height} and <UDIM>, the tile that the material's name ends in; beside that,
/// {material} is the name without it. Throws for unknown ones, unmatched braces, and materials that are no tiles.
std::string filled(const char* param, const std::string& pattern, const PathValues& values);

/// The format that a path's extension names.
FileFormat required_format(const char* param, const std::filesystem::path& path);

/// Throws unless `path` can name a file for each map; `maps` are the names of those to be written, as far as they are
/// known.
void require_pattern_for(const std::string& path, const std::vector<std::string>& maps);

/// The parameter that says where the uv map goes: `uv_path`, else `path` with "uv" for the map's name.
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
