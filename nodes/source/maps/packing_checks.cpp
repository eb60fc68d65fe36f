#include "nodes/source/maps/packing_checks.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/text.h"
#include "core/filter/normal_convention.h"
#include "core/material/material_maps.h"
#include "core/material/shared_detail.h"

namespace terrazzo {

namespace {

using Notes = std::vector<std::string>;

/// The syntax of load_material's `maps`: "wall.png:g", "wall.exr:arm.g".
std::string channel_of(const RecognisedMap& m, char channel) {
  return fmt::format("{}:{}{}{}", m.file, m.layer, m.layer.empty() ? "" : ".", channel);
}

void leave_out(const std::string& name, std::vector<Map>& maps) {
  std::erase_if(maps, [&](const Map& m) { return m.name == name; });
}

bool has(const std::vector<Map>& maps, std::string_view name) {
  return std::ranges::find(maps, name, &Map::name) != maps.end();
}

/// The single map that the name means for a one-channel image; nullopt if the name clearly means a packed file.
std::optional<std::string> map_of_grey_picture(const RecognisedMap& m) {
  const std::vector<RecognisedMap> as_grey = recognise_map({.name = m.file, .size = {}, .channels = 1});
  const bool is_one = m.layer.empty() && m.said_by.empty() && as_grey.size() == 1 && as_grey.front().channels.empty();
  return is_one ? std::optional(as_grey.front().map) : std::nullopt;
}

/// The maps of one file, each in one channel of red, green and blue.
using Packing = std::vector<const RecognisedMap*>;

void settle_grey_packing(const Packing& packing, std::vector<Map>& maps, Notes& notes) {
  const RecognisedMap& first = *packing.front();
  if (const std::optional<std::string> only = map_of_grey_picture(first); only && has(maps, *only)) {
    for (const RecognisedMap* m : packing)
      if (m->map != *only) leave_out(m->map, maps);
    notes.push_back(
        fmt::format("{} is a grey picture and not a packed one: it is read as {} alone", first.file, *only));
    return;
  }
  Notes names;
  for (const RecognisedMap* m : packing) names.push_back(m->map);
  notes.push_back(fmt::format(
      "{}{}: {} are read from its channels, but these are the same: it is a grey picture, not a packed one. If it "
      "is one map, say which, and leave the others out: `maps` {{\"{}\": \"{}:r\", \"{}\": \"\"}}",
      warning_mark, first.file, fmt::join(names, ", "), names[0], first.file,
      fmt::join(names.begin() + 1, names.end(), "\": \"\", \"")));
}

bool channel_is_constant(const ImagePtr& file, const RecognisedMap& place, char channel) {
  RecognisedMap one = place;
  one.channels = std::string(1, channel);
  one.inverted = false;
  Notes unused;
  return is_constant(*map_of_file(one, file, "raw", unused));
}

/// Roughness and metallic in green and blue, as in glTF: red may hold occlusion.
void tell_of_red(const Packing& packing, const ImagePtr& file, const std::vector<Map>& maps, Notes& notes) {
  const RecognisedMap& first = *packing.front();
  const bool names_two = recognise_map({.name = first.file, .size = {}, .channels = 3}).size() == 2;
  if (packing.size() != 2 || !names_two || !first.said_by.empty()) return;
  if (has(maps, "ambient_occlusion") || channel_is_constant(file, first, 'r')) return;
  const bool blue_is_empty = channel_is_constant(file, first, 'b');
  notes.push_back(fmt::format(
      "{}{}: {} and {} are read from green and blue, as in glTF; red is left out. If it is occlusion, `maps` "
      "{{\"ambient_occlusion\": \"{}\"}} takes it in{}",
      blue_is_empty ? warning_mark : "", first.file, packing[0]->map, packing[1]->map, channel_of(first, 'r'),
      blue_is_empty ? fmt::format(". Blue is the same everywhere: if the maps begin with red, `maps` says it: "
                                  "{{\"roughness\": \"{}\", \"metallic\": \"{}\"}}",
                                  channel_of(first, 'r'), channel_of(first, 'g'))
                    : ""));
}

bool is_full(const Image& image) {
  return is_constant(image) && image.read({0, 0, 1, 1})[0] == 1;
}

/// Whether a map is the alpha of a pair such as albedo_height.
bool is_alpha_of_pair(const RecognisedMap& m) {
  return m.channels == "a" && !m.inverted && m.semantic != Semantic::opacity && m.said_by.empty();
}

}  // namespace

bool may_be_left_out(const RecognisedMap& m) {
  if (m.names_no_material || is_alpha_of_pair(m)) return true;
  if (m.channels.size() != 1) return false;
  const std::optional<std::string> only = map_of_grey_picture(m);
  return only && *only != m.map;
}

void settle_packings(const std::vector<RecognisedMap>& sources, const ImageOf& image_of, std::vector<Map>& maps,
                     Notes& notes) {
  std::map<std::pair<std::string, std::string>, Packing> packings;
  for (const RecognisedMap& m : sources) {
    if (m.channels.size() == 1 && m.channels != "a") packings[{m.file, m.layer}].push_back(&m);
    const auto map = std::ranges::find(maps, m.map, &Map::name);
    if (!is_alpha_of_pair(m) || map == maps.end() || !is_full(*map->image)) continue;
    notes.push_back(fmt::format("{}{}: its alpha channel is full everywhere, so that it holds no {}; left out",
                                warning_mark, m.file, m.map));
    leave_out(m.map, maps);
  }
  for (const auto& [place, packing] : packings) {
    const ImagePtr file = image_of(*packing.front());
    if (packing.size() > 1 && is_grey(*file))
      settle_grey_packing(packing, maps, notes);
    else
      tell_of_red(packing, file, maps, notes);
  }
}

namespace {

/// Whether a channel is neither constant nor a copy of one of `used`.
bool holds_more(const Image& file, int channel, const std::set<int>& used) {
  constexpr float noise =
      8.0f / 255;  // higher: faint maps are lost silently; lower: JPEG artefacts in constants cause warnings
  const int channels = file.channels();
  float least = 1e30f, most = -1e30f;
  std::vector<bool> is_copy(size_t(channels), true);
  for_each_strip(file, [&](const Rect& r, const float* p) {
    for (int64_t i = 0; i < r.area(); i++, p += channels) {
      least = std::min(least, p[channel]);
      most = std::max(most, p[channel]);
      for (const int c : used)
        if (std::abs(p[c] - p[channel]) > noise) is_copy[size_t(c)] = false;
    }
  });
  return most - least > noise && std::ranges::none_of(used, [&](int c) { return is_copy[size_t(c)]; });
}

/// The channels of a file that maps use, and those that its name assigns to maps.
std::set<int> used_channels(const RecognisedMap& place, int channels, const std::vector<RecognisedMap>& found) {
  std::vector<RecognisedMap> maps =
      recognise_map({.name = place.file, .size = {}, .channels = channels, .layer = place.layer});
  for (const RecognisedMap& m : found)
    if (m.file == place.file && m.layer == place.layer) maps.push_back(m);
  std::set<int> used;
  for (const RecognisedMap& m : maps)
    for (const char c : m.channels) used.insert(int(std::string_view("rgba").find(c)));
  if (used == std::set<int>{1, 2}) used.insert(0);  // see tell_of_red
  return used;
}

}  // namespace

void tell_of_unused_channels(const std::vector<RecognisedMap>& sources, const std::vector<RecognisedMap>& found,
                             const ImageOf& image_of, Notes& notes) {
  std::map<std::pair<std::string, std::string>, Packing> packings;
  for (const RecognisedMap& m : sources)
    if (!m.channels.empty() && m.said_by.empty()) packings[{m.file, m.layer}].push_back(&m);
  for (const auto& [place, packing] : packings) {
    const RecognisedMap& first = *packing.front();
    const ImagePtr file = image_of(first);
    const std::set<int> used = used_channels(first, file->channels(), found);
    Notes unused;
    for (int c = 0; c < file->channels(); c++)
      if (!used.count(c) && holds_more(*file, c, used)) unused.emplace_back(1, "rgba"[c]);
    if (unused.empty()) continue;
    notes.push_back(
        fmt::format("{}{}: its {} left out, and not the same everywhere. If {} a map, `maps` says which, as in "
                    "{{\"ambient_occlusion\": \"{}\"}}",
                    warning_mark, first.file,
                    unused.size() == 1 ? fmt::format("channel {} is", unused[0])
                                       : fmt::format("channels {} are", fmt::join(unused, " and ")),
                    unused.size() == 1 ? "it is" : "one is", channel_of(first, unused[0][0])));
  }
}

void settle_only_alpha(RecognisedMap& map, const Image& file, Notes& notes) {
  const bool is_cover = map.semantic == Semantic::opacity || map.semantic == Semantic::mask;
  if (!map.channels.empty() || !is_cover || !is_only_alpha(file)) return;
  map.channels = "a";
  notes.push_back(
      fmt::format("{}: {} is the same everywhere but for its alpha channel, which is read; `maps` {{\"{}\": \"{}\"}} "
                  "says otherwise",
                  map.map, map.file, map.map, channel_of(map, 'r')));
}

void leave_out_unrelated(const std::vector<RecognisedMap>& sources, std::vector<Map>& maps, Notes& notes) {
  constexpr double least_shared = 0.06;  // higher: a map is lost; lower: another material's map is mixed in
  const auto find = [&](const RecognisedMap& m) { return std::ranges::find(maps, m.map, &Map::name); };
  for (const RecognisedMap& m : sources) {
    const auto map = find(m);
    if (!m.names_no_material || map == maps.end()) continue;
    double shared = 0;
    for (const RecognisedMap& other : sources)
      if (const auto o = find(other); !other.names_no_material && o != maps.end())
        shared = std::max(shared, shared_detail(map->image, o->image));
    if (shared >= least_shared) continue;
    notes.push_back(fmt::format(
        "{}{} is left out: its name says no material, and its picture has nothing in common with the other maps "
        "(correlation {:.2f}). `maps` {{\"{}\": \"{}\"}} takes it in",
        warning_mark, m.place(), shared, m.map, m.file));
    leave_out(m.map, maps);
  }
}

std::optional<Semantic> hidden_in_alpha(const RecognisedMap& m) {
  if (!m.channels.empty()) return std::nullopt;
  if (m.semantic == Semantic::base_color) return Semantic::opacity;
  if (m.semantic == Semantic::normal) return Semantic::height;
  const bool may_have_gloss = m.semantic == Semantic::specular || m.semantic == Semantic::metallic;
  return may_have_gloss ? std::optional(Semantic::roughness) : std::nullopt;
}

namespace {

std::string_view described(Semantic hidden) {
  if (hidden == Semantic::roughness) return ", inverted: gloss, as in the specular workflow and in Unity";
  return hidden == Semantic::height ? ": the normals follow its slopes; `maps` says otherwise" : "";
}

std::string with_article(const std::string& map) {
  return (map == "opacity" ? "an " : "a ") + map;
}

/// On exemplars heights correlate with the slopes by 0.77 and more, roughness negatively, occlusion of scans by less
/// than 0.42. Occlusion of generated exemplars correlates more and is mistaken for height.
bool is_height_of(const RecognisedMap& normal, const ImagePtr& alpha, const std::vector<Map>& maps) {
  constexpr double least = 0.6;  // higher: heights are left out; lower: more occlusion is mistaken for height
  const auto map = std::ranges::find(maps, normal.map, &Map::name);
  if (map == maps.end() || map->image->channels() < 3) return false;
  const ConventionEvidence e = convention_from_height(*map->image, *alpha);
  return e.normal_y && e.along_x > least && std::abs(e.along_y) > least;
}

}  // namespace

void add_alpha(const RecognisedMap& m, const ImagePtr& file, std::vector<Map>& maps, Notes& notes) {
  const bool may_hide = m.channels.empty() && m.semantic != Semantic::data;
  const std::optional<Semantic> hidden = hidden_in_alpha(m);
  const ImagePtr alpha =
      may_hide ? alpha_of(file, hidden.value_or(m.semantic), hidden == Semantic::roughness) : nullptr;
  if (!alpha) return;
  if (!hidden || (hidden == Semantic::height && !is_height_of(m, alpha, maps))) {
    const bool is_all = is_one_value(m.semantic) && is_only_alpha(*file);
    notes.push_back(fmt::format(
        "{}the alpha channel of {} is left out{}. If it is a map, `maps` says which, as in "
        "{{\"{}\": \"{}\"}}",
        hidden || is_all ? warning_mark : "", m.place(), is_all ? ", though all else in it is the same everywhere" : "",
        is_all ? m.map : "roughness", channel_of(m, 'a')));
    return;
  }
  const std::string name(name_of(*hidden));
  if (has(maps, name)) {
    notes.push_back(fmt::format("the alpha channel of {} is left out: there is {} map", m.place(), with_article(name)));
    return;
  }
  maps.push_back({name, alpha});
  notes.push_back(fmt::format("{}: {} (alpha channel){}", name, m.place(), described(*hidden)));
}

}  // namespace terrazzo
