#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/parallel_for.h>

#include "core/image/color.h"
#include "core/image/image_file.h"
#include "core/material/material_maps.h"
#include "core/node/node.h"
#include "nodes/common/color_space.h"
#include "nodes/common/exemplar_doubts.h"
#include "nodes/common/node_helpers.h"
#include "nodes/common/shape_rules.h"
#include "nodes/source/material_folder.h"
#include "nodes/source/normal_checks.h"
#include "nodes/source/unnamed_packings.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

/// A file that has been read, with the warnings of the reader.
struct Source {
  ImagePtr image;
  std::vector<std::string> warnings;
};

/// A file and, of an EXR file, a layer.
using Place = std::pair<std::string, std::string>;
using Sources = std::map<Place, Source>;

Place place_of(const RecognisedMap& m) {
  return {m.file, m.layer};
}

/// Reads each file once, several at a time.
Sources read_sources(NodeContext& node, const fs::path& folder, const std::vector<RecognisedMap>& maps) {
  Sources sources;
  std::map<Place, Semantic> semantics;
  for (const RecognisedMap& m : maps) {
    sources[place_of(m)];
    semantics.emplace(place_of(m), m.semantic);
  }
  std::vector<std::pair<const Place, Source>*> entries;
  for (auto& entry : sources) entries.push_back(&entry);
  tbb::parallel_for(size_t{0}, entries.size(), [&](size_t i) {
    node.task().check();
    const auto& [file, layer] = entries[i]->first;
    Source& source = entries[i]->second;
    ImageInfo info;
    info.semantic = semantics.at(entries[i]->first);
    source.image = read_image(
        folder / file, info, [&](const std::string& w) { source.warnings.push_back(w); }, layer);
  });
  std::set<std::string> said;  // once, what holds for all layers of a file
  for (const auto& [place, source] : sources)
    for (const std::string& warning : source.warnings)
      if (said.insert(warning).second) node.note(warning);
  return sources;
}

/// What usually hides in a map's alpha channel: opacity in a base colour's; gloss in that of specular and of metallic
/// maps, as Unity takes them.
std::optional<Semantic> hidden_in_alpha(const RecognisedMap& m) {
  if (!m.channels.empty()) return std::nullopt;
  if (m.semantic == Semantic::base_color) return Semantic::opacity;
  const bool may_have_gloss = m.semantic == Semantic::specular || m.semantic == Semantic::metallic;
  return may_have_gloss ? std::optional(Semantic::roughness) : std::nullopt;
}

void add_alpha(const RecognisedMap& m, const ImagePtr& file, std::vector<Map>& maps, std::vector<std::string>& notes) {
  const std::optional<Semantic> hidden = hidden_in_alpha(m);
  if (!hidden) return;
  const bool is_gloss = *hidden == Semantic::roughness;
  const ImagePtr alpha = alpha_of(file, *hidden, is_gloss);
  if (!alpha) return;
  const std::string name(name_of(*hidden));
  if (std::any_of(maps.begin(), maps.end(), [&](const Map& k) { return k.name == name; })) {
    notes.push_back(fmt::format("the alpha channel of {} is left out: there is {} map", m.place(),
                                is_gloss ? "a roughness" : "an opacity"));
    return;
  }
  maps.push_back({name, alpha});
  notes.push_back(fmt::format("{}: {} (alpha channel){}", name, m.place(),
                              is_gloss ? ", inverted: gloss, as in the specular workflow and in Unity" : ""));
}

/// A packed file whose channels are all the same is some other map, or was packed from one map by mistake.
void warn_of_grey_packings(const std::vector<RecognisedMap>& maps, const Sources& sources,
                           std::vector<std::string>& notes) {
  std::map<Place, Texts> packed;
  for (const RecognisedMap& m : maps)
    if (m.channels.size() == 1 && m.channels != "a") packed[place_of(m)].push_back(m.map);
  for (const auto& [place, names] : packed) {
    const std::string& file = place.first;
    if (names.size() > 1 && is_grey(*sources.at(place).image))
      notes.push_back(fmt::format(
          "{}{}: {} are read from its channels, but these are the same: it is a grey picture, not a packed one. If it "
          "is one map, say which, and leave the others out: `maps` {{\"{}\": \"{}:r\", \"{}\": \"\"}}",
          warning_mark, file, fmt::join(names, ", "), names[0], file,
          fmt::join(names.begin() + 1, names.end(), "\": \"\", \"")));
  }
}

