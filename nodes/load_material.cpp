#include <algorithm>
#include <filesystem>
#include <map>
#include <mutex>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/parallel_for.h>

#include "core/color.h"
#include "core/image_file.h"
#include "core/material_files.h"
#include "core/material_maps.h"
#include "core/node.h"
#include "core/normal_convention.h"
#include "core/paths.h"
#include "core/suggest.h"
#include "nodes/color_space.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

/// A link to a missing file counts, so that reading it complains: without it the material would silently lack a map.
bool is_file_or_broken_link(const fs::directory_entry& entry) {
  std::error_code failure;
  return entry.is_regular_file(failure) || (entry.is_symlink(failure) && !entry.exists(failure));
}

std::vector<std::string> image_names(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code failure;
  for (const fs::directory_entry& e : fs::directory_iterator(folder, failure)) {
    const std::string name = e.path().filename().string();
    if (name[0] != '.' && is_file_or_broken_link(e) && looks_like_image(e.path())) names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

fs::path folder_of(const Params& params) {
  return without_trailing_slash(std::get<std::string>(params.at("path")));
}

/// The map that a name of the `maps` parameter stands for: a semantic's name, or one with a suffix.
std::optional<Semantic> semantic_of_map(const std::string& map) {
  for (const std::string_view name : semantic_names)
    if (map == name || map.starts_with(std::string(name) + "_")) return semantic_from(name);
  return std::nullopt;
}

/// "file.png", or "file.png:g" for one channel.
RecognisedMap given_map(const std::string& map, const std::string& text) {
  RecognisedMap m{.map = map, .semantic = *semantic_of_map(map), .file = text, .channels = ""};
  const size_t colon = text.rfind(':');
  if (colon != std::string::npos && text.find_first_not_of("rgba", colon + 1) == std::string::npos) {
    m.file = text.substr(0, colon);
    m.channels = text.substr(colon + 1);
  }
  return m;
}

/// Throws if the file that the `maps` parameter gives for a map is not there or has not the channels asked for.
void require_given_map(const fs::path& folder, const std::string& map, const std::string& text) {
  const RecognisedMap given = given_map(map, text);
  const size_t colon = text.rfind(':');
  std::error_code missing;
  if (given.file == text && colon != std::string::npos && !fs::exists(folder / text, missing) &&
      fs::is_regular_file(folder / text.substr(0, colon), missing))
    throw Error(fmt::format("{} is to be channel {} of {}, but channels are called r, g, b and a", map,
                            text.substr(colon + 1), text.substr(0, colon)));
  require_image_file(folder / given.file);
  if (!given.channels.empty()) require_channels(given, read_image_info(folder / given.file).channels);
}

/// Says at once all that is wrong with the files that the parameter `maps` gives.
void require_given_maps(const Params& params) {
  std::string troubles;
  for (const auto& [map, text] : std::get<TextMap>(params.at("maps"))) try {
      if (!text.empty()) require_given_map(folder_of(params), map, text);
    } catch (const Error& e) {
      troubles += fmt::format("{}{}", troubles.empty() ? "" : "; ", e.what());
    }
  if (!troubles.empty()) throw Error("maps", troubles);
}

std::vector<std::string> check(const Params& params) {
  std::vector<std::string> problems = color_space_problems(params, "color_space", "auto");
  const std::vector<std::string> known(semantic_names.begin(), semantic_names.end());
  for (const auto& [map, file] : std::get<TextMap>(params.at("maps")))
    if (!semantic_of_map(map))
      problems.push_back(
          fmt::format("\"maps\": there is no map \"{}\"{}; maps are {}, or one of these with a suffix as in mask_moss",
                      map, did_you_mean(map, known), fmt::join(known, ", ")));
  return problems;
}

void require_folder(const fs::path& folder) {
  std::error_code failure;
  const fs::file_status status = fs::status(folder, failure);
  if (fs::is_directory(status)) fs::directory_iterator(folder, failure);
  if (failure && status.type() != fs::file_type::not_found)
    throw Error("path", fmt::format("cannot read the folder {}: {}", folder.string(), failure.message()));
  if (fs::is_directory(status)) return;
  if (fs::exists(status))
    throw Error("path", fmt::format("expected a folder with the material's maps, found the file {}; "
                                    "load_map reads a single file",
                                    folder.string()));
  std::vector<std::string> siblings;
  for (const fs::directory_entry& e : fs::directory_iterator(folder.parent_path(), failure))
    if (e.is_directory(failure)) siblings.push_back(e.path().filename().string());
  std::sort(siblings.begin(), siblings.end());
  throw Error("path", fmt::format("there is no folder {}{}", folder.string(),
                                  did_you_mean(folder.filename().string(), siblings)));
}

std::string all_words() {
  std::string words;
  for (const std::string_view name : semantic_names) {
    const Semantic s = *semantic_from(name);
    if (const std::string w = known_words(s); !w.empty())
      words += fmt::format("{}{}: {}", words.empty() ? "" : "; ", name, w);
  }
  return words;
}

[[noreturn]] void fail_nothing_recognised(const fs::path& folder, const Recognition& recognition) {
  std::vector<std::string> present;
  std::error_code failure;
  for (const fs::directory_entry& e : fs::directory_iterator(folder, failure))
    present.push_back(e.path().filename().string());
  std::sort(present.begin(), present.end());
  constexpr size_t shown = 20;
  const size_t more = present.size() > shown ? present.size() - shown : 0;
  present.resize(present.size() - more);
  std::string found = present.empty() ? "the folder is empty" : fmt::format("it holds {}", fmt::join(present, ", "));
  if (more) found += fmt::format(" and {} more", more);
  for (const std::string& note : recognition.notes) found += "; " + note;
  throw Error("path",
              fmt::format("no maps recognised in {}: {}. File names say what a map is by a word at their end ({}); the "
                          "parameter `maps` names files outright",
                          folder.string(), found, all_words()));
}

/// Names the folder's files, the ignored ones taken out.
std::vector<MapFile> files_to_recognise(const Params& params, const std::set<std::string>& taken, Texts& notes) {
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
    if (taken.count(name)) continue;
    MapFile f{.name = name, .size = {}};
    try {
      const FileInfo info = read_image_info(folder / name);
      f.size = info.size;
      f.channels = info.channels;
    } catch (const Error&) {
      // If the file is chosen all the same, reading it says what is wrong.
    }
    files.push_back(std::move(f));
  }
  return files;
}

/// Which file of the folder is which map; throws if that can be said of none. Adds what the user should know.
std::vector<RecognisedMap> find_maps(const Params& params, Texts& notes) {
  const fs::path folder = folder_of(params);
  require_folder(folder);
  require_given_maps(params);
  const TextMap& given = std::get<TextMap>(params.at("maps"));
  std::vector<RecognisedMap> maps;
  std::set<std::string> taken;
  for (const auto& [map, text] : given) {
    if (text.empty()) continue;
    maps.push_back(given_map(map, text));
    if (maps.back().channels.empty()) taken.insert(maps.back().file);
  }
  const Recognition recognition = recognise_maps(files_to_recognise(params, taken, notes));
  for (const RecognisedMap& m : recognition.maps)
    if (!given.count(m.map)) maps.push_back(m);
  if (maps.empty()) fail_nothing_recognised(folder, recognition);
  std::stable_sort(maps.begin(), maps.end(),
                   [](const RecognisedMap& a, const RecognisedMap& b) { return a.semantic < b.semantic; });
  for (const RecognisedMap& m : maps) {
    std::string from = m.file;
    if (!m.channels.empty()) from += fmt::format(" (channel {})", m.channels);
    notes.push_back(fmt::format("{}: {}", m.map, from));
  }
  notes.insert(notes.end(), recognition.notes.begin(), recognition.notes.end());
  if (!recognition.ignored.empty())
    notes.push_back(fmt::format("ignored, the name says nothing: {}. Known words are {}",
                                fmt::join(recognition.ignored, ", "), all_words()));
  return maps;
}

/// A file that has been read, with what the reader said of it.
struct Source {
  ImagePtr image;
  std::vector<std::string> warnings;
};

/// Reads each file once, several at a time.
std::map<std::string, Source> read_sources(NodeContext& node, const fs::path& folder,
                                           const std::vector<RecognisedMap>& maps) {
  std::map<std::string, Source> sources;
  std::map<std::string, Semantic> semantics;
  for (const RecognisedMap& m : maps) {
    sources[m.file];
    semantics.emplace(m.file, m.semantic);
  }
  std::vector<std::pair<const std::string, Source>*> entries;
  for (auto& entry : sources) entries.push_back(&entry);
  tbb::parallel_for(size_t{0}, entries.size(), [&](size_t i) {
    node.task().check();
    auto& [file, source] = *entries[i];
    ImageInfo info;
    info.semantic = semantics.at(file);
    source.image = read_image(folder / file, info, [&](const std::string& w) { source.warnings.push_back(w); });
  });
  for (const auto& [file, source] : sources)
    for (const std::string& warning : source.warnings) node.note(warning);
  return sources;
}

/// The opacity map that hides in a base colour's alpha channel.
void add_alpha(const RecognisedMap& m, const ImagePtr& file, std::vector<Map>& maps, std::vector<std::string>& notes) {
  if (m.semantic != Semantic::base_color || !m.channels.empty()) return;
  const ImagePtr opacity = opacity_of(file);
  if (!opacity) return;
  const bool have = std::any_of(maps.begin(), maps.end(), [](const Map& k) { return k.name == "opacity"; });
  if (have) {
    notes.push_back(fmt::format("the alpha channel of {} is left out: there is an opacity map", m.file));
    return;
  }
  maps.push_back({"opacity", opacity});
  notes.push_back(fmt::format("opacity: {} (alpha channel)", m.file));
}

std::string_view name_of_convention(NormalY y) {
  return y == NormalY::up ? "up (OpenGL)" : "down (DirectX)";
}

/// What the pixels say about the convention, and how that was found out.
struct Judgement {
  std::optional<NormalY> normal_y;
  std::string grounds;
};

Judgement judged(const Image& normal, const ImagePtr& height) {
  if (height) {
    const ConventionEvidence e = convention_from_height(normal, *height);
    if (e.normal_y)
      return {e.normal_y,
              fmt::format("judged by the height map (correlation with its slopes x {:.2f}, y {:.2f}){}", e.along_x,
                          e.along_y,
                          e.height_inverted ? "; the height map seems to be dark where the surface is high" : "")};
  }
  const ConventionEvidence e = convention_from_curl(normal);
  return {e.normal_y, fmt::format("judged by the normals themselves (correlation {:.2f})", e.along_y)};
}

/// Finds out by looking; says what it found.
NormalY detect_convention(const Image& normal, const ImagePtr& height, std::vector<std::string>& notes) {
  const Judgement found = judged(normal, height);
  if (found.normal_y) {
    notes.push_back(fmt::format("normal: green points {}, {}", name_of_convention(*found.normal_y), found.grounds));
    return *found.normal_y;
  }
  notes.push_back(
      "normal: neither its name nor its pixels say whether green points up (OpenGL) or down (DirectX); up is assumed. "
      "Set `normal_y` if that is wrong");
  return NormalY::up;
}

/// A name is believed, but not silently if the pixels speak against it.
void check_named_convention(const RecognisedMap& source, const Image& normal, const ImagePtr& height,
                            std::vector<std::string>& notes) {
  const Judgement found = judged(normal, height);
  if (found.normal_y && *found.normal_y != *source.normal_y)
    notes.push_back(
        fmt::format("normal: the name {} says that green points {}, but it looks as if it pointed {}, {}. "
                    "The name is believed; set `normal_y` to \"{}\" if it is wrong",
                    source.file, name_of_convention(*source.normal_y), name_of_convention(*found.normal_y),
                    found.grounds, *found.normal_y == NormalY::up ? "up" : "down"));
}

void settle_conventions(NodeContext& node, const std::vector<RecognisedMap>& sources, std::vector<Map>& maps) {
  ImagePtr height;
  for (const Map& m : maps)
    if (m.image->info().semantic == Semantic::height) height = m.image;
  const std::string& wish = node.text("normal_y");
  std::vector<std::string> notes;
  for (Map& m : maps) {
    if (m.image->info().semantic != Semantic::normal) continue;
    ImageInfo info = m.image->info();
    const auto source =
        std::find_if(sources.begin(), sources.end(), [&](const RecognisedMap& s) { return s.map == m.name; });
    if (wish != "auto")
      info.normal_y = wish == "up" ? NormalY::up : NormalY::down;
    else if (source->normal_y) {
      info.normal_y = *source->normal_y;
      check_named_convention(*source, *m.image, height, notes);
    } else
      info.normal_y = detect_convention(*m.image, height, notes);
    m.image = Image::redescribed(m.image, info);
  }
  for (std::string& n : notes) node.note(std::move(n));
}

void compute(NodeContext& node) {
  const fs::path folder = folder_of(node.params());
  const std::string given_space = node.text("color_space") == "auto" ? "" : color_space_of(node, "color_space");
  std::vector<std::string> notes;
  const std::vector<RecognisedMap> found = find_maps(node.params(), notes);
  for (std::string& n : notes) node.note(std::move(n));
  notes.clear();
  const std::map<std::string, Source> sources = read_sources(node, folder, found);
  std::vector<Map> maps;
  for (const RecognisedMap& m : found) {
    const ImagePtr& file = sources.at(m.file).image;
    const bool space_given = m.semantic == Semantic::base_color && !given_space.empty();
    maps.push_back(
        {m.map,
         map_of_file(m, file, space_given ? given_space : assumed_color_space(m.semantic, file->info().depth), notes)});
  }
  for (const RecognisedMap& m : found) add_alpha(m, sources.at(m.file).image, maps, notes);
  for (std::string& n : notes) node.note(std::move(n));
  settle_conventions(node, found, maps);
  node.output("material", Material::make(folder.filename().string(), std::move(maps)));
}

std::vector<fs::path> files_read(const Params& params) {
  const fs::path folder = folder_of(params);
  std::vector<fs::path> files;
  for (const std::string& name : image_names(folder)) files.push_back(folder / name);
  for (const auto& [map, text] : std::get<TextMap>(params.at("maps")))
    if (!text.empty() && semantic_of_map(map)) files.push_back(folder / given_map(map, text).file);
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  for (fs::path& f : color_config_files()) files.push_back(std::move(f));
  return files;
}

Forecast foresee(const Params& params, const InputForecasts&) {
  Texts ignored_notes;
  Forecast out{.possible_maps = Texts{}};
  std::set<std::string> troubles;
  for (const RecognisedMap& m : find_maps(params, ignored_notes)) {
    out.maps.push_back(m.map);
    try {
      require_readable_image(folder_of(params) / m.file);
      const FileInfo file = read_image_info(folder_of(params) / m.file);
      out.sizes[m.map] = file.size;
      if (m.semantic == Semantic::base_color && file.channels % 2 == 0) out.possible_maps->push_back("opacity");
    } catch (const Error& e) {
      troubles.insert(e.what());
    }
  }
  if (!troubles.empty()) throw Error(fmt::format("{}", fmt::join(troubles, "; ")));
  return out;
}

}  // namespace

