#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/image_io/color.h"
#include "core/image_io/image_file.h"
#include "core/material/map_description.h"
#include "core/material/material_maps.h"
#include "core/node/node.h"
#include "nodes/common/color_space.h"
#include "nodes/common/exemplar_lint.h"
#include "nodes/common/node_helpers.h"
#include "nodes/common/shape_rules.h"
#include "nodes/source/maps/depth_checks.h"
#include "nodes/source/maps/interpretations.h"
#include "nodes/source/maps/material_folder.h"
#include "nodes/source/maps/material_sources.h"
#include "nodes/source/maps/normal_checks.h"
#include "nodes/source/maps/normal_maps.h"
#include "nodes/source/maps/packing_checks.h"
#include "nodes/source/maps/unnamed_packings.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

/// The colour space stated by the file or the sidecar; empty if there is none.
std::string described_color_space(const RecognisedMap& m) {
  // In a file with colours and other maps, such as opacity, only the colours have a colour space.
  if (m.color_space.empty() || !is_color(m.semantic)) return "";
  try {
    return canonical_color_space(m.color_space);
  } catch (const Error& e) {
    throw Error("path",
                fmt::format("{}: {} says its colour space: {}. Set `color_space`", m.file, m.said_by, e.what()));
  }
}

/// `with_alpha` receives the map's name if x or y is in the file's alpha channel.
ImagePtr normals_of(const RecognisedMap& m, const Source& source, const std::string& space,
                    const std::vector<Map>& maps, Texts& with_alpha, std::vector<std::string>& notes) {
  // Selected channels may be just x and y, in this order.
  const ImagePtr chosen = m.channels.empty() ? source.image : map_of_file(m, source.image, space, notes);
  NormalFile file{.place = m.place(), .map = m.map, .names = source.channel_names, .channels = m.interpretation.normal};
  if (!m.channels.empty()) file.names = chosen->channels() == 2 ? Texts{"x", "y"} : Texts();
  const auto height = std::ranges::find(maps, "height", &Map::name);
  const RebuiltNormals rebuilt =
      rebuilt_normals(chosen, file, height == maps.end() ? nullptr : height->image.get(), notes);
  if (rebuilt.uses_alpha) with_alpha.push_back(m.map);
  if (!rebuilt.image) return map_of_file(m, source.image, space, notes);
  ImageInfo info = rebuilt.image->info();
  info.semantic = m.semantic;
  info.color_space = space;
  return Image::redescribed(rebuilt.image, info);
}

/// The normal convention set by the user, if any.
std::optional<NormalY> given_normal_y(const NodeContext& node) {
  const std::string& given = node.text("normal_y");
  return given == "auto" ? std::nullopt : std::optional(given == "up" ? NormalY::up : NormalY::down);
}

bool is_given(const Params& params, const RecognisedMap& m) {
  return std::get<TextMap>(params.at("maps")).count(m.map) > 0;
}

/// Most MaskMaps have no detail mask; their third channel is a constant.
bool may_be_empty(const Params& params, const RecognisedMap& m) {
  return m.map == "mask_detail" && !m.channels.empty() && !is_given(params, m);
}

