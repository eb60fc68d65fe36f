#include "runner/report/torn_pictures.h"

#include <algorithm>

#include "core/base/hash.h"
#include "core/exemplar/appearance.h"
#include "core/image/image_ops.h"
#include "core/metrics/whole_elements.h"
#include "core/synthesis/steps/element_layout.h"

namespace terrazzo {

namespace {

/// How bright whole elements and joints stay: enough to see where one is.
constexpr float dimmed = 0.25f;

/// The kept value of a node's first output of that type; null if there is none.
template <typename T>
std::shared_ptr<const T> kept_value(const RunResult& result, const std::string& node) {
  const auto kept = result.kept.find(node);
  if (kept == result.kept.end()) return nullptr;
  for (const auto& [port, value] : kept->second)
    if (const auto* found = std::get_if<std::shared_ptr<const T>>(&value)) return *found;
  return nullptr;
}

ImagePtr colours_of(const std::vector<ShownMaterial>& results, Size size) {
  for (const ShownMaterial& m : results)
    if (ImagePtr image = m.material->find(Semantic::base_color); image && image->info().size == size) return image;
  return nullptr;
}

ImagePtr lit_up(const ImagePtr& colours, const ImagePtr& mask) {
  if (!colours) return mask;
  const int channels = colours->info().channels;
  return pixel_by_pixel(colours->info(), Hasher().add("torn picture").digest(), {colours, mask},
                        [channels](auto in, float* out, int64_t count) {
                          for (int64_t i = 0; i < count; i++)
                            for (int c = 0; c < channels; c++)
                              out[i * channels + c] =
                                  in[0][i * channels + c] * (in[1][i] > 0.5f || c == 3 ? 1 : dimmed);
                        });
}

}  // namespace

std::vector<TornPicture> torn_pictures(const Graph& graph, const RunResult& result,
                                       const std::vector<ShownMaterial>& results, const Task& task) {
  std::vector<TornPicture> out;
  for (const GraphNode& n : graph.nodes) {
    const auto at = n.inputs.find("index");
    const UvMapPtr uv = kept_value<UvMap>(result, n.name);
    if (!uv || at == n.inputs.end()) continue;
    const IndexPtr index = kept_value<Index>(result, at->second.front().node);
    if (!index || !index->appearance()->elements() || uv->exemplar() != index->appearance()->size()) continue;
    const Elements& elements = *index->appearance()->elements();
    if (!shown_elements(*uv, elements, task).are_broken(are_heaped(*index->appearance()))) continue;
    const std::vector<uint8_t> torn = torn_elements(*uv, elements, task);
    const ImagePtr mask = Image::from_floats({.size = uv->size(), .semantic = Semantic::mask, .depth = Depth::u8},
                                             {torn.begin(), torn.end()});
    out.push_back({n.name, lit_up(colours_of(results, uv->size()), mask)});
  }
  return out;
}

}  // namespace terrazzo