NodeType load_material_node() {
  NodeType t;
  t.name = "load_material";
  t.version = 2;
  t.category = "source";
  t.summary = "Reads a folder of maps as one material";
  t.help =
      "Finds the maps in a folder by the naming conventions of ambientCG, Poly Haven, Substance, Quixel Megascans, "
      "Unreal, Unity and glTF, and by plain names; the last telling word of a name counts. Packed files (ORM, ARM, "
      "metallicRoughness, MaskMap, MetallicSmoothness, AlbedoTransparency) are split into their channels, gloss and "
      "smoothness maps inverted into roughness, grey maps stored in colour reduced to one channel, and a base colour's "
      "alpha becomes the opacity map. Of several files for one map the OpenGL normal, the larger and the lossless one "
      "is "
      "taken. The notes say what was recognised and what was left out.";
  t.outputs = {
      {.name = "material", .type = ValueType::material, .help = "the maps found, named after their semantics"}};
  t.params = {
      {.name = "path", .type = ParamType::path, .help = "The folder of the maps."},
      {.name = "normal_y",
       .type = ParamType::choice,
       .fallback = "auto",
       .help =
           "Green channel of the normal map: up as in OpenGL, down as in DirectX. \"auto\" takes it from the file's "
           "name, else from the slopes of the height map, else from the normals themselves.",
       .choices = {"auto", "up", "down"}},
      {.name = "maps",
       .type = ParamType::text_map,
       .fallback = TextMap{},
       .help =
           "Files by map name, where the names do not say it: {\"height\": \"scan.tif\", \"roughness\": "
           "\"packed.png:g\"}; relative to the folder, with the channels after a colon. An empty text leaves the map "
           "out."},
      {.name = "ignore",
       .type = ParamType::texts,
       .fallback = Texts{},
       .help = "File names to leave out; * and ? stand for any characters."},
      {.name = "color_space",
       .type = ParamType::text,
       .fallback = "auto",
       .help =
           "The colour space of the base colour. \"auto\": srgb_texture in 8 and 16 bit, lin_rec709 in float files."},
  };
  t.persist = Persist::digest;
  t.compute = compute;
  t.files_read = files_read;
  t.memory_hint = [](const NodeContext& node) {
    size_t bytes = 0;
    for (const std::string& name : image_names(folder_of(node.params()))) try {
        const FileInfo info = read_image_info(folder_of(node.params()) / name);
        bytes += size_t(info.size.area()) * info.channels * sizeof(float);
      } catch (const Error&) {
        continue;  // compute reports it
      }
    return bytes;
  };
  t.foresee = foresee;
  t.check = check;
  return t;
}

}  // namespace terrazzo
