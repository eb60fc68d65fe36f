#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/image_io/image_file.h"
#include "core/node/node.h"

/// Writes maps to files, for sinks.
namespace terrazzo {

/// One file to write.
struct MapFileJob {
  std::string name;  ///< for notes
  ImagePtr image;
  std::filesystem::path target;
  std::filesystem::path temporary{};
  bool has_levels = false;  ///< writes mip levels to separate files
  ImagePtr weights{};       ///< of colours in mip levels, see core/filter/opacity_weights.h
  std::vector<std::filesystem::path> level_temporaries{};
  WriteOptions options{};
  Clipping clipped{};
};

/// Parameter "depth" of nodes that write maps.
Param depth_param();
/// Throws Error about "depth" unless the format supports the parameter's value.
void require_depth(FileFormat format, const std::string& depth);
/// The depth for the parameter value `wanted`; "keep": the format's depth closest to the map's, lossless if possible.
Depth written_depth(FileFormat format, const std::string& wanted, Depth have);

/// Parameter "mips" of nodes that write maps.
Param mips_param();

/// The file of a mip level: wall_normal.mip1.png for wall_normal.png.
std::filesystem::path mip_file(std::filesystem::path file, int level);

/// Stages the files of a job and of its mip levels.
void stage_job(NodeContext& node, MapFileJob& job);

/// Weights colours by opacity in the job's mip levels, if it has any, and adds a note. `opacity` may be null.
void weigh_levels(NodeContext& node, MapFileJob& job, const ImagePtr& opacity);

/// Adds notes on losses by the chosen format and depth.
void tell_of_losses(NodeContext& node, const MapFileJob& job, bool depth_was_asked_for);

/// Throws Error about "path" if two files have the same name.
void require_distinct(const std::vector<MapFileJob>& jobs);

/// Writes all files in parallel and adds notes on clipped values. Progress is the mean over the files.
void write_all(NodeContext& node, std::vector<MapFileJob>& jobs);

}  // namespace terrazzo
