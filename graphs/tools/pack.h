#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "graphs/document/load.h"

/// A pack holds a graph and all files it reads, so that it can run on another machine. It is a tar archive:
///   graph.json      the graph, including its subgraphs and presets
///   settings.json   the paths of its inputs, relative to this file, as for --params
///   sources.json    for settings derived from other parameters: which ones. Setting such a parameter drops the derived
///                   setting. Without this file only the settings' own names can be set
///   inputs/, loops/ the files
namespace terrazzo {

struct PackedFiles {
  size_t count = 0;
  uint64_t bytes = 0;
  std::vector<std::string> left_out;  ///< files that nodes read but no parameter names
  std::vector<std::string> renamed;   ///< sentences about files with another name in the pack
};

/// Packs a graph with these values (see load_graph). Output paths become relative to the pack's location. Throws
/// GraphError, Error or FileError.
PackedFiles write_pack(const std::filesystem::path& graph, const std::vector<Override>& overrides,
                       const LoadOptions& options, const std::filesystem::path& target);

/// Whether a file is an archive, and so probably a pack.
bool is_pack(const std::filesystem::path& file);

/// The graph of a pack, without unpacking it. Throws Error if the file is no pack.
std::string graph_in_pack(const std::filesystem::path& pack);

/// Unpacks into a subfolder of `folder` and returns it, for LoadOptions::pack. Verifies and repairs an existing copy.
/// Removes other packs that have not been used for a month. Throws Error if the file is no pack, FileError if it cannot
/// be unpacked there.
std::filesystem::path unpacked(const std::filesystem::path& pack, const std::filesystem::path& folder);

}  // namespace terrazzo
