#include "runner/terminal/written_files.h"

#include <algorithm>
#include <string_view>

#include <fcntl.h>
#include <fmt/format.h>

#include "core/base/paths.h"
#include "core/base/text.h"
#include "core/file/file_io.h"
#include "core/naming/file_stems.h"
#include "runner/plan/preflight.h"
#include "runner/report/page.h"
#include "runner/report/run_summary.h"
#include "runner/terminal/usage.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

std::string_view name_of(WrittenKind kind) {
  switch (kind) {
    case WrittenKind::page:
      return "page of terrazzo";
    case WrittenKind::trace:
      return "timeline of terrazzo";
    case WrittenKind::summary:
      return "summary of a run";
    case WrittenKind::table:
      return "table";
    case WrittenKind::picture:
      return "picture";
    case WrittenKind::graph:
      return "graph file";
    case WrittenKind::drawing:
      return "drawing of a graph";
    case WrittenKind::pack:
      return "pack";
    case WrittenKind::zip:
      return "zip file";
  }
  return "";
}

bool is_regular(const fs::path& path) {
  std::error_code missing;
  return fs::is_regular_file(path, missing);
}

bool is_device(const fs::path& path) {
  std::error_code missing;
  return fs::exists(path, missing) && !fs::is_regular_file(path, missing) && !fs::is_directory(path, missing);
}

std::string beginning_of(const fs::path& path) {
  constexpr size_t enough = 1 << 20;  // the comments before a graph may be long
  const File file = File::open(path, O_RDONLY | O_NONBLOCK);
  if (!file.ok()) return "";
  std::string text(enough, '\0');
  text.resize(file.read_at(0, text.data(), text.size(), path));
  return text;
}

bool is_plain_text(std::string_view text) {
  return std::ranges::none_of(text, [](char c) {
    const auto code = static_cast<unsigned char>(c);
    return code < 0x20 && c != '\n' && c != '\r' && c != '\t';
  });
}

bool looks_like_picture(const fs::path& path, std::string_view text) {
  using namespace std::string_view_literals;
  if (lowercase(path.extension().string()) == ".tga") return true;  // TGA has no signature
  constexpr std::string_view marks[] = {"\x89PNG"sv, "\xff\xd8\xff"sv, "II*\0"sv,
                                        "MM\0*"sv,   "II+\0"sv,        "\x76\x2f\x31\x01"sv};
  return std::ranges::any_of(marks, [&](std::string_view mark) { return text.starts_with(mark); });
}

/// Whether a file has the kind that the option writes; empty files match any kind.
bool is_of_kind(const fs::path& path, WrittenKind kind) {
  const std::string text = beginning_of(path);
  const auto begins_with = [&](std::string_view word) { return text.substr(0, 1024).find(word) != text.npos; };
  if (text.empty()) return true;
  switch (kind) {
    case WrittenKind::page:
      return begins_with(page_mark);
    case WrittenKind::trace:
      return text[0] == '{' && begins_with("\"traceEvents\"");
    case WrittenKind::summary:
      return text[0] == '{' && begins_with(summary_mark);
    case WrittenKind::table:
      return is_plain_text(text) && std::string_view("{[<").find(text[0]) == std::string_view::npos;
    case WrittenKind::picture:
      return looks_like_picture(path, text);
    case WrittenKind::graph:
      return is_plain_text(text) && text.find("\"terrazzo\"") != text.npos;
    case WrittenKind::drawing:
      return begins_with("<svg") || begins_with("digraph");
    case WrittenKind::pack:
      return text.size() > 262 && text.substr(257).starts_with("ustar");
    case WrittenKind::zip:
      return text.starts_with("PK\3\4");
  }
  return false;
}

/// Whether writing one path overwrites the other.
bool are_the_same(const fs::path& a, const fs::path& b) {
  std::error_code missing;
  return fs::equivalent(a, b, missing) || place_of_file(a) == place_of_file(b);
}

}  // namespace

std::vector<ProtectedFile> inputs_of(const Graph& graph) {
  std::vector<ProtectedFile> out;
  if (is_regular(graph.file)) out.push_back({graph.file, "it is the graph file"});
  for (const fs::path& path : graph.made_from)
    if (is_regular(path)) out.push_back({path, "the graph is made from it"});
  for (const GraphNode& node : graph.nodes) {
    if (!node.type->files_read || node.is_open) continue;
    for (const fs::path& path : node.type->files_read(node.params))
      out.push_back({path, fmt::format("the node \"{}\" reads it", node.name)});
  }
  return out;
}

std::vector<ProtectedFile> outputs_of(const Plan& plan) {
  std::vector<ProtectedFile> out;
  for (const FileToWrite& f : files_to_write(plan))
    out.push_back(
        {f.path, fmt::format("the node \"{}\" {} it", f.node, f.is_pattern ? "may write" : "writes"), f.is_pattern});
  return out;
}

std::vector<ProtectedFile> outputs_of(const RunResult& result) {
  std::vector<ProtectedFile> out;
  for (const StageOutcome& s : result.stages)
    for (const OutputFile& f : s.files) out.push_back({f.path, fmt::format("the node \"{}\" has written it", s.node)});
  return out;
}

std::vector<ProtectedFile> files_at(const fs::path& place, const std::string& why) {
  std::vector<ProtectedFile> out;
  std::error_code ended;
  if (!place.empty()) out.push_back({place, why});
  for (fs::directory_iterator at(place, ended), end; !ended && at != end; at.increment(ended))
    out.push_back({at->path(), why});
  return out;
}

void check_replaced(const std::vector<WrittenFile>& files, bool force) {
  for (size_t i = 0; i < files.size(); i++) {
    const WrittenFile& file = files[i];
    if (file.path.empty() || is_device(file.path)) continue;
    check_writable(file.option.c_str(), file.path);
    for (size_t j = 0; j < i; j++)
      if (!files[j].path.empty() && are_the_same(file.path, files[j].path))
        throw UsageError(
            fmt::format("{} {}: {} names the same file; name another", file.option, file.path, files[j].option));
    if (!force && is_regular(file.path) && !is_of_kind(file.path, file.kind))
      throw UsageError(
          fmt::format("{} {}: a file of that name exists and is no {}; name another, or overwrite it with --force",
                      file.option, file.path, name_of(file.kind)));
  }
}

void check_protected(const std::vector<WrittenFile>& files, const std::vector<ProtectedFile>& kept) {
  for (const WrittenFile& file : files) {
    if (file.path.empty() || is_device(file.path)) continue;
    for (const ProtectedFile& k : kept) {
      const bool is_meant = k.is_pattern
                                ? matches_pattern(place_of_file(file.path).string(), place_of_file(k.path).string())
                                : are_the_same(file.path, k.path);
      if (!is_meant) continue;
      const bool has_same_name = k.is_pattern || place_of_file(file.path) == place_of_file(k.path);
      throw UsageError(fmt::format("{} {}: this would overwrite {}, but {}; name another file", file.option, file.path,
                                   has_same_name ? "that file" : k.path.string(), k.why));
    }
  }
}

}  // namespace terrazzo
