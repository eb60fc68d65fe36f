#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "graphs/text/graph.h"
#include "runner/engine/schedule.h"

/// What commands write besides the files of nodes, and what must not be lost by it.
namespace terrazzo {

enum class WrittenKind : uint8_t { page, trace, summary, table, picture, graph, drawing, pack };

struct WrittenFile {
  std::string option;  ///< that names it, for messages: "--report"
  std::string path;    ///< empty: it was not asked for
  WrittenKind kind = WrittenKind::page;
};

/// A file that must stay, and why: "the graph file", "the node \"photo\" reads it".
struct ProtectedFile {
  std::filesystem::path path;
  std::string why;
  bool is_pattern = false;  ///< * stands for what is not known yet
};

/// What a graph is made from and what its nodes read.
std::vector<ProtectedFile> inputs_of(const Graph& graph);
/// The files that a plan's nodes are known to write.
std::vector<ProtectedFile> outputs_of(const Plan& plan);
/// The files that the nodes of a run have written.
std::vector<ProtectedFile> outputs_of(const RunResult& result);
/// The files that lie in a folder, or the file itself.
std::vector<ProtectedFile> files_at(const std::filesystem::path& place, const std::string& why);

/// Throws UsageError if one of the files takes the place of a file of another kind, unless `force`; if two of them are
/// the same; or if one cannot be written. Devices and pipes may always be written to.
void check_replaced(const std::vector<WrittenFile>& files, bool force);
/// Throws UsageError if one of the files is a kept one, by whatever name or link. No flag allows that.
void check_protected(const std::vector<WrittenFile>& files, const std::vector<ProtectedFile>& kept);

/// What --force does, for the help of commands.
inline constexpr const char* force_help = "Also overwrite files of another kind; never what the command reads";

}  // namespace terrazzo
