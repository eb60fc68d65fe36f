#include "core/material/material_files.h"

#include <algorithm>
#include <map>
#include <tuple>

#include <fmt/format.h>

#include "core/base/text.h"
#include "core/material/map_candidates.h"
#include "core/material/material_choice.h"

namespace terrazzo {

namespace {

std::string size_text(const std::vector<MapFile>& files, const RecognisedMap& m) {
  const auto& [name, layer] = std::tie(m.file, m.layer);
  for (const MapFile& f : files)
    if (f.name == name && f.layer == layer && f.size.area() > 0)
      return fmt::format(" ({}x{})", f.size.width, f.size.height);
  return "";
}

void note_choice(const Candidate& chosen, const RecognisedMap& passed_over, const std::vector<MapFile>& files,
                 Recognition& out) {
  const RecognisedMap& taken = chosen.map;
  if (taken.semantic == Semantic::normal && taken.normal_y == NormalY::up && passed_over.normal_y == NormalY::down)
    out.notes.push_back(
        fmt::format("normal is {} (OpenGL); {} (DirectX) left out", taken.place(), passed_over.place()));
  else
    out.notes.push_back(fmt::format("{} is {}{}; {}{} left out", taken.map, taken.place(), size_text(files, taken),
                                    passed_over.place(), size_text(files, passed_over)));
}

/// Keeps files of the chosen materials whose names are of no known map, as data maps named after the rest of the name.
void keep_as_data(const std::vector<std::string>& patterns, const std::vector<FolderMaterial>& meant,
                  const std::vector<MapFile>& files, std::vector<Candidate>& candidates, Recognition& out) {
  const auto is_wanted = [&](const std::string& file) {
    return std::any_of(patterns.begin(), patterns.end(),
                       [&](const std::string& p) { return matches_pattern(file, p); }) &&
           (meant.empty() || meant.size() == out.materials.size() ||
            std::any_of(meant.begin(), meant.end(), [&](const FolderMaterial& m) { return may_belong_to(file, m); }));
  };
  for (const MapFile& f : files) {
    if (std::find(out.ignored.begin(), out.ignored.end(), shown(f)) == out.ignored.end() || !is_wanted(f.name))
      continue;
    std::erase(out.ignored, shown(f));
    RecognisedMap m{.map = "data_" + rest_of_name(f.telling_name(), out.materials),
                    .semantic = Semantic::data,
                    .file = f.name,
                    .channels = "",
                    .layer = f.layer};
    candidates.push_back(make_candidate(std::move(m), {}, f));
  }
}

void note_taken(const Candidate& c, std::vector<std::string>& notes) {
  if (c.named_like_material)
    notes.push_back(
        fmt::format("base_color is {}: it is named like the material; `ignore` leaves it out", c.map.place()));
  if (c.map.inverted) notes.push_back(fmt::format("roughness is {}, inverted", c.map.place()));
  if (c.file.level_of_detail > 0)
    notes.push_back(fmt::format("{} is {}, level of detail {}: the folder holds no finer one", c.map.map, c.map.place(),
                                c.file.level_of_detail));
}

}  // namespace

Recognition recognise_maps(std::vector<MapFile> files, const RecognitionOptions& wishes) {
  std::sort(files.begin(), files.end(), [](const MapFile& a, const MapFile& b) { return a.name < b.name; });
  Candidates candidates = candidates_among(files);
  std::vector<Candidate>& found = candidates.maps;
  settle_stems(found);
  add_colors_named_like_materials(candidates);
  leave_out_strangers(candidates);
  MaterialChoice choice = keep_one_material(candidates, wishes.name);
  Recognition out{.maps = {},
                  .notes = std::move(candidates.notes),
                  .ignored = std::move(candidates.ignored),
                  .name = choice.name,
                  .materials = std::move(choice.all)};
  if (!choice.is_clear) return out;
  keep_as_data(wishes.data, choice.meant, files, found, out);
  std::map<std::string, int> stem_count;
  for (const Candidate& c : found) stem_count[c.stem().key()]++;
  const auto rank = [&](const Candidate& c) {
    return std::tuple(c.map.semantic, c.map.map, -stem_count[c.stem().key()], c.stand_in, c.file.further_words,
                      c.file.level_of_detail, c.map.normal_y == NormalY::up ? 0 : 1, -c.size.area(), c.lossiness,
                      c.map.file, c.map.layer);
  };
  std::sort(found.begin(), found.end(), [&](const Candidate& a, const Candidate& b) { return rank(a) < rank(b); });

  const Candidate* chosen = nullptr;
  for (const Candidate& c : found) {
    if (chosen && chosen->map.map == c.map.map) {
      note_choice(*chosen, c.map, files, out);
      continue;
    }
    chosen = &c;
    out.maps.push_back(c.map);
    note_taken(c, out.notes);
  }
  return out;
}

}  // namespace terrazzo