void compute_load_material(NodeContext& node) {
  const fs::path folder = folder_of(node.params());
  const std::string given_space = node.text("color_space") == "auto" ? "" : color_space_of(node, "color_space");
  std::vector<std::string> notes;
  FoundMaterial material_found = find_maps(node.params(), notes);
  for (std::string& n : notes) node.note(std::move(n));
  notes.clear();
  const Sources sources = read_sources(node, folder, material_found.maps);
  const auto image_of = [&](const RecognisedMap& m) { return sources.at(place_of(m)).image; };
  for (RecognisedMap& m : material_found.maps) settle_only_alpha(m, *image_of(m), notes);
  const std::vector<RecognisedMap>& found = material_found.maps;
  std::vector<Map> maps;
  Texts with_alpha;
  const auto add_map = [&](const RecognisedMap& m) {
    const Source& source = sources.at(place_of(m));
    const bool space_given = m.semantic == Semantic::base_color && !given_space.empty();
    std::string space = space_given ? given_space : described_color_space(m);
    if (space.empty())
      if (space = stated_color_space(read_image_info(folder / m.file, m.layer), m.semantic); !space.empty())
        notes.push_back(fmt::format("{}: {} is read as {}, as it says", m.map, m.place(), space));
    if (space.empty()) space = assumed_color_space(m.semantic, source.image->info().depth);
    const ImagePtr map = m.semantic == Semantic::normal ? normals_of(m, source, space, maps, with_alpha, notes)
                                                        : map_of_file(m, source.image, space, notes);
    if (may_be_empty(node.params(), m) && is_constant(*map))
      notes.push_back(fmt::format("{}: {} is the same everywhere; left out", m.map, m.place()));
    else
      maps.push_back({m.map, map});
  };
  const auto is_normal = [](const RecognisedMap& m) { return m.semantic == Semantic::normal; };
  for (const RecognisedMap& m : found)
    if (!is_normal(m)) add_map(m);
  for (const RecognisedMap& m : found)
    if (is_normal(m)) add_map(m);  // a height map may tell their channels apart
  std::vector<RecognisedMap> by_name = found;
  std::erase_if(by_name, [&](const RecognisedMap& m) { return is_given(node.params(), m); });
  settle_packings(by_name, image_of, maps, notes);
  tell_of_unused_channels(by_name, found, image_of, notes);
  leave_out_unrelated(by_name, maps, notes);
  for (const RecognisedMap& m : found)
    if (std::ranges::find(with_alpha, m.map) == with_alpha.end()) add_alpha(m, image_of(m), maps, notes);
  Texts ignored = material_found.ignored;
  add_unnamed_packing(folder, material_found.unnamed, maps, ignored, notes);
  if (!ignored.empty()) notes.push_back(note_on_ignored(ignored));
  std::ranges::stable_sort(maps, {}, [](const Map& m) { return m.image->info().semantic; });
  settle_depths(given_normal_y(node), found, maps, notes);
  settle_normals(node.text("normal_y"), found, maps, notes);
  for (std::string& n : notes) node.note(std::move(n));
  MaterialPtr material = Material::make(material_found.name, std::move(maps), material_found.metres);
  if (const PhysicalSize given = metres_of(node.numbers("metres"), material->size()); given.is_known())
    material = Material::make(material->name(), material->maps(), given);
  warn_of_smaller_maps(node, *material);
  node.output("material", material);
}

std::vector<fs::path> files_read_by_load_material(const Params& params) {
  std::vector<fs::path> files = files_of_material(params);
  for (fs::path& f : color_config_files()) files.push_back(std::move(f));
  return files;
}

std::vector<std::string> check_load_material(const Params& params) {
  std::vector<std::string> problems = color_space_problems(params, "color_space", "auto");
  for (std::string& p : problems_with_map_names(params)) problems.push_back(std::move(p));
  for (std::string& p : problems_with_interpretations(params)) problems.push_back(std::move(p));
  return problems;
}

/// Throws Error if a file of normals has too few channels for how it is to be read.
void require_interpretable(const Params& params, const RecognisedMap& m) {
  if (m.semantic != Semantic::normal || !m.interpretation.normal) return;
  int channels = 0;
  try {
    channels = channels_of_map(m, read_image_info(folder_of(params) / m.file, m.layer).channels);
  } catch (const Error&) {
    return;  // the file cannot be read, which is reported
  }
  try {
    require_channels(*m.interpretation.normal, channels);
  } catch (const Error& e) {
    const bool is_asked = std::get<TextMap>(params.at("interpret")).count(m.map) > 0;
    throw Error(is_asked ? "interpret" : "path", fmt::format("{}: {}: {}", m.map, m.place(), e.what()));
  }
}

Forecast preflight_load_material(const Params& params, const InputForecasts&) {
  Texts ignored_notes;
  Forecast out{.possible_maps = Texts{}};
  std::set<std::string> troubles;
  const FoundMaterial found = find_maps(params, ignored_notes);
  for (const RecognisedMap& m : found.maps) require_interpretable(params, m);
  if (!found.unnamed.empty())
    for (const Semantic s : packed_semantics) out.possible_maps->emplace_back(name_of(s));
  const std::map<SourcePlace, Size> sizes = sizes_of_sources(folder_of(params), found.maps);
  for (const RecognisedMap& m : found.maps) {
    const bool may_lack = may_be_empty(params, m) || (may_be_left_out(m) && !is_given(params, m));
    (may_lack ? *out.possible_maps : out.maps).push_back(m.map);
    try {
      require_readable_image(folder_of(params) / m.file);
      const FileInfo file = read_image_info(folder_of(params) / m.file, m.layer);
      const Size size = sizes.at(place_of(m));
      out.images[m.map] = {.size = size, .channels = channels_of_map(m, file.channels), .semantic = m.semantic};
      const std::optional<Semantic> hidden = hidden_in_alpha(m);
      if (!hidden || file.channels % 2 != 0 || (m.semantic == Semantic::normal && file.channels != 4)) continue;
      const std::string& name = out.possible_maps->emplace_back(name_of(*hidden));
      out.images.emplace(name, values_facts(size, *hidden));
    } catch (const Error& e) {
      troubles.insert(e.what());
    }
  }
  if (!troubles.empty()) throw Error(fmt::format("{}", fmt::join(troubles, "; ")));
  return out;
}

