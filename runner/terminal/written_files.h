#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "graphs/text/graph.h"
#include "runner/engine/schedule.h"

/// Files that commands write in addition to nodes' files, and checks that they overwrite nothing of value.
namespace terrazzo {

enum class WrittenKind : uint8_t { page, trace, summary, table, picture, graph, drawing, pack, zip };

struct WrittenFile {
  std::string option;  ///< the option that names it, for messages: "--report"
  std::string path;    ///< empty: not requested
  WrittenKind kind = WrittenKind::page;
};

/// A file that must not be overwritten, with the reason: "the graph file", "the node \"photo\" reads it".
struct ProtectedFile {
  std::filesystem::path path;
  std::string why;
  bool is_pattern = false;  ///< * stands for unknown parts of the name
};

/// The files that a graph is made from and that its nodes read.
std::vector<ProtectedFile> inputs_of(const Graph& graph);
/// The files that a plan's nodes will write, as far as they are known.
std::vector<ProtectedFile> outputs_of(const Plan& plan);
/// The files that the nodes of a run have written.
std::vector<ProtectedFile> outputs_of(const RunResult& result);
/// The files in a folder, or the file itself.
std::vector<ProtectedFile> files_at(const std::filesystem::path& place, const std::string& why);

/// Throws UsageError if one of the files would replace a file of another kind (unless `force`), if two of them are the
/// same, or if one cannot be written. Devices and pipes are always allowed.
void check_replaced(const std::vector<WrittenFile>& files, bool force);
/// Throws UsageError if one of the files is a kept one under any name or link. No flag overrides this.
void check_protected(const std::vector<WrittenFile>& files, const std::vector<ProtectedFile>& kept);

/// The help text of --force.
inline constexpr const char* force_help = "Also overwrite files of another kind; never what the command reads";

}  // namespace terrazzo
