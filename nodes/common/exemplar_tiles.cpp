#include "nodes/common/exemplar_tiles.h"

#include <map>
#include <mutex>

#include "core/analysis/repeats/wrap_detection.h"

namespace terrazzo {

Param tiles_param() {
  return {.name = "tiles",
          .type = ParamType::choice,
          .fallback = "auto",
          .help =
              "Whether the exemplar tiles: opposite borders then count as neighbours. \"auto\" compares opposite "
              "borders, where the mask leaves them.",
          .choices = {"auto", "yes", "no"}};
}

Port mask_port() {
  return {.name = "mask",
          .type = ValueType::image,
          .help =
              "where the exemplar may be sampled: white (above 0.5) may, black is ignored and never shown. The "
              "exemplar's aspect ratio at any size; only the first channel counts",
          .optional = true};
}

namespace {

/// Cached: several nodes ask about the same exemplar, often concurrently.
bool found_to_tile(const Material& material, const ImagePtr& mask, const Task& task) {
  constexpr size_t most_known = 64;
  static std::mutex mutex;
  static std::map<Digest, bool> known;
  const Digest asked = mask ? Hasher().add(material.digest()).add(mask->digest()).digest() : material.digest();
  const std::lock_guard lock(mutex);
  const auto at = known.find(asked);
  if (at != known.end()) return at->second;
  const bool tiles = seems_to_tile(material, task, mask);
  if (known.size() == most_known) known.clear();
  return known[asked] = tiles;
}

}  // namespace

bool exemplar_tiles(NodeContext& node, const Material& material) {
  const std::string& tiles = node.text("tiles");
  if (tiles != "auto") return tiles == "yes";
  const ImagePtr mask = node.type().find_input("mask") ? node.optional_input<Image>("mask") : nullptr;
  const bool fits = found_to_tile(material, mask, node.task());
  if (fits) node.note("the exemplar tiles: its opposite borders are treated as neighbours");
  return fits;
}

}  // namespace terrazzo
