#include "core/material/map_candidates.h"

#include <algorithm>
#include <array>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/text.h"
#include "core/naming/file_words.h"

namespace terrazzo {

namespace {

int lossiness_of(const std::string& file) {
  const std::string e = extension_of(file);
  if (e == "exr") return 0;
  if (e == "tif" || e == "tiff") return 1;
  if (e == "png") return 2;
  constexpr std::array lossy = {"jpg", "jpeg", "jpe", "jfif", "webp", "gif", "dds", "jp2", "j2k", "j2c"};
  return std::ranges::find(lossy, e) != lossy.end() ? 4 : 3;
}

bool has_word(const std::string& name, std::string_view word) {
  return std::ranges::any_of(words_in(name), [&](const NameWord& w) { return without_digits(w.text) == word; });
}

/// A file's layers, each with the reading of its name.
using Layers = std::vector<UnnamedPicture>;

bool is_picture(const UnnamedPicture& layer) {
  return layer.file.channels == 0 || layer.file.channels >= 3;
}

/// The layer that a file's name is about, among several; null if there is none or more than one.
const UnnamedPicture* layer_of_file_name(const Layers& layers, Candidates& out) {
  const UnnamedPicture* found = nullptr;
  for (const UnnamedPicture& l : layers) {
    if (l.reading.told_by_layer) continue;
    if (l.file.layer.empty()) return &l;
    if (!is_picture(l)) continue;
    if (found) {
      out.notes.push_back(fmt::format(
          "{}{}: neither of its layers {} and {} says what it is; both are left out. Choose one with `maps`, as in "
          "{{\"base_color\": \"{}:{}\"}}",
          warning_mark, l.file.name, found->file.layer, l.file.layer, l.file.name, found->file.layer));
      return nullptr;
    }
    found = &l;
  }
  return found;
}

/// Renderers write the distance from the camera beside the picture.
bool is_render_depth(const UnnamedPicture& layer, const UnnamedPicture* picture) {
  return layer.reading.told_by_layer && picture && is_picture(*picture) && has_word(layer.file.layer, "depth");
}

void add_layer(UnnamedPicture layer, const UnnamedPicture* picture, bool is_alone, Candidates& out) {
  const MapFile& f = layer.file;
  if (const std::string reason = reason_to_skip(f.telling_name()); !reason.empty()) {
    out.notes.push_back(fmt::format("{} left out: {}", shown(f), reason));
    return;
  }
  if (is_render_depth(layer, picture)) {
    out.notes.push_back(
        fmt::format("{} left out: beside a picture, depth is the distance from the camera. If it is a height, `maps` "
                    "{{\"height\": \"{}:{}\"}} takes it in",
                    shown(f), f.name, f.layer));
    return;
  }
  const bool counts = is_alone || layer.reading.told_by_layer || (picture && picture->file.layer == f.layer);
  if (!counts || layer.reading.maps.empty()) {
    out.ignored.push_back(shown(f));
    if (counts) out.unnamed.push_back(std::move(layer));
    return;
  }
  for (const RecognisedMap& m : layer.reading.maps) out.maps.push_back(make_candidate(m, layer.reading, f));
}

}  // namespace

Candidate make_candidate(RecognisedMap map, const RecognisedFile& reading, const MapFile& file) {
  const bool stands_in = map.inverted || (map.semantic == Semantic::height && has_word(file.telling_name(), "bump"));
  const int stand_in = stands_in ? 2 : map.channels.empty() ? 0 : 1;
  return {std::move(map), reading, stand_in, file.size, file.channels, lossiness_of(file.name)};
}

Candidates candidates_among(const std::vector<MapFile>& files) {
  std::map<std::string, Layers> by_name;
  for (const MapFile& f : files) by_name[f.name].push_back({f, recognise_file(f)});
  Candidates out;
  for (auto& [name, layers] : by_name) {
    const bool is_alone = layers.size() == 1;
    const UnnamedPicture* found = is_alone ? nullptr : layer_of_file_name(layers, out);
    const std::optional<UnnamedPicture> picture = found ? std::optional(*found) : std::nullopt;
    for (UnnamedPicture& l : layers) add_layer(std::move(l), picture ? &*picture : nullptr, is_alone, out);
  }
  return out;
}

std::string shown(const MapFile& file) {
  return file.layer.empty() ? file.name : fmt::format("{} (layer {})", file.name, file.layer);
}

}  // namespace terrazzo
