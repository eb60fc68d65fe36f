#include "core/metrics/quality.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/material/map_names.h"
#include "core/metrics/autocorrelation.h"
#include "core/metrics/cooccurrence.h"
#include "core/metrics/copies.h"
#include "core/metrics/patch_statistics.h"
#include "core/metrics/structure.h"

namespace terrazzo {

namespace {

constexpr int patch_levels = 3;
constexpr double pyramid_sigma = 0.9;  ///< of gaussian_pyramid

int level_count(const Planes& exemplar, const Planes& output) {
  int side = std::min({exemplar.size.width, exemplar.size.height, output.size.width, output.size.height});
  int levels = 1;
  for (; side >= 64; side /= 2) levels++;
  return levels;
}

int measured_channels(const Image& image) {
  return image.channels() >= 3 ? 3 : 1;
}

void check_pair(const std::string& name, const Image& exemplar, const Image& output) {
  const ImageInfo &a = exemplar.info(), &b = output.info();
  if (a.color_space != b.color_space)
    throw Error(
        "maps",
        fmt::format("the map {} must have one colour space in exemplar and output, but is {} in the exemplar and "
                    "{} in the output; put a convert_color node before \"output\"",
                    name, a.color_space, b.color_space));
}

/// The map at the material's size; normals with green pointing up.
Planes map_planes(const Image& image, int channels, Size material) {
  const Rect region = whole(image.size());
  const Rect part = intersect(region, {0, 0, largest_measured, largest_measured});
  const bool smaller_map = image.size() != material;
  Planes planes = to_planes(image, smaller_map ? region : part, channels);
  if (smaller_map) planes = resampled(planes, material);
  if (image.info().semantic == Semantic::normal && image.info().normal_y == NormalY::down && planes.channels == 3)
    for (size_t i = 1; i < planes.values.size(); i += 3) planes.values[i] = 1 - planes.values[i];
  return planes;
}

/// One map's part of the stack.
struct MapChannels {
  std::string name;
  int channels;
};

Planes stacked(const Material& material, const std::vector<MapChannels>& maps) {
  std::vector<Planes> parts;
  int channels = 0;
  for (const MapChannels& map : maps) {
    CurrentTask::task().check();
    parts.push_back(map_planes(*material.find(std::string_view(map.name)), map.channels, material.size()));
    channels += parts.back().channels;
  }
  const Size size{std::min(material.size().width, largest_measured),
                  std::min(material.size().height, largest_measured)};
  Planes out = Planes::zeros(size, channels);
  int first = 0;
  for (const Planes& part : parts) {
    for (int y = 0; y < size.height; y++)
      for (int x = 0; x < size.width; x++) std::copy_n(part.at(x, y), part.channels, out.at(x, y) + first);
    first += part.channels;
  }
  return out;
}

void check_size(const char* port, Size size) {
  if (std::min(size.width, size.height) < smallest_measured)
    throw Error(port,
                fmt::format("a material of at least {0}x{0} pixels is needed to compare patches, but this one has "
                            "{1}x{2}",
                            smallest_measured, size.width, size.height));
}

/// The pyramids of exemplar and output.
struct Pyramids {
  std::vector<Planes> exemplar;
  std::vector<Planes> output;
};

double structure_of(const Pyramids& pyramids, const QualityParts& parts, const Task& task) {
  const Size size = pyramids.exemplar[0].size, output = pyramids.output[0].size;
  const double element = parts.element > 0 ? parts.element : 4 * correlation_length(pyramids.exemplar[0], task);
  const StructureWindow w =
      structure_window(element, {std::min(size.width, output.width), std::min(size.height, output.height)});
  return foreign_structure(pyramids.exemplar[w.level], pyramids.output[w.level], w.step, task);
}

/// On several levels. A reduced image shows a whole piece only if it lies at the right pixel, so these are smoothed for
/// a reduction, but keep all pixels.
void add_patch_similarity(Planes exemplar, Planes output, int levels, QualityFigures& q, const Task& task) {
  for (int i = 0; i < levels; i++) {
    const int step = 1 << i;
    if (i > 0)
      for (Planes* image : {&exemplar, &output})
        *image = blurred(*image, pyramid_sigma * step / 2, around_or_mirrored(*image), task);
    const PatchSimilarity s = patch_similarity(exemplar, output, step, task);
    q.coherence += s.coherence / levels;
    q.completeness += s.completeness / levels;
    q.broken += s.broken / levels;
    task.progress(0.7 + 0.3 * (i + 1) / levels);
  }
}

}  // namespace

std::vector<std::string> compared_maps(const Material& exemplar, const Material& output,
                                       const std::vector<std::string>& maps) {
  std::vector<std::string> names = maps;
  if (maps.empty())
    for (const Map& m : exemplar.maps())
      if (output.find(m.name)) names.push_back(m.name);
  if (names.empty())
    throw Error("output", fmt::format("exemplar and output must share a map to be compared; the exemplar has {}, the "
                                      "output {}",
                                      exemplar.map_names(), output.map_names()));
  require_maps("maps", names, names_of(exemplar.maps()), "the exemplar");
  require_maps("maps", names, names_of(output.maps()), "the output");
  return names;
}

ComparedPlanes compared_planes(const Material& exemplar, const Material& output, const std::vector<std::string>& maps) {
  check_size("exemplar", exemplar.size());
  check_size("output", output.size());
  std::vector<MapChannels> channels;
  for (const std::string& name : compared_maps(exemplar, output, maps)) {
    const Image &a = *exemplar.find(std::string_view(name)), &b = *output.find(std::string_view(name));
    check_pair(name, a, b);
    channels.push_back({name, std::max(measured_channels(a), measured_channels(b))});
  }
  ComparedPlanes out{stacked(exemplar, channels), stacked(output, channels)};
  std::vector<float> scale;
  // A map that is flat in the exemplar is measured in 8-bit steps.
  const Moments<> moments = channel_moments(out.exemplar);
  for (int c = 0; c < out.exemplar.channels; c++)
    scale.push_back(float(1 / std::max(std::sqrt(moments.variance(c)), 1.0 / 255)));
  for (Planes* planes : {&out.exemplar, &out.output})
    for (size_t i = 0; i < planes->values.size(); i++) planes->values[i] *= scale[i % scale.size()];
  return out;
}

QualityFigures measure_quality(Planes exemplar, Planes output, const QualityParts& parts, const Task& task) {
  QualityFigures q;
  q.acf = autocorrelation_difference(exemplar, output, task);
  task.progress(0.1);
  q.repeat = repetition(exemplar, output, task);
  task.progress(0.2);
  const int levels = level_count(exemplar, output);
  Pyramids pyramids{gaussian_pyramid(std::move(exemplar), levels, task),
                    gaussian_pyramid(std::move(output), levels, task)};
  const std::vector<Planes>&e = pyramids.exemplar, &o = pyramids.output;
  const int half = std::min(1, levels - 1), compared = std::min(patch_levels, levels);
  if (parts.verbatim) q.verbatim = verbatim_copies(e[half], o[half], task);
  task.progress(0.3);
  q.structure = structure_of(pyramids, parts, task);
  task.progress(0.4);
  for (int i = 0; i < levels; i++) q.swd += sliced_wasserstein(e[i], o[i], task) / levels;
  task.progress(0.6);
  for (int i = 0; i < compared; i++) q.cooccurrence += cooccurrence_distance(e[i], o[i], task) / compared;
  task.progress(0.7);
  add_patch_similarity(std::move(pyramids.exemplar[0]), std::move(pyramids.output[0]), compared, q, task);
  return q;
}

}  // namespace terrazzo
