#include "runner/cli/exemplar/library_making.h"

#include <chrono>
#include <ctime>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "core/analysis/space/likeness.h"
#include "core/exemplar/appearance.h"
#include "core/file/file_io.h"
#include "core/filter/resample.h"
#include "core/image_io/image_file.h"
#include "graphs/document/load.h"
#include "graphs/text/stock_graphs.h"
#include "nodes/source/maps/material_folder.h"
#include "runner/api/session.h"
#include "runner/cli/cli_commands.h"
#include "runner/plan/memory_graph.h"
#include "runner/plan/preflight.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

constexpr int picture_side = 256;

std::string absolute(const std::string& path) {
  std::string out = fs::absolute(path).lexically_normal().string();
  if (out.size() > 1 && out.ends_with('/')) out.pop_back();
  return out;
}

/// The stock graph that analyses a folder or a picture.
Graph analysing_graph(const LibraryAddition& asked, const fs::path& target) {
  std::vector<Override> set = {override_of("material", asked.source), override_of("out", target.string())};
  for (Override& o : overrides_from(asked.set)) set.push_back(std::move(o));
  return load_graph_text(stock_graph("analyse"), "stock graph analyse.json", set, {.look_ahead = preflight_of_nodes})
      .graph;
}

/// The same nodes for an existing analysis.
Graph copying_graph(const LibraryAddition& asked, const fs::path& target) {
  if (!asked.set.empty()) throw UsageError("--set needs a folder of maps; SOURCE is a finished analysis");
  Graph graph;
  graph.nodes = {memory_node("index", "load_analysis", {{"path", absolute(asked.source)}}),
                 memory_node("file", "save_analysis", {{"path", target.string()}})};
  graph.nodes[1].inputs["index"] = {{"index", "index"}};
  if (!asked.material.empty())
    graph.nodes.push_back(memory_node("exemplar", "load_material", {{"path", absolute(asked.material)}}));
  return graph;
}

const GraphNode* find_node(const Graph& graph, const std::string& name) {
  for (const GraphNode& n : graph.nodes)
    if (n.name == name) return &n;
  return nullptr;
}

/// The whole exemplar, lit, in a picture of its proportions.
GraphNode picture_node() {
  GraphNode node = memory_node("picture", "preview", {{"size", Size{picture_side, 0}}});
  node.inputs["material"] = {{"exemplar", "material"}};
  return node;
}

/// A picture of an analysis without maps: the first channel of its coarse fingerprint.
ImagePtr picture_of(const Fingerprint& fingerprint) {
  if (fingerprint.channels.empty()) return nullptr;
  std::vector<float> pixels;
  for (const uint8_t v : fingerprint.channels.front().means) pixels.push_back(float(v) / 255);
  const ImagePtr small =
      Image::from_floats({.size = fingerprint.cells, .channels = 1, .semantic = Semantic::data}, std::move(pixels));
  return resampled(small, {fingerprint.cells.width * 8, fingerprint.cells.height * 8}, "nearest", Outside::clamp,
                   Hasher().add("picture").add(small->digest()).digest());
}

void require_analysed(const Fingerprint& fingerprint, const Material& material, const std::string& folder) {
  const std::optional<Likeness> found = likeness(fingerprint, material, Task());
  if (found && found->correlation < least_likeness())
    throw Error(
        fmt::format("--material {}: these are not the maps that were analysed (correlation {:.2f}, expected {} "
                    "or more); --other-material takes them anyway",
                    folder, found->correlation, least_likeness()));
}

std::string today() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  return fmt::format("{:%Y-%m-%d}", fmt::localtime(now));
}

/// Adds the folder, the names of the maps and the content of their files.
void add_material(LibraryEntry& entry, const GraphNode& exemplar, const Material& material) {
  entry.material = std::get<std::string>(exemplar.params.at("path"));
  for (const Map& map : material.maps()) entry.maps.push_back(map.name);
  const fs::path folder = folder_of(exemplar.params);
  for (const fs::path& file : exemplar.type->files_read(exemplar.params)) {
    const fs::path inside = file.lexically_relative(folder);
    const std::optional<Digest> content = content_digest(file);
    if (content && !inside.empty() && *inside.begin() != "..") entry.files[inside.generic_string()] = *content;
  }
}

}  // namespace

std::optional<LibraryEntry> made_entry(const LibraryAddition& asked, const fs::path& place,
                                       const std::atomic<bool>& cancelled, RunResult& result) {
  const bool has_pixels = fs::is_directory(asked.source) || looks_like_image(asked.source);
  if (has_pixels && !asked.material.empty())
    throw UsageError("--material needs an analysis; SOURCE already holds the maps");
  LibraryEntry entry;
  entry.analysis = place / "new.analysis";
  Graph graph = has_pixels ? analysing_graph(asked, entry.analysis) : copying_graph(asked, entry.analysis);
  RunRequest request{.keep = {"index"}, .cancelled = &cancelled};
  const bool has_maps = find_node(graph, "exemplar") != nullptr;
  if (has_maps) {
    graph.nodes.push_back(picture_node());
    for (const char* kept : {"exemplar", "picture"}) request.keep.emplace_back(kept);
  }
  for (const GraphNode& n : graph.nodes)
    if (has_pixels && n.type->category == "analysis") entry.versions[n.type->name] = n.type->version;
  result = Session({.use_cache = false}).run(graph, request);
  if (!result.ok()) return std::nullopt;

  const auto index = std::get<IndexPtr>(result.kept.at("index").at("index"));
  const FingerprintPtr fingerprint = index->appearance()->fingerprint();
  entry.size = index->appearance()->size();
  entry.settings = asked.set;
  entry.added = today();
  ImagePtr picture = fingerprint ? picture_of(*fingerprint) : nullptr;
  if (has_maps) {
    const auto material = std::get<MaterialPtr>(result.kept.at("exemplar").at("material"));
    if (!has_pixels && fingerprint && !asked.other_material) require_analysed(*fingerprint, *material, asked.material);
    add_material(entry, *find_node(graph, "exemplar"), *material);
    picture = std::get<ImagePtr>(result.kept.at("picture").at("image"));
  }
  if (picture) {
    entry.picture = place / "new.png";
    write_image(*picture, entry.picture, {}, [](double) {});
  }
  return entry;
}

}  // namespace terrazzo
