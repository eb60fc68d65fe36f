#include "nodes/source/maps/material_folder.h"

#include <algorithm>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/paths.h"
#include "core/base/suggest.h"
#include "core/base/text.h"
#include "core/image_io/image_file.h"
#include "core/material/map_description.h"
#include "core/material/map_names.h"
#include "core/material/material_maps.h"
#include "core/naming/file_words.h"
#include "nodes/source/maps/given_maps.h"
#include "nodes/source/maps/interpretations.h"
#include "nodes/source/maps/material_sidecar.h"
#include "nodes/source/maps/site_documents.h"
#include "nodes/source/maps/unread_files.h"

namespace terrazzo {

namespace fs = std::filesystem;

namespace {

/// A file and one of its layers.
using FilePlace = std::pair<std::string, std::string>;

bool is_picture(const fs::path& path) {
  std::error_code missing;
  return looks_like_image(path) && fs::is_regular_file(path, missing);
}

void require_folder(const fs::path& folder) {
  std::error_code failure;
  const fs::file_status status = fs::status(folder, failure);
  if (fs::is_directory(status)) fs::directory_iterator(folder, failure);
  if (failure && status.type() != fs::file_type::not_found)
    throw Error("path", fmt::format("cannot read the folder {}: {}", folder.string(), failure.message()));
  if (fs::is_directory(status)) return;
  if (fs::exists(status))
    throw Error("path", fmt::format("expected a folder with the material's maps, or a picture, found the file {}",
                                    folder.string()));
  std::vector<std::string> siblings;
  for (const fs::directory_entry& e : fs::directory_iterator(folder.parent_path(), failure))
    if (e.is_directory(failure) || is_picture(e.path())) siblings.push_back(e.path().filename().string());
  std::sort(siblings.begin(), siblings.end());
  throw Error("path", fmt::format("there is no folder or picture {}{}", folder.string(),
                                  did_you_mean(folder.filename().string(), siblings)));
}

[[noreturn]] void fail_nothing_recognised(const fs::path& folder, const Recognition& recognition) {
  std::vector<std::string> present;
  std::error_code failure;
  for (const fs::directory_entry& e : fs::directory_iterator(folder, failure))
    present.push_back(e.path().filename().string() + (e.is_directory(failure) ? "/" : ""));
  std::sort(present.begin(), present.end());
  constexpr size_t shown = 20;
  const size_t more = present.size() > shown ? present.size() - shown : 0;
  present.resize(present.size() - more);
  std::string found = present.empty() ? "the folder is empty" : fmt::format("it holds {}", fmt::join(present, ", "));
  if (more) found += fmt::format(" and {} more", more);
  for (const std::string& note : recognition.notes) found += "; " + note;
  found += maps_of_other_endings(present);
  if (!present.empty() && std::ranges::all_of(present, [](const std::string& name) { return name.ends_with('/'); }))
    found += ", all of them folders: name one that holds the maps";
  throw Error("path",
              fmt::format("no maps recognised in {}: {}. File names say what a map is by a word at their end, such as "
                          "color, normal, height, roughness, metallic, ao or opacity (`terrazzo nodes load_material` "
                          "has them all); {}",
                          folder.string(), found, advice_on_map_names));
}

/// The folder's files, without ignored ones.
std::vector<MapFile> files_to_recognise(const Params& params, const std::set<FilePlace>& taken, Texts& notes) {
  const fs::path folder = folder_of(params);
  std::vector<std::string> names = image_names(folder);
  for (const std::string& pattern : std::get<Texts>(params.at("ignore"))) {
    const size_t before = names.size();
    std::erase_if(names, [&](const std::string& n) { return matches_pattern(n, pattern); });
    if (names.size() == before)
      notes.push_back(
          fmt::format("the pattern \"{}\" of the parameter `ignore` matches no image in the folder", pattern));
  }
  std::vector<MapFile> files;
  for (const std::string& name : names) {
    std::vector<FileInfo> layers = {{}};
    try {
      layers = read_layer_infos(folder / name);
    } catch (const Error&) {
      // If the file is chosen anyway, reading it reports the error.
    }
    if (layers.size() == 1 && taken.count({name, ""})) continue;
    for (const FileInfo& i : layers)
      if (!taken.count({name, i.layer}))
        files.push_back(
            {.name = name, .size = i.size, .channels = i.channels, .description = i.description, .layer = i.layer});
  }
  return files;
}

std::string listed(const std::vector<FolderMaterial>& materials) {
  constexpr size_t shown = 20;
  std::string all;
  for (size_t i = 0; i < std::min(shown, materials.size()); i++)
    all += fmt::format("{}{} ({})", i ? "; " : "", materials[i].name.empty() ? "without a name" : materials[i].name,
                       fmt::join(materials[i].maps, ", "));
  if (materials.size() > shown) all += fmt::format("; and {} more", materials.size() - shown);
  return all;
}

/// Mixing two materials would look like a valid result.
void require_one_material(const fs::path& folder, const std::string& wanted, const Recognition& found) {
  if (!found.maps.empty() || found.materials.empty()) return;
  if (wanted.empty())
    throw Error("path", fmt::format("{} holds {} materials: {}. {}", folder.string(), found.materials.size(),
                                    listed(found.materials), advice_on_several_materials));
  std::vector<std::string> names;
  for (const FolderMaterial& m : found.materials) names.push_back(m.name);
  throw Error("name", fmt::format("there is no material \"{}\" in {}{}; it holds {}", wanted, folder.string(),
                                  did_you_mean(wanted, names), listed(found.materials)));
}

/// A note on files left out because `wanted` selects another material.
void note_other_materials(const Recognition& found, Texts& notes) {
  if (found.name.empty() || found.materials.size() < 2) return;
  Texts others;
  for (const FolderMaterial& m : found.materials)
    if (m.name != found.name) others.push_back(m.name.empty() ? fmt::format("{}", fmt::join(m.maps, ", ")) : m.name);
  notes.push_back(fmt::format("left out, other materials: {}", fmt::join(others, ", ")));
}

/// The folder's sidecar, unless `name` selects another material.
std::optional<Sidecar> sidecar_that_counts(const Params& params) {
  const std::string& wanted = std::get<std::string>(params.at("name"));
  std::optional<Sidecar> sidecar = read_sidecar(folder_of(params), wanted);
  if (!sidecar || wanted.empty() || lowercase(wanted) == lowercase(sidecar->name)) return sidecar;
  const bool names_a_file = std::ranges::any_of(sidecar->files, [&](const std::string& f) {
    return lowercase(fs::path(f).stem().string()) == lowercase(wanted);
  });
  return names_a_file ? sidecar : std::nullopt;
}

/// The maps that a sidecar names, without those that the parameters give or leave out.
void add_described(const Sidecar& sidecar, const std::vector<MapFile>& files, const TextMap& given, FoundMaterial& out,
                   Texts& notes) {
  std::vector<RecognisedMap> maps = sidecar.maps;
  std::stable_sort(maps.begin(), maps.end(),
                   [](const RecognisedMap& a, const RecognisedMap& b) { return a.inverted < b.inverted; });
  notes.push_back(fmt::format("{} says what the files are", sidecar_name(sidecar.name)));
  for (const RecognisedMap& m : maps) {
    const auto is_file = [&](const MapFile& f) { return f.name == m.file; };
    if (given.count(m.map) || std::none_of(files.begin(), files.end(), is_file)) continue;
    const auto have = std::find_if(out.maps.begin(), out.maps.end(), [&](const auto& o) { return o.map == m.map; });
    if (have != out.maps.end()) {
      notes.push_back(fmt::format("{} is {}; {} left out", m.map, have->place(), m.place()));
      continue;
    }
    out.maps.push_back(m);
    if (m.inverted) notes.push_back(fmt::format("{} is {}, inverted", m.map, m.place()));
  }
  Texts others;
  for (const MapFile& f : files)
    if (std::find(sidecar.files.begin(), sidecar.files.end(), f.name) == sidecar.files.end()) others.push_back(f.name);
  if (!others.empty())
    notes.push_back(fmt::format("left out, {} does not name them: {}. `maps` takes them in", sidecar_name(sidecar.name),
                                fmt::join(others, ", ")));
  if (out.maps.empty())
    throw Error("path",
                fmt::format("`maps` and `ignore` leave out all maps that {} names", sidecar_name(sidecar.name)));
  out.metres = sidecar.metres;
  if (!sidecar.name.empty()) out.name = sidecar.name;
}

/// The physical size stated by the files.
PhysicalSize metres_in_descriptions(const std::vector<RecognisedMap>& maps, const std::vector<MapFile>& files) {
  for (const MapFile& f : files) {
    const bool is_used = std::ranges::find(maps, f.name, &RecognisedMap::file) != maps.end();
    const std::optional<FileDescription> said = is_used ? file_description(f.description) : std::nullopt;
    if (said && said->metres.is_known()) return said->metres;
  }
  return {};
}

/// A pattern of `data` that keeps nothing is probably misspelt.
void note_unused_patterns(const Params& params, const Recognition& found, Texts& notes) {
  for (const std::string& pattern : std::get<Texts>(params.at("data")))
    if (std::none_of(found.maps.begin(), found.maps.end(), [&](const RecognisedMap& m) {
          return m.map.starts_with("data_") && matches_pattern(m.file, pattern);
        }))
      notes.push_back(fmt::format(
          "the pattern \"{}\" of the parameter `data` keeps no file: none that matches it has a name that says no map",
          pattern));
}

/// The maps recognised by file name, without those that the parameters set or exclude.
void add_recognised(const Params& params, const std::vector<MapFile>& files, const TextMap& given, FoundMaterial& out,
                    Texts& notes) {
  const fs::path folder = folder_of(params);
  const std::string& wanted = std::get<std::string>(params.at("name"));
  const Recognition found = recognise_maps(files, {.name = wanted, .data = std::get<Texts>(params.at("data"))});
  require_one_material(folder, wanted, found);
  for (const RecognisedMap& m : found.maps)
    if (!given.count(m.map)) out.maps.push_back(m);
  if (out.maps.empty()) fail_nothing_recognised(folder, found);
  out.metres = metres_in_descriptions(found.maps, files);
  if (!out.metres.is_known()) out.metres = metres_in_documents(folder, notes);
  if (!found.name.empty()) out.name = found.name;
  notes.insert(notes.end(), found.notes.begin(), found.notes.end());
  note_other_materials(found, notes);
  note_unused_patterns(params, found, notes);
  out.ignored = found.ignored;
  for (const MapFile& f : files) {
    const bool is_ignored = std::ranges::find(found.ignored, f.name) != found.ignored.end();
    const bool is_other = found.materials.size() > 1 && std::ranges::none_of(found.materials, [&](const auto& m) {
                            return m.name == found.name && may_belong_to(f.name, m);
                          });
    if (is_ignored && !is_other && f.channels >= 3) out.unnamed.push_back(f.name);
  }
}

/// A folder may stand where a map was meant to be, as after unpacking an archive of that name.
Texts notes_on_folders(const fs::path& folder) {
  Texts notes;
  std::error_code failure;
  for (const fs::directory_entry& e : fs::directory_iterator(folder, failure))
    if (!is_no_folder(e) && looks_like_image(e.path()))
      notes.push_back(fmt::format("{}{} is a folder, not a map; if it holds one, move that out of it", warning_mark,
                                  e.path().filename().string()));
  std::sort(notes.begin(), notes.end());
  return notes;
}

/// Sidecars and metadata files of download sites.
std::vector<fs::path> documents_of_material(const fs::path& folder) {
  std::vector<fs::path> files = site_documents(folder);
  std::error_code failure;
  for (const fs::directory_entry& e : fs::directory_iterator(folder, failure))
    if (is_sidecar(e.path())) files.push_back(e.path());
  return files;
}

/// The picture that stands in the folder's place, if there is one.
std::optional<fs::path> picture_of(const Params& params) {
  const fs::path path = std::get<std::string>(params.at("path"));
  return is_picture(path) ? std::optional(path) : std::nullopt;
}

/// The parameters as they would be for the picture's folder: the base colour, unless `maps` names it otherwise.
Params naming_picture(Params params, const fs::path& picture) {
  auto& maps = std::get<TextMap>(params.at("maps"));
  const bool is_named =
      std::ranges::any_of(maps, [&](const auto& map) { return map.second == picture.filename().string(); });
  if (!is_named) maps.try_emplace(std::string(name_of(Semantic::base_color)), picture.filename().string());
  return params;
}

}  // namespace

std::string words_for_maps() {
  std::string words;
  for (const std::string_view name : semantic_names) {
    const Semantic s = *semantic_from(name);
    if (const std::string w = known_words(s); !w.empty())
      words += fmt::format("{}{}: {}", words.empty() ? "" : "; ", name, w);
  }
  return words;
}

std::string note_on_ignored(const Texts& ignored) {
  constexpr size_t most = 10;
  const Texts named(ignored.begin(), ignored.begin() + ptrdiff_t(std::min(most, ignored.size())));
  return fmt::format(
      "ignored, the name says no map: {}{}. `data` keeps them as they are, `maps` says what they are; the words that "
      "say it are in `terrazzo nodes load_material`",
      fmt::join(named, ", "), ignored.size() > most ? fmt::format(" and {} more", ignored.size() - most) : "");
}

fs::path folder_of(const Params& params) {
  const fs::path path = without_trailing_slash(std::get<std::string>(params.at("path")));
  return is_picture(path) ? path.parent_path() : path;
}

std::vector<std::string> image_names(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code failure;
  for (const fs::directory_entry& e : fs::directory_iterator(folder, failure)) {
    const std::string name = e.path().filename().string();
    if (name[0] != '.' && is_no_folder(e) && looks_like_image(e.path())) names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<std::string> problems_with_map_names(const Params& params) {
  std::vector<std::string> problems;
  const std::vector<std::string> known(semantic_names.begin(), semantic_names.end());
  for (const auto& [map, file] : std::get<TextMap>(params.at("maps")))
    if (!semantic_of_map(map))
      problems.push_back(
          fmt::format("\"maps\": there is no map \"{}\"{}; maps are {}, or one of these with a suffix as in mask_moss",
                      map, did_you_mean(map, known), fmt::join(known, ", ")));
  return problems;
}

FoundMaterial find_maps(const Params& given_params, Texts& notes) {
  const std::optional<fs::path> picture = picture_of(given_params);
  const Params params = picture ? naming_picture(given_params, *picture) : given_params;
  const fs::path folder = folder_of(params);
  require_folder(folder);
  require_given_maps(params, folder);
  const TextMap& given = std::get<TextMap>(params.at("maps"));
  FoundMaterial out{.name = (picture ? picture->stem() : folder.filename()).string()};
  std::set<FilePlace> taken;
  for (const auto& [map, text] : given) {
    if (text.empty()) continue;
    const RecognisedMap m = out.maps.emplace_back(given_map(params, map, text));
    if (m.channels.empty()) taken.emplace(m.file, m.layer);
  }
  std::vector<MapFile> files;
  Texts more_notes;
  if (!picture) {
    files = files_to_recognise(params, taken, notes);
    more_notes = notes_on_folders(folder);
    for (std::string& n : notes_on_other_formats(folder)) more_notes.push_back(std::move(n));
    if (const auto sidecar = sidecar_that_counts(params))
      add_described(*sidecar, files, given, out, more_notes);
    else
      add_recognised(params, files, given, out, more_notes);
  }
  std::stable_sort(out.maps.begin(), out.maps.end(),
                   [](const RecognisedMap& a, const RecognisedMap& b) { return a.semantic < b.semantic; });
  interpret(params, files, out.maps);
  for (const RecognisedMap& m : out.maps) notes.push_back(fmt::format("{}: {}", m.map, m.place()));
  notes.insert(notes.end(), more_notes.begin(), more_notes.end());
  return out;
}

Texts several_materials(const fs::path& folder) {
  const Params params = {
      {"path", folder.string()}, {"name", std::string()}, {"maps", TextMap()}, {"ignore", Texts()}, {"data", Texts()}};
  if (sidecar_that_counts(params)) return {};
  Texts notes, names;
  const Recognition found = recognise_maps(files_to_recognise(params, {}, notes));
  if (found.maps.empty())
    for (const FolderMaterial& m : found.materials) names.push_back(m.name);
  return names;
}

std::vector<fs::path> files_of_material(const Params& params) {
  const fs::path folder = folder_of(params);
  std::vector<fs::path> files;
  if (const std::optional<fs::path> picture = picture_of(params)) return {*picture};
  for (const std::string& name : image_names(folder)) files.push_back(folder / name);
  for (const auto& [map, text] : std::get<TextMap>(params.at("maps")))
    if (!text.empty() && semantic_of_map(map)) files.push_back(folder / given_map(params, map, text).file);
  for (fs::path& f : documents_of_material(folder)) files.push_back(std::move(f));
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  return files;
}

}  // namespace terrazzo
