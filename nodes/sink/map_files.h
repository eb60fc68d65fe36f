#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/image_io/image_file.h"
#include "core/node/node.h"

/// Maps on their way into files, for the nodes that write them.
namespace terrazzo {

/// One file to write.
struct MapFileJob {
  std::string name;  ///< for notes
  ImagePtr image;
  std::filesystem::path target;
  std::filesystem::path temporary{};
  bool has_levels = false;  ///< mip levels get files of their own
  ImagePtr weights{};       ///< of colours in mip levels, see core/filter/opacity_weights.h
  std::vector<std::filesystem::path> level_temporaries{};
  WriteOptions options{};
  Clipping clipped{};
};

/// Parameter "depth" of nodes that write maps.
Param depth_param();
/// Throws Error about "depth" unless the format holds what the parameter says.
void require_depth(FileFormat format, const std::string& depth);
/// The depth that the parameter `wanted` says; "keep": the format's nearest to the map's, lossless if there is one.
Depth written_depth(FileFormat format, const std::string& wanted, Depth have);

/// Parameter "mips" of nodes that write maps.
Param mips_param();

/// The file of a mip level: wall_normal.mip1.png of wall_normal.png.
std::filesystem::path mip_file(std::filesystem::path file, int level);

/// Asks for the temporary files of a job and of its mip levels.
void stage_job(NodeContext& node, MapFileJob& job);

/// Lets colours count by their opacity in mip levels, if the job has any, and says so. `opacity` may be null.
void weigh_levels(NodeContext& node, MapFileJob& job, const ImagePtr& opacity);

/// Tells what is lost by the format and depth that have been chosen.
void tell_of_losses(NodeContext& node, const MapFileJob& job, bool depth_was_asked_for);

/// Throws Error about "path" if two files have the same name.
void require_distinct(const std::vector<MapFileJob>& jobs);

/// Writes all files, several at once, and tells what was clipped; progress is their mean.
void write_all(NodeContext& node, std::vector<MapFileJob>& jobs);

}  // namespace terrazzo