/// The space that the file, or the sidecar, says; empty if it says none.
std::string described_color_space(const RecognisedMap& m) {
  // Of a file that holds colours and something else, such as opacity, only the colours have a space.
  if (m.color_space.empty() || !is_color(m.semantic)) return "";
  try {
    return canonical_color_space(m.color_space);
  } catch (const Error& e) {
    throw Error("path",
                fmt::format("{}: {} says its colour space: {}. Set `color_space`", m.file, m.said_by, e.what()));
  }
}

/// Most MaskMaps have no detail mask; their third channel is a constant.
bool may_be_empty(const Params& params, const RecognisedMap& m) {
  return m.map == "mask_detail" && !m.channels.empty() && !std::get<TextMap>(params.at("maps")).count(m.map);
}

void compute(NodeContext& node) {
  const fs::path folder = folder_of(node.params());
  const std::string given_space = node.text("color_space") == "auto" ? "" : color_space_of(node, "color_space");
  std::vector<std::string> notes;
  const FoundMaterial material_found = find_maps(node.params(), notes);
  const std::vector<RecognisedMap>& found = material_found.maps;
  for (std::string& n : notes) node.note(std::move(n));
  notes.clear();
  const Sources sources = read_sources(node, folder, found);
  std::vector<Map> maps;
  for (const RecognisedMap& m : found) {
    const ImagePtr& file = sources.at(place_of(m)).image;
    const bool space_given = m.semantic == Semantic::base_color && !given_space.empty();
    std::string space = space_given ? given_space : described_color_space(m);
    if (space.empty()) space = assumed_color_space(m.semantic, file->info().depth);
    const ImagePtr map = map_of_file(m, file, space, notes);
    if (may_be_empty(node.params(), m) && is_constant(*map))
      notes.push_back(fmt::format("{}: {} is the same everywhere; left out", m.map, m.place()));
    else
      maps.push_back({m.map, map});
  }
  warn_of_grey_packings(found, sources, notes);
  for (const RecognisedMap& m : found) add_alpha(m, sources.at(place_of(m)).image, maps, notes);
  Texts ignored = material_found.ignored;
  add_unnamed_packing(folder, material_found.unnamed, maps, ignored, notes);
  if (!ignored.empty()) notes.push_back(note_on_ignored(ignored));
  std::ranges::stable_sort(maps, {}, [](const Map& m) { return m.image->info().semantic; });
  settle_normals(node.text("normal_y"), found, maps, notes);
  for (std::string& n : notes) node.note(std::move(n));
  MaterialPtr material = Material::make(material_found.name, std::move(maps), material_found.metres);
  if (const PhysicalSize given = metres_of(node.numbers("metres"), material->size()); given.is_known())
    material = Material::make(material->name(), material->maps(), given);
  warn_of_smaller_maps(node, *material);
  node.output("material", material);
}

std::vector<fs::path> files_read(const Params& params) {
  std::vector<fs::path> files = files_of_material(params);
  for (fs::path& f : color_config_files()) files.push_back(std::move(f));
  return files;
}

std::vector<std::string> check(const Params& params) {
  std::vector<std::string> problems = color_space_problems(params, "color_space", "auto");
  for (std::string& p : problems_with_map_names(params)) problems.push_back(std::move(p));
  return problems;
}

Forecast preflight(const Params& params, const InputForecasts&) {
  Texts ignored_notes;
  Forecast out{.possible_maps = Texts{}};
  std::set<std::string> troubles;
  const FoundMaterial found = find_maps(params, ignored_notes);
  if (!found.unnamed.empty())
    for (const Semantic s : packed_semantics) out.possible_maps->emplace_back(name_of(s));
  for (const RecognisedMap& m : found.maps) {
    (may_be_empty(params, m) ? *out.possible_maps : out.maps).push_back(m.map);
    try {
      require_readable_image(folder_of(params) / m.file);
      const FileInfo file = read_image_info(folder_of(params) / m.file, m.layer);
      out.images[m.map] = {.size = file.size, .channels = channels_of_map(m, file.channels), .semantic = m.semantic};
      const std::optional<Semantic> hidden = hidden_in_alpha(m);
      if (!hidden || file.channels % 2 != 0) continue;
      const std::string& name = out.possible_maps->emplace_back(name_of(*hidden));
      out.images.emplace(name, values_facts(file.size, *hidden));
    } catch (const Error& e) {
      troubles.insert(e.what());
    }
  }
  if (!troubles.empty()) throw Error(fmt::format("{}", fmt::join(troubles, "; ")));
  return out;
}

