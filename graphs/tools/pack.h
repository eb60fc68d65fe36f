#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "graphs/document/load.h"

/// A graph with all that it reads in one file, which runs elsewhere. It is a tar archive:
///   graph.json      the graph, with its subgraphs and presets in it
///   settings.json   where its inputs lie, relative to this file, as for --params
///   sources.json    for settings that are made from others: which these are. If one of them is set, they do not count.
///                   Without it nothing else than what the settings name may be set
///   inputs/, loops/ the files
namespace terrazzo {

struct PackedFiles {
  size_t count = 0;
  uint64_t bytes = 0;
  std::vector<std::string> left_out;  ///< files that nodes read and that no parameter names
  std::vector<std::string> renamed;   ///< sentences on what is called otherwise in the pack
};

/// Packs a graph with these values (see load_graph). What would be written where, stays relative to where the pack will
/// lie. Throws GraphError, Error or FileError.
PackedFiles write_pack(const std::filesystem::path& graph, const std::vector<std::string>& overrides,
                       const LoadOptions& options, const std::filesystem::path& target);

/// Whether a file is a pack, or at least an archive.
bool is_pack(const std::filesystem::path& file);

/// The graph of a pack, without unpacking it. Throws Error for what is no pack.
std::string graph_in_pack(const std::filesystem::path& pack);

/// Unpacks into a folder of its own in `folder` and returns it, for LoadOptions::pack. A copy that is there already is
/// compared with the pack, and mended. Removes what others have not used for a month. Throws Error for what is no pack,
/// FileError if it cannot be unpacked there.
std::filesystem::path unpacked(const std::filesystem::path& pack, const std::filesystem::path& folder);

}  // namespace terrazzo
