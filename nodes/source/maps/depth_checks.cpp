#include "nodes/source/maps/depth_checks.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/tuning.h"
#include "core/filter/normal_convention.h"
#include "core/image_io/file_pixels.h"
#include "core/naming/file_words.h"
#include "core/naming/packing_guess.h"

namespace terrazzo {

namespace {

struct DepthChecksTuning {
  double clear = 0.1;
  double strong = 0.5;
  double hollow = 0.25;
};
const Tunable<DepthChecksTuning> depth_checks_tuning(
    "depth_checks",
    {
        {&DepthChecksTuning::clear, "clear", "correlation",
         "of red with the slopes of a depth map. Higher: more maps stay undecided; lower: noise decides",
         "not measured: as normal_convention.clear", 0, 1},
        {&DepthChecksTuning::strong, "strong", "correlation", "the same of green alone. Higher, lower: likewise",
         "not measured: as normal_convention.strong", 0, 1},
        {&DepthChecksTuning::hollow, "hollow", "correlation",
         "of occlusion with the height above its surroundings. Higher, lower: likewise",
         "not measured: as packing_guess.least_hollow", 0, 1},
    });

/// Whether near is dark, with the evidence.
struct Judgement {
  bool inverted = false;
  std::string grounds;
};

std::optional<Judgement> judged_by_normals(const Image& normal, std::optional<NormalY> normal_y, const Image& height) {
  const ConventionEvidence e = convention_from_height(normal, height);
  const bool red_tells = std::abs(e.along_x) >= depth_checks_tuning->clear;
  const double up = normal_y == NormalY::down ? -e.along_y : e.along_y;
  const bool green_tells =
      normal_y && std::abs(up) >= (red_tells ? depth_checks_tuning->clear : depth_checks_tuning->strong);
  if (!red_tells && !green_tells) return std::nullopt;
  if (red_tells && green_tells && (e.along_x < 0) != (up < 0)) return std::nullopt;  // one of the two is flipped
  return Judgement{(red_tells ? e.along_x : up) < 0,
                   fmt::format("the normals (correlation with its slopes x {:.2f}, y {:.2f})", e.along_x, e.along_y)};
}

std::optional<Judgement> judged(std::optional<NormalY> given, const std::vector<RecognisedMap>& sources,
                                const std::vector<Map>& maps, const ImagePtr& height) {
  for (const Map& m : maps) {
    if (m.image->info().semantic != Semantic::normal) continue;
    const auto source = std::ranges::find(sources, m.name, &RecognisedMap::map);
    const std::optional<NormalY> named = source == sources.end() ? std::nullopt : source->normal_y;
    if (auto found = judged_by_normals(*m.image, given ? given : named, *height)) return found;
  }
  for (const Map& m : maps) {
    if (m.image->info().semantic != Semantic::ambient_occlusion) continue;
    const double fit = hollow_correlation(m.image, height);
    if (std::abs(fit) >= depth_checks_tuning->hollow)
      return Judgement{fit < 0, fmt::format("the occlusion (correlation with its hollows {:.2f})", fit)};
  }
  return std::nullopt;
}

}  // namespace

bool is_depth(const std::string& file, const std::string& layer) {
  MapFile named{.name = file, .size = {}};
  named.layer = layer;
  return std::ranges::any_of(words_of_file(named.telling_name()),
                             [](const NameWord& w) { return without_digits(w.text) == "depth"; });
}

std::string note_on_depth(const std::string& place, const std::string& map) {
  return fmt::format(
      "{}{} is a depth map by its name, and read as a height map: near is bright. If near is dark in it, {} "
      "inverts it",
      map.empty() ? "" : map + ": ", place, advice_to_interpret(map, "inverted"));
}

void settle_depths(std::optional<NormalY> normal_y, const std::vector<RecognisedMap>& sources, std::vector<Map>& maps,
                   std::vector<std::string>& notes) {
  for (const RecognisedMap& source : sources) {
    if (source.semantic != Semantic::height || source.inverted || source.interpretation.inverted ||
        !is_depth(source.file, source.layer))
      continue;
    const auto map = std::ranges::find(maps, source.map, &Map::name);
    if (map == maps.end()) continue;
    const std::optional<Judgement> found = judged(normal_y, sources, maps, map->image);
    if (!found) {
      notes.push_back(note_on_depth(source.place(), source.map));
    } else if (found->inverted) {
      map->image = chosen_channels(map->image, map->image->info(), {0}, true);
      notes.push_back(
          fmt::format("{}: {} is a depth map by its name, and near is dark in it by {}; it is inverted. {} "
                      "leaves it as it is",
                      source.map, source.place(), found->grounds, advice_to_interpret(source.map, "not_inverted")));
    }
  }
}

}  // namespace terrazzo
