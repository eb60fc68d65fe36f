#include "nodes/common/derived_edges.h"

#include <cmath>
#include <map>
#include <mutex>
#include <optional>

#include "core/analysis/repeats/wrap_detection.h"
#include "core/filter/resample.h"
#include "nodes/common/node_helpers.h"

namespace terrazzo {

namespace {

/// Larger maps are compared at a smaller size: bounds the time, and the memory for maps that are computed when pulled.
constexpr double largest_compared = 1024.0 * 1024.0;

MaterialPtr to_compare(const Material& material) {
  std::vector<Map> maps = material.maps();
  for (Map& m : maps) {
    const Size size = m.image->size();
    const int factor = int(std::ceil(std::sqrt(double(size.area()) / largest_compared)));
    if (factor <= 1) continue;
    const Digest recipe = Hasher().add("borders of").add(m.image->digest()).digest();
    const Size smaller{std::max(1, size.width / factor), std::max(1, size.height / factor)};
    m.image = resampled(m.image, smaller, "box", Outside::clamp, recipe);
  }
  return Material::make(material.name(), std::move(maps));
}

/// Edges by map, for the whole process: several nodes need those of the same map. Entries are never dropped, since a
/// comparison may not reproduce derived edges. Thread-safe.
class KnownEdges {
 public:
  std::optional<bool> meet(const Digest& material) {
    const std::lock_guard lock(mutex_);
    const auto at = known_.find(material);
    return at == known_.end() ? std::nullopt : std::optional(at->second);
  }
  void add(const Digest& material, bool meet) {
    const std::lock_guard lock(mutex_);
    known_[material] = meet;
  }

 private:
  std::mutex mutex_;
  std::map<Digest, bool> known_;
};

KnownEdges& known_edges() {
  static KnownEdges all;
  return all;
}

bool found_to_meet(const Material& material, const Task& task) {
  if (const std::optional<bool> known = known_edges().meet(material.digest())) return *known;
  const bool meet = borders_meet(*to_compare(material), task);
  known_edges().add(material.digest(), meet);
  return meet;
}

}  // namespace

Param derived_edges_param() {
  Param p = edges_param();
  p.choices.insert(p.choices.begin(), "auto");
  p.fallback = "auto";
  p.help =
      "What lies beyond the border: clamp extends the border pixels, wrap repeats the image (for maps that tile). auto "
      "wraps if opposite borders fit together, and says so.";
  return p;
}

Outside derived_edges_of(NodeContext& node, const Material& material) {
  if (node.text("edges") != "auto") return edges_of(node);
  if (!found_to_meet(material, node.task())) return Outside::clamp;
  node.note("the input tiles, and so does the result; \"edges\" set to clamp leaves opposite borders apart");
  return Outside::wrap;
}

Outside derived_edges_of(NodeContext& node, const ImagePtr& image) {
  return derived_edges_of(node, *Material::of(image));
}

void know_edges(const ImagePtr& derived, Outside edges) {
  known_edges().add(Material::of(derived)->digest(), edges == Outside::wrap);
}

}  // namespace terrazzo
