#include "core/material/material_maps.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/tuning.h"
#include "core/image_io/color.h"
#include "core/image_io/file_pixels.h"

namespace terrazzo {

namespace {

struct MaterialMapsTuning {
  double compression_noise = 8.0 / 255;
};
const Tunable<MaterialMapsTuning> material_maps_tuning(
    "material_maps", {
                         {&MaterialMapsTuning::compression_noise, "compression_noise", "of the range of values",
                          "by which the channels of a grey map may differ. Higher: maps of several channels "
                          "are taken for grey ones; lower: lossy files are warned of",
                          "not measured: taken over from the code before constants were listed", 0, 1},
                     });

/// Whether channel c of an image never differs from `value(pixel)` by more than `tolerance`.
template <typename Value>
bool channel_is(const Image& image, int c, float tolerance, Value value) {
  bool same = true;
  for_each_strip(image, [&](const Rect& r, const float* p) {
    for (int64_t i = 0; same && i < r.area(); i++, p += image.channels()) same = std::abs(p[c] - value(p)) <= tolerance;
  });
  return same;
}

ImagePtr channels_of(const ImagePtr& image, ImageInfo info, const std::vector<int>& channels, bool inverted) {
  info.channels = int(channels.size());
  if (!inverted && info.channels == image->channels()) return Image::redescribed(image, info);
  return chosen_channels(image, info, channels, inverted);
}

int index_of_channel(char c) {
  return c == 'r' ? 0 : c == 'g' ? 1 : c == 'b' ? 2 : 3;
}

/// The file's channels for the map. Grey maps stored in colour are reduced to one channel; only colours keep alpha.
std::vector<int> channels_for(const RecognisedMap& m, const Image& file, std::vector<std::string>& notes) {
  require_channels(m, file.channels());
  std::vector<int> channels;
  for (const char c : m.channels) channels.push_back(index_of_channel(c));
  if (!channels.empty()) return channels;
  const int colors = file.channels() - (file.channels() % 2 == 0 ? 1 : 0);  // without alpha
  if (is_one_value(m.semantic)) {
    const auto compression_noise = float(material_maps_tuning->compression_noise);
    for (int c = 1; c < colors; c++)
      if (!channel_is(file, c, compression_noise, [](const float* p) { return p[0]; })) {
        notes.push_back(
            fmt::format("{}{}: its channels differ, but {} is one value at each pixel; red is used. If another channel "
                        "holds it, or "
                        "if the file holds several maps, `maps` says which: {{\"{}\": \"{}:{}g\"}}",
                        warning_mark, m.place(), m.map, m.map, m.file, m.layer.empty() ? "" : m.layer + "."));
        break;
      }
    return {0};
  }
  for (int c = 0; c < colors; c++) channels.push_back(c);
  return channels;
}

}  // namespace

int channels_of_map(const RecognisedMap& source, int file_channels) {
  if (source.semantic == Semantic::normal) return 3;  // z is rebuilt if the file has none
  if (!source.channels.empty()) return int(source.channels.size());
  if (is_one_value(source.semantic)) return 1;
  return file_channels % 2 == 0 ? file_channels - 1 : file_channels;
}

void require_channels(const RecognisedMap& source, int file_channels) {
  for (const char c : source.channels)
    if (index_of_channel(c) >= file_channels)
      throw Error("maps", fmt::format("{} should be channel {} of {}, which has only {}", source.map, c, source.file,
                                      counted(file_channels, "channel")));
}

ImagePtr map_of_file(const RecognisedMap& source, const ImagePtr& file, const std::string& color_space,
                     std::vector<std::string>& notes) {
  ImageInfo info = file->info();
  info.semantic = source.semantic;
  info.color_space = color_space;
  return channels_of(file, info, channels_for(source, *file, notes), source.inverted);
}

bool is_grey(const Image& image) {
  if (image.channels() < 3) return false;
  const auto noise = float(material_maps_tuning->compression_noise);
  const auto first = [](const float* p) { return p[0]; };
  return channel_is(image, 1, noise, first) && channel_is(image, 2, noise, first);
}

bool is_constant(const Image& image) {
  const std::vector<float> first = image.read({0, 0, 1, 1});
  for (int c = 0; c < image.channels(); c++)
    if (!channel_is(image, c, 0, [&](const float*) { return first[size_t(c)]; })) return false;
  return true;
}

bool is_only_alpha(const Image& image) {
  const int alpha = image.channels() - 1;
  if (alpha % 2 == 0) return false;
  const auto noise = float(material_maps_tuning->compression_noise);
  const std::vector<float> first = image.read({0, 0, 1, 1});
  const auto is_first = [&](int c) {
    return channel_is(image, c, noise, [&](const float*) { return first[size_t(c)]; });
  };
  for (int c = 0; c < alpha; c++)
    if (!is_first(c)) return false;
  return !is_first(alpha);
}

ImagePtr alpha_of(const ImagePtr& file, Semantic semantic, bool inverted) {
  if (file->channels() % 2 != 0) return nullptr;
  const int alpha = file->channels() - 1;
  if (channel_is(*file, alpha, 0, [](const float*) { return 1.0f; })) return nullptr;
  ImageInfo info = file->info();
  info.semantic = semantic;
  info.color_space = "raw";
  return channels_of(file, info, {alpha}, inverted);
}

}  // namespace terrazzo