Texts doubts(const Params& params, const InputForecasts&) {
  Texts ignored_notes;
  for (const RecognisedMap& m : find_maps(params, ignored_notes).maps)
    if (m.semantic == Semantic::base_color && m.channels.empty() && m.layer.empty())
      return doubts_about_colour("\"path\": " + m.file, folder_of(params) / m.file);
  return {};
}

}  // namespace

NodeType load_material_node() {
  NodeType t;
  t.name = "load_material";
  t.version = 7;
  t.category = "source";
  t.summary = "Reads a folder of maps as one material";
  t.help =
      "Finds the maps in a folder by the naming conventions of ambientCG, Poly Haven, Substance, Quixel Megascans, "
      "Unreal, Unity and glTF, and by plain names; the last such word in a name counts. Packed files (ORM, ARM, "
      "metallicRoughness, MaskMap, MetallicSmoothness, AlbedoTransparency) are split into their channels, as are files "
      "of three or four channels whose names say nothing but whose pixels do, gloss and "
      "smoothness maps are inverted into roughness, grey maps stored in colour are reduced to one channel, and a base "
      "colour's alpha becomes the opacity map, that of a specular or metallic map, inverted, the roughness if there is "
      "no other. Layers of EXR files are recognised by their names. If several files hold one map, OpenGL normals, "
      "larger and lossless "
      "files are preferred. A file terrazzo-material.json, as export writes it, counts more than names, and so does "
      "what "
      "terrazzo wrote into a PNG, TIFF or EXR file's description. A folder of several materials is refused unless "
      "`name` picks one; UDIM tiles count as "
      "materials. ID maps (*_ID) are kept as labels. Maps may differ in size as long as they show the same area; a "
      "warning names those smaller "
      "than the largest, which will be scaled up. Notes say what was recognised and what was left out.";
  t.outputs = {
      {.name = "material", .type = ValueType::material, .help = "the maps found, named after their semantics"}};
  t.params = {
      {.name = "path",
       .type = ParamType::path,
       .help = "The folder of the maps, or \"library:NAME\" for the one that a named analysis was made of.",
       .library = LibraryFile::material},
      {.name = "name",
       .type = ParamType::text,
       .fallback = "",
       .help = "Which material of a folder that holds several: what the names of its files begin with, such as "
               "Bricks075, or the name of one of its files. Case, resolutions and formats do not count. * and ? stand "
               "for any characters: \"*\" takes all files as one material."},
      metres_param(
          "Exports carry it on. Empty: as a terrazzo-material.json in the folder, the files' descriptions or the "
          "data of a Megascans download say, else not known."),
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
       .help = "Files by map name, where the file names do not say it: {\"height\": \"scan.tif\", \"roughness\": "
               "\"packed.png:g\"}. Relative to the folder; channels after a colon, of EXR files a layer "
               "(\"wall.exr:normal\", \"wall.exr:arm.g\"). <UDIM> stands for the tile that `name` picks. An empty text "
               "leaves the map out."},
      {.name = "ignore",
       .type = ParamType::texts,
       .fallback = Texts{},
       .help = "File names to leave out; * and ? stand for any characters."},
      {.name = "data",
       .type = ParamType::texts,
       .fallback = Texts{},
       .help = "Files to keep although their names say no map: each becomes a data map named after the rest of its "
               "name, such as data_translucency. Data is never blended or filtered. * and ? stand for any characters; "
               "[\"*\"] keeps all."},
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
  t.preflight = preflight;
  t.doubts = doubts;
  t.check = check;
  return t;
}

}  // namespace terrazzo
