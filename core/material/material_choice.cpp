#include "core/material/material_choice.h"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/text.h"

namespace terrazzo {

namespace {

bool is_color_map(const Candidate& c) {
  return c.map.semantic == Semantic::base_color;
}

bool has_color(const std::vector<const Candidate*>& maps) {
  return std::ranges::any_of(maps, [](const Candidate* c) { return is_color_map(*c); });
}

/// Stems of which two files, different in filler words only, hold the same map.
std::set<std::string> clashing_stems(const std::vector<Candidate>& maps) {
  std::map<std::pair<std::string, std::string>, std::set<std::string>> spellings;  // by stem and map
  for (const Candidate& c : maps) spellings[{c.stem().key(), c.map.map}].insert(c.file.stem_with_fillers.key());
  std::set<std::string> clashing;
  for (const auto& [stem_and_map, keys] : spellings)
    if (keys.size() > 1) clashing.insert(stem_and_map.first);
  return clashing;
}

/// basecolor-boosted beside basecolor is no material "boosted", unless there is another file of it.
void settle_words_behind(std::vector<Candidate>& maps) {
  std::map<std::string, std::set<std::string>> files;  // by stem
  std::set<std::string> plain;
  for (const Candidate& c : maps) {
    files[c.stem().key()].insert(c.map.file);
    if (c.stem().words.empty()) plain.insert(c.map.map);
  }
  for (Candidate& c : maps) {
    if (!c.file.stem_is_behind || files.at(c.stem().key()).size() > 1 || !plain.count(c.map.map)) continue;
    c.file.further_words = int(c.stem().words.size());
    c.file.stem = c.file.stem_with_fillers = Stem();
  }
}

std::string quoted_map(const Candidate& c) {
  return fmt::format("{{\"{}\": \"{}\"}}", c.map.map, c.map.file);
}

std::set<std::string> maps_of_stem(const std::vector<Candidate>& maps, const std::string& key) {
  std::set<std::string> out;
  for (const Candidate& c : maps)
    if (c.stem().key() == key) out.insert(c.map.map);
  return out;
}

/// For a material asked for by one of its stems: leaves out stems of another name, and stems that hold the same maps.
void keep_named_stem(Candidates& candidates, const std::string& key, MaterialChoice& out) {
  FolderMaterial& material = out.meant.front();
  const auto asked = std::ranges::find_if(candidates.maps, [&](const Candidate& c) { return c.stem().key() == key; });
  const Stem stem = asked->stem();
  const std::set<std::string> own = maps_of_stem(candidates.maps, key);
  std::set<std::string> others;
  for (const Candidate& c : candidates.maps) {
    const std::string other = c.stem().key();
    const std::set<std::string> maps = maps_of_stem(candidates.maps, other);
    const bool clashes = std::ranges::any_of(maps, [&](const std::string& m) { return own.count(m) > 0; });
    if (other != key && (clashes || !is_extension(c.stem(), stem))) others.insert(other);
  }
  if (others.empty()) return;
  std::set<std::string> files;
  for (const Candidate& c : candidates.maps)
    if (others.count(c.stem().key())) files.insert(c.map.file);
  candidates.notes.push_back(fmt::format("left out, not of \"{}\": {}", stem.shown, fmt::join(files, ", ")));
  std::erase_if(candidates.maps, [&](const Candidate& c) { return others.count(c.stem().key()) > 0; });
  std::erase_if(material.stems, [&](const std::string& s) { return others.count(s) > 0; });
  out.name = stem.shown;
}

}  // namespace

void settle_stems(std::vector<Candidate>& maps) {
  settle_words_behind(maps);
  const std::set<std::string> clashing = clashing_stems(maps);
  for (Candidate& c : maps)
    if (clashing.count(c.stem().key())) c.file.stem = c.file.stem_with_fillers;
}

namespace {

/// Whether a picture may be the base colour of maps: it has their shape, and is not smaller, as a preview would be.
bool may_be_color_of(const std::vector<const Candidate*>& maps, Size size, int channels) {
  const auto fits = [&](Size map) {
    return map.area() == 0 ||
           (int64_t{map.width} * size.height == int64_t{map.height} * size.width && map.area() <= size.area());
  };
  return (channels == 0 || channels >= 3) &&
         (size.area() == 0 || std::ranges::any_of(maps, [&](const Candidate* c) { return fits(c->size); }));
}

/// Whether only a letter or two of a name say which map it is, as in tiles_m_6.
bool only_letters_say_it(const std::string& file) {
  return std::ranges::all_of(words_of_file(file), [](const NameWord& w) {
    return w.text.size() <= 2 || recognise_map({.name = w.text + ".png", .size = {}}).empty();
  });
}

/// tiles_m_6 beside tiles_m_6_normal is no metallic map of "tiles".
void free_pictures_named_like_materials(Candidates& candidates) {
  std::map<std::string, std::vector<const Candidate*>> materials;
  for (const Candidate& c : candidates.maps) materials[c.stem().key()].push_back(&c);
  std::set<std::string> freed;
  for (const Candidate& c : candidates.maps) {
    const Stem whole = stem_in(c.map.file.substr(0, c.map.file.rfind('.')));
    const auto material = materials.find(whole.key());
    if (material == materials.end() || whole.key() == c.stem().key() || has_color(material->second) ||
        !c.map.layer.empty() || !c.map.said_by.empty() || !only_letters_say_it(c.map.file) ||
        !may_be_color_of(material->second, c.size, c.channels))
      continue;
    RecognisedFile reading = c.file;
    reading.stem = reading.stem_with_fillers = whole;
    if (freed.insert(c.map.file).second)
      candidates.unnamed.push_back({{.name = c.map.file, .size = c.size, .channels = c.channels}, reading});
  }
  std::erase_if(candidates.maps, [&](const Candidate& c) { return freed.count(c.map.file) > 0; });
}

}  // namespace

void add_colors_named_like_materials(Candidates& candidates) {
  free_pictures_named_like_materials(candidates);
  std::map<std::string, std::vector<const Candidate*>> materials;
  for (const Candidate& c : candidates.maps) materials[c.stem().key()].push_back(&c);
  std::vector<Candidate> colors;
  for (const UnnamedPicture& u : candidates.unnamed) {
    auto material = materials.find(u.reading.stem_with_fillers.key());
    if (material == materials.end()) material = materials.find(u.reading.stem.key());
    if (material == materials.end() || material->first.empty() || has_color(material->second)) continue;
    if (!may_be_color_of(material->second, u.file.size, u.file.channels)) continue;
    RecognisedMap color{.map = std::string(name_of(Semantic::base_color)),
                        .semantic = Semantic::base_color,
                        .file = u.file.name,
                        .channels = "",
                        .layer = u.file.layer};
    Candidate c = make_candidate(std::move(color), u.reading, u.file);
    c.file.stem = material->second.front()->stem();
    c.named_like_material = true;
    std::erase(candidates.ignored, shown(u.file));
    colors.push_back(std::move(c));
  }
  std::ranges::move(colors, std::back_inserter(candidates.maps));
}

void leave_out_strangers(Candidates& candidates) {
  std::vector<const Candidate*> nameless, named;
  for (const Candidate& c : candidates.maps) (c.stem().words.empty() ? nameless : named).push_back(&c);
  const auto rank = [](const auto& maps) { return std::pair(has_color(maps), maps.size()); };
  if (nameless.empty() || rank(nameless) >= rank(named)) return;
  const auto is_strange = [&](const Candidate& c) {
    return c.stem().words.empty() && c.size.area() > 0 &&
           std::ranges::none_of(named, [&](const Candidate* n) { return n->size.area() == 0 || n->size == c.size; });
  };
  std::set<std::string> told;
  for (const Candidate& c : candidates.maps)
    if (is_strange(c) && told.insert(c.map.file).second)
      candidates.notes.push_back(fmt::format(
          "{}{} ({}) is left out: its name says no material, and no map of a named one has its size. `maps` {} takes "
          "it in",
          warning_mark, c.map.place(), describe(c.size), quoted_map(c)));
  std::vector<Candidate> kept;
  for (const Candidate& c : candidates.maps) {
    if (is_strange(c)) continue;
    kept.push_back(c);
    kept.back().map.names_no_material = c.stem().words.empty();
  }
  candidates.maps = std::move(kept);
}

MaterialChoice keep_one_material(Candidates& candidates, const std::string& name) {
  std::vector<StemmedMap> stemmed;
  for (const Candidate& c : candidates.maps) stemmed.push_back({c.stem(), c.map.map, is_color_map(c)});
  MaterialChoice out;
  out.all = out.meant = materials_among(stemmed);
  out.is_clear = out.all.size() <= 1;
  if (name.empty()) return out;
  const RecognisedFile as_file = recognise_file({.name = name + ".", .size = {}});
  MeantMaterials found = materials_named(
      out.all, name, as_file.maps.empty() ? std::vector<Stem>() : std::vector{as_file.stem_with_fillers, as_file.stem});
  out.meant = std::move(found.materials);
  out.is_clear = !out.meant.empty();
  std::set<std::string> stems;
  for (const FolderMaterial& m : out.meant) stems.insert(m.stems.begin(), m.stems.end());
  std::erase_if(candidates.maps, [&](const Candidate& c) { return !stems.count(c.stem().key()); });
  if (out.meant.size() != 1) return out;
  out.name = out.meant.front().name;
  if (!found.stem.empty()) keep_named_stem(candidates, found.stem, out);
  return out;
}

}  // namespace terrazzo
