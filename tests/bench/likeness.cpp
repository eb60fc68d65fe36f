// How alike exemplars are, and how alike one stays to itself; tests/bench/likeness.sh builds and starts this.
// Arguments: folders of maps.

#include "core/analysis/space/likeness.h"

#include <algorithm>
#include <filesystem>
#include <vector>

#include <fmt/format.h>

#include "core/analysis/space/planes.h"
#include "core/analysis/space/weighting.h"
#include "core/filter/resample.h"
#include "core/image/image_ops.h"
#include "runner/engine/schedule.h"
#include "runner/plan/memory_graph.h"

using namespace terrazzo;

namespace {

std::vector<MaterialPtr> materials(int count, char** folders) {
  Graph graph;
  RunOptions options;
  for (int i = 0; i < count; i++) {
    graph.nodes.push_back(reading_node(fmt::format("n{}", i), folders[i]));
    options.targets.keep.push_back(graph.nodes.back().name);
  }
  const RunResult result = run_graph(graph, options);
  if (!result.ok()) throw Error(result.failures.front().message);
  std::vector<MaterialPtr> out;
  for (const GraphNode& n : graph.nodes) out.push_back(std::get<MaterialPtr>(result.kept.at(n.name).at("material")));
  return out;
}

Fingerprint fingerprint(const Material& material) {
  const FeaturesPtr features = weighted_features(material, {}, false);
  return fingerprint_of(*features, unmasked_planes(*features, Task()));
}

/// The base colour at half the size, darker, in another hue, and with noise.
MaterialPtr repainted(const Material& material) {
  const ImagePtr colour = material.find("base_color");
  const Size size{colour->width() / 2, colour->height() / 2};
  const ImagePtr small =
      resampled(colour, size, "auto", Outside::clamp, Hasher().add("small").add(colour->digest()).digest());
  std::vector<float> pixels = small->pixels();
  for (size_t i = 0; i < pixels.size(); i++) {
    const double noise = unit_double(random_bits(1, i)) + unit_double(random_bits(2, i)) - 1;
    const double tint = i % size_t(small->channels()) == 0 ? 0.6 : i % size_t(small->channels()) == 2 ? 0.4 : 1;
    pixels[i] = std::clamp(float(double(pixels[i]) * double(pixels[i]) * tint + 0.1 * noise), 0.0f, 1.0f);
  }
  return Material::make("repainted", {{"base_color", Image::from_floats(small->info(), std::move(pixels))}});
}

}  // namespace

int main(int count, char** arguments) {
  try {
    const std::vector<MaterialPtr> all = materials(count - 1, arguments + 1);
    double most = 0, sum = 0;
    int pairs = 0;
    fmt::print("| exemplar | itself, repainted | another, at most |\n|---|---|---|\n");
    for (size_t i = 0; i < all.size(); i++) {
      const Fingerprint f = fingerprint(*all[i]);
      double nearest = 0;
      for (size_t j = 0; j < all.size(); j++) {
        if (i == j) continue;
        const double like = likeness(f, *all[j], Task()).value_or(Likeness()).correlation;
        nearest = std::max(nearest, like);
        sum += like;
        pairs++;
      }
      most = std::max(most, nearest);
      const double same = likeness(f, *repainted(*all[i]), Task()).value_or(Likeness()).correlation;
      fmt::print("| {} | {:.2f} | {:.2f} |\n", std::filesystem::path(arguments[i + 1]).filename().string(), same,
                 nearest);
    }
    fmt::print("\nOthers: {:.2f} on average, at most {:.2f}.\n", sum / pairs, most);
  } catch (const Error& e) {
    fmt::print(stderr, "error: {}\n", e.what());
    return 1;
  }
  return 0;
}