Lints lint_of_load_material(const Params& params, const InputForecasts&) {
  Texts ignored_notes;
  for (const RecognisedMap& m : find_maps(params, ignored_notes).maps)
    if (m.semantic == Semantic::base_color && m.channels.empty() && m.layer.empty())
      return lint_of_colour("\"path\": " + m.file, folder_of(params) / m.file);
  return {};
}

}  // namespace

NodeType load_material_node() {
  NodeType t;
  t.name = "load_material";
  t.version = 9;
  t.category = "source";
  t.summary = "Reads a folder of maps as one material";
  t.help =
      "Finds the maps in a folder by the naming conventions of ambientCG, Poly Haven, Substance, Quixel Megascans, "
      "Unreal, Unity and glTF, and by plain names; the last such word in a name counts. Packed files (ORM, ARM, AORM, "
      "metallicRoughness, OcclusionRoughMetal, MaskMap, MetallicSmoothness, AlbedoTransparency, alb_ht and nrm_rgh "
      "with "
      "the second map in alpha) are split into their channels, as are files "
      "of three or four channels whose names say nothing but whose pixels do, gloss and "
      "smoothness maps are inverted into roughness, grey maps stored in colour are reduced to one channel, and a base "
      "colour's alpha becomes the opacity map, that of a specular or metallic map, inverted, the roughness if there is "
      "no other, that of a normal map the height if the normals follow it; opacity that is only in alpha is read from "
      "there. Layers and channels of EXR files are "
      "recognised by their names, whatever their order. A picture named just like the other maps' material is its base "
      "colour. If several files hold one map, OpenGL normals, finer levels of detail, larger and lossless "
      "files are preferred. A file terrazzo-material.json, as export writes it, counts more than names, and so does "
      "what "
      "terrazzo wrote into a PNG, TIFF or EXR file's description. Normals without z, as BC5 and DXT5nm store them, get "
      "it "
      "from x and y. A file whose orientation tag turns it away from the other maps is read as it is stored. A folder "
      "of several materials is refused unless "
      "`name` picks one; UDIM tiles count as "
      "materials. ID maps (*_ID) are kept as labels. Maps may differ in size as long as they show the same area; a "
      "warning names those smaller "
      "than the largest, which will be scaled up. Notes say what was recognised and what was left out. Words that say "
      "a map: " +
      words_for_maps() + ".";
  t.outputs = {
      {.name = "material", .type = ValueType::material, .help = "the maps found, named after their semantics"}};
  t.params = {
      {.name = "path",
       .type = ParamType::path,
       .help = "The folder of the maps, or a picture, which is the base colour; or \"library:NAME\" for what a named "
               "analysis was made of.",
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
      {.name = "interpret",
       .type = ParamType::text_map,
       .fallback = TextMap{},
       .help = "What the files hold, by map name, where neither names nor pixels say it: {\"normal\": \"dxt5nm\", "
               "\"height\": \"inverted\"}. " +
               std::string(interpretation_help) +
               ". \"alpha\" names the map of one value that the only file with an alpha channel holds there: "
               "{\"alpha\": \"height\"}."},
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
       .help = "The colour space of the base colour. \"auto\": as a terrazzo-material.json, the file's description or "
               "a PNG "
               "file's gAMA chunk that says linear; else srgb_texture in 8 and 16 bit, lin_rec709 in float files."},
  };
  t.persist = Persist::digest;
  t.compute = compute_load_material;
  t.files_read = files_read_by_load_material;
  t.memory_hint = [](const NodeContext& node) {
    size_t bytes = 0;
    for (const fs::path& file : files_of_material(node.params())) try {
        const FileInfo info = read_image_info(file);
        bytes += size_t(info.size.area()) * info.channels * sizeof(float);
      } catch (const Error&) {
        continue;  // compute reports it
      }
    return bytes;
  };
  t.preflight = preflight_load_material;
  t.lint = lint_of_load_material;
  t.check = check_load_material;
  return t;
}

}  // namespace terrazzo
