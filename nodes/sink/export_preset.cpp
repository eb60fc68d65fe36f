#include "nodes/exchange/export_preset.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/text.h"
#include "core/file/file_io.h"
#include "core/image_io/color.h"
#include "core/material/map_names.h"
#include "core/naming/file_stems.h"
#include "core/node/node.h"
#include "nodes/common/node_helpers.h"
#include "nodes/common/shape_rules.h"
#include "nodes/exchange/scene.h"
#include "nodes/sink/export_paths.h"
#include "nodes/sink/map_files.h"
#include "nodes/source/maps/material_sidecar.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

constexpr double width_if_unknown = 1;  // metres

const ExportPreset& preset_of(const Params& params) {
  return *find_export_preset(std::get<std::string>(params.at("preset")));
}

bool is_gltf(const ExportPreset& preset) {
  return preset.document == PresetDocument::gltf || preset.document == PresetDocument::glb;
}

bool has_document(const ExportPreset& preset) {
  return preset.document != PresetDocument::none;
}

/// Formats that readers of the documents must know.
Texts formats_of(PresetDocument document) {
  switch (document) {
    case PresetDocument::gltf:
    case PresetDocument::glb:
      return {"png", "jpg"};
    case PresetDocument::usd:
      return {"png", "jpg", "exr"};
    default:
      return {"png", "tif", "exr", "jpg", "tga", "tx"};
    case PresetDocument::blender:
      return {"png", "tif", "exr", "jpg", "tga"};
  }
}

/// The requested base of file names, without the UDIM tile.
std::string wanted_name(const std::string& given, const Material& material) {
  return without_udim_tile(given.empty() ? material.name() : given);
}

/// The base of file names, restricted to characters that every file system and reader accepts.
std::string name_of_files(const std::string& given, const Material& material) {
  std::string out;
  for (const char c : wanted_name(given, material)) out += is_word(c) || c == '-' ? c : '_';
  return out.empty() ? "material" : out;
}

/// Adds a note if the document cannot contain the material's name unchanged.
void tell_of_identifier(NodeContext& node, PresetDocument document, const std::string& name) {
  const bool has_identifiers = document == PresetDocument::materialx_standard_surface ||
                               document == PresetDocument::materialx_open_pbr || document == PresetDocument::usd;
  if (!has_identifiers || identifier(name) == name) return;
  node.note(fmt::format("the material is called {} in the document, which takes letters, digits and _ only",
                        identifier(name)));
}

/// The surface's size from the parameter, else from the material; unknown if neither has it.
PhysicalSize metres_of(const NodeContext& node, const Material& material) {
  const Numbers& given = node.numbers("metres");
  return given.empty() ? material.metres() : metres_of(given, material.size());
}

fs::path folder_for(const NodeContext& node, const Material& material) {
  return filled("path", node.text("path"), {"", material.name(), material.size()});
}

MapFileJob job_for(NodeContext& node, FileContent& content, const Material& material, const fs::path& folder) {
  const std::string& extension = node.text("format");
  MapFileJob job{.name = content.name, .image = content.image, .target = folder / (content.name + "." + extension)};
  job.has_levels = node.flag("mips");
  job.options.format = *format_from(job.target);
  job.options.jpeg_quality = int(node.integer("jpeg_quality"));
  job.options.depth = written_depth(job.options.format, node.text("depth"), job.image->info().depth);
  // Float files hold linear colours, whoever reads them.
  if (is_color(job.image->info().semantic))
    job.image = convert_color(job.image, assumed_color_space(job.image->info().semantic, job.options.depth));
  weigh_levels(node, job, material.find(Semantic::opacity));
  content.image = job.image;
  tell_of_losses(node, job, node.text("depth") != "keep");
  return job;
}

/// Throws Error about "format" if the format cannot hold the files, or about "path" if two files have the same name.
void require_written(const Params& params, const std::vector<FileContent>& contents) {
  std::vector<MapFileJob> jobs;
  for (const FileContent& c : contents) {
    jobs.push_back(
        {.name = c.name, .image = c.image, .target = c.name + "." + std::get<std::string>(params.at("format"))});
    if (c.image->channels() == 4 && format_from(jobs.back().target) == FileFormat::jpeg)
      throw Error("format", fmt::format("{} needs an alpha channel ({}), which JPEG does not have; take png", c.name,
                                        described(c)));
  }
  require_distinct(jobs);
}

/// A placeholder material with descriptions of the certain or possible maps, without pixels.
MaterialPtr stand_in(const Forecast& material, const Texts& of) {
  std::vector<Map> maps;
  for (const std::string& map : of) {
    const ImageFacts facts = map_of(material, map);
    ImageInfo info{.size = facts.size.value_or(Size{1, 1})};
    info.semantic = facts.semantic.value_or(semantic_of_map(map).value_or(Semantic::data));
    info.channels = facts.channels.value_or(is_color(info.semantic) || info.semantic == Semantic::normal ? 3 : 1);
    info.color_space = assumed_color_space(info.semantic, info.depth);
    maps.push_back(
        {map, Image::computed(info, Hasher().add("stand-in").add(map).digest(), [](const Rect&, float*) {})});
  }
  return maps.empty() ? nullptr : Material::make("", std::move(maps));
}

void require_written(const Params& params, const Forecast& described, const Texts& maps) {
  std::vector<std::string> unsaid;
  if (const MaterialPtr material = stand_in(described, maps))
    require_written(params, preset_files(preset_of(params), *material,
                                         name_of_files(std::get<std::string>(params.at("name")), *material), unsaid));
}

OutputForecasts infer_export_preset(const Params& params, const InputForecasts& inputs) {
  const Forecast& material = inputs.at("material").front();
  require_written(params, material, material.maps);
  return {};
}

/// Errors that occur if the material has all its possible maps, such as opacity in alpha.
Lints lint_of_export_preset(const Params& params, const InputForecasts& inputs) {
  const auto material = inputs.find("material");
  if (material == inputs.end() || !material->second.front().possible_maps) return {};
  Texts all = material->second.front().maps;
  for (const std::string& map : *material->second.front().possible_maps)
    if (std::ranges::find(all, map) == all.end()) all.push_back(map);
  try {
    require_written(params, material->second.front(), all);
  } catch (const Error& e) {
    return {{fmt::format("\"{}\": this may be refused once the maps are read: {}", e.about(), e.what())}};
  }
  return {};
}

/// A file that is written unchanged.
struct TextFile {
  std::string name;
  std::string bytes;
};

TextFile document_for(const ExportPreset& preset, const MaterialScene& scene, const std::vector<MapFileJob>& jobs) {
  switch (preset.document) {
    case PresetDocument::gltf:
      return {scene.name + ".gltf", gltf_text(scene)};
    case PresetDocument::glb: {
      std::vector<std::string> images;
      for (const SceneFile& f : scene.files) {
        const auto job = std::ranges::find(jobs, f.name, [](const auto& j) { return j.target.filename().string(); });
        const std::vector<uint8_t> bytes = encoded_file(*job->image, job->options);
        images.emplace_back(bytes.begin(), bytes.end());
      }
      return {scene.name + ".glb", glb_bytes(scene, images)};
    }
    case PresetDocument::materialx_standard_surface:
      return {scene.name + ".mtlx", materialx_text(scene, false)};
    case PresetDocument::materialx_open_pbr:
      return {scene.name + ".mtlx", materialx_text(scene, true)};
    case PresetDocument::usd:
      return {scene.name + ".usda", usd_text(scene)};
    case PresetDocument::blender:
      return {scene.name + ".py", blender_script(scene)};
    case PresetDocument::none:
      break;
  }
  return {};
}

MaterialScene scene_of(NodeContext& node, const std::string& name, PhysicalSize metres, const Material& material) {
  MaterialScene scene{.name = name, .metres = metres};
  const Numbers& repeats = node.numbers("repeats");
  scene.repeats = {repeats[0], repeats.back()};
  scene.relief = node.number("relief");
  if (!metres.is_known()) {
    const Size size = material.size();
    scene.metres = {width_if_unknown, width_if_unknown * size.height / size.width};
    node.note(
        fmt::format("the physical size is not known: {:g} m in width is assumed; set \"metres\"", width_if_unknown));
  }
  return scene;
}

/// With one binary file, only maps that it does not contain are written separately.
void leave_rest(const MaterialScene& scene, std::vector<MapFileJob>& jobs,
                std::vector<std::pair<std::string, const FileContent*>>& listed) {
  const auto is_inside = [&](const std::string& file) {
    return std::ranges::find(scene.files, file, &SceneFile::name) != scene.files.end();
  };
  std::erase_if(jobs, [&](const MapFileJob& job) { return is_inside(job.target.filename().string()); });
  std::erase_if(listed, [&](const auto& entry) { return is_inside(entry.first); });
}

/// Notes files of an earlier export that this one does not write, including mip levels.
void warn_of_left_over(NodeContext& node, const fs::path& folder, const Texts& before) {
  std::set<std::string> written, names(before.begin(), before.end()), left_over;
  for (const StagedFile& f : node.staged()) written.insert(f.target.filename().string());
  names.insert(written.begin(), written.end());
  std::error_code failure;
  const auto is_left_over = [&](const std::string& name) {
    return !written.contains(name) && fs::exists(folder / name, failure);
  };
  for (const std::string& name : names) {
    if (is_left_over(name)) left_over.insert(name);
    for (int level = 1;; level++) {
      const std::string file = mip_file(name, level).string();
      if (is_left_over(file))
        left_over.insert(file);
      else if (!written.contains(file))
        break;
    }
  }
  if (!left_over.empty())
    node.warn(
        fmt::format("{} still holds {} of an earlier export, which this one does not write; remove {}, or other "
                    "programs may take {} for maps of this material",
                    folder.string(), fmt::join(left_over, ", "), left_over.size() == 1 ? "it" : "them",
                    left_over.size() == 1 ? "it" : "them"));
}

void compute_export_preset(NodeContext& node) {
  const auto material = node.input<Material>("material");
  const ExportPreset& preset = preset_of(node.params());
  const std::string wanted = wanted_name(node.text("name"), *material);
  const std::string name = name_of_files(node.text("name"), *material);
  if (name != wanted)
    node.note(
        fmt::format("files are named after {}, as \"{}\" has characters that not every program takes", name, wanted));
  const std::string tile = udim_tile_of(material->name()), tiled_name = tile.empty() ? name : name + "." + tile;
  const PhysicalSize metres = metres_of(node, *material);
  const fs::path folder = folder_for(node, *material);
  std::vector<std::string> notes;
  std::vector<FileContent> contents = preset_files(preset, *material, name, notes);
  for (FileContent& c : contents) c.name += tiled_name.substr(name.size());
  MaterialScene scene = has_document(preset) ? scene_of(node, tiled_name, metres, *material) : MaterialScene();
  std::vector<MapFileJob> jobs;
  for (FileContent& c : contents) jobs.push_back(job_for(node, c, *material, folder));
  std::vector<std::pair<std::string, const FileContent*>> listed;
  for (size_t i = 0; i < jobs.size(); i++) {
    jobs[i].options.description = metadata_line(contents[i], metres);
    const std::string file = jobs[i].target.filename().string();
    node.note(fmt::format("{}: {}", file, described(contents[i])));
    listed.emplace_back(file, &contents[i]);
    if (!is_gltf(preset) || gltf_takes(contents[i])) scene.files.push_back({file, &contents[i]});
  }
  for (std::string& n : notes) node.note(std::move(n));
  if (has_document(preset)) {
    tell_of_identifier(node, preset.document, tiled_name);
    const TextFile document = document_for(preset, scene, jobs);
    write_file(node.stage(folder / document.name), document.bytes);
  }
  if (preset.document == PresetDocument::glb) leave_rest(scene, jobs, listed);
  const Texts before = files_exported_before(folder, tiled_name);
  if (jobs.empty() && before.empty()) return;
  write_file(node.stage(folder / sidecar_name(tiled_name)), sidecar_text(preset, tiled_name, metres, listed));
  for (MapFileJob& job : jobs) stage_job(node, job);
  warn_of_left_over(node, folder, before);
  write_all(node, jobs);
}

Texts check_export_preset(const Params& params) {
  Texts problems;
  const auto numbers = [&](const char* name) -> const Numbers& { return std::get<Numbers>(params.at(name)); };
  const std::string& format = std::get<std::string>(params.at("format"));
  const ExportPreset& preset = preset_of(params);
  const Texts formats = formats_of(preset.document);
  if (std::ranges::find(formats, format) == formats.end())
    problems.push_back(
        fmt::format("\"format\": {} takes {}, found \"{}\"", preset.name, fmt::join(formats, " or "), format));
  else
    try {
      require_depth(*format_from("x." + format), std::get<std::string>(params.at("depth")));
    } catch (const Error& e) {
      problems.push_back(fmt::format("\"depth\": {}", e.what()));
    }
  if (numbers("repeats").empty()) problems.emplace_back("\"repeats\": expected one number or two");
  return problems;
}

Forecast preflight_export_preset(const Params& params, const InputForecasts&) {
  const std::string& path = std::get<std::string>(params.at("path"));
  const fs::path folder = path.substr(0, path.find('{'));
  const bool is_known = folder == path;
  return {.files = {{"path", is_known ? folder : folder.parent_path(), "", "the maps"}}};
}

std::vector<Param> export_preset_params() {
  Texts presets;
  std::string help = "Whose files, channels and conventions:";
  for (const ExportPreset& p : export_presets()) {
    presets.emplace_back(p.name);
    help += fmt::format(" {}: {}.", p.name, p.summary);
  }
  return {
      {.name = "preset", .type = ParamType::choice, .fallback = "maps", .help = help, .choices = presets},
      {.name = "path",
       .type = ParamType::path,
       .help = "The folder to write to; {material}, {width} and {height} are replaced."},
      {.name = "name",
       .type = ParamType::text,
       .fallback = "",
       .help = "What files and materials are named after; empty: the material's name."},
      {.name = "format",
       .type = ParamType::choice,
       .fallback = "png",
       .help =
           "File format of the maps. glTF takes png and jpg, USD exr too; tx is TIFF with tiles and mip levels, for "
           "renderers.",
       .choices = {"png", "tif", "exr", "jpg", "tga", "tx"}},
      depth_param(),
      mips_param(),
      {.name = "jpeg_quality",
       .type = ParamType::integer,
       .fallback = int64_t{95},
       .help = "Quality of JPEG files; lower makes smaller files with more artefacts.",
       .min = 1,
       .max = 100},
      metres_param("Empty: as the material knows it."),
      {.name = "repeats",
       .type = ParamType::numbers,
       .fallback = Numbers{1},
       .help = "How often the plane in glTF, USD and Blender shows the maps, along x and y; for maps that tile.",
       .min = 0.001,
       .max = 1000,
       .max_count = 2},
      {.name = "relief",
       .type = ParamType::number,
       .fallback = 0.0,
       .help = "Height of the surface from 0 to 1 of the height map, for displacement in MaterialX, USD and Blender; 0 "
               "leaves displacement out, which some readers do not know.",
       .min = 0,
       .max = 1000,
       .unit = "metres"},
  };
}

}  // namespace

NodeType export_preset_node() {
  NodeType t;
  t.name = "export_preset";
  t.category = "sink";
  t.summary = "Writes a material as an engine or a renderer takes it";
  t.help =
      "Writes maps with the names, channels, colour spaces and normals of the preset, and the document that ties them "
      "together: glTF, MaterialX, USD, or a script for Blender. What the material lacks is a constant; what the "
      "preset does not take is written as a file of its own. Every file's convention is noted, stored in its metadata, "
      "and in terrazzo-material.json beside the files, from which load_material reads them right again. Heights have "
      "at least 16 bits, since 8 show as steps.";
  t.inputs = {{.name = "material", .type = ValueType::material, .help = "the maps to write"}};
  t.params = export_preset_params();
  t.version = 6;
  t.persist = Persist::digest;
  t.files_read = [](const Params&) { return color_config_files(); };
  t.memory_hint = [](const NodeContext& node) {
    const auto material = node.input<Material>("material");
    constexpr size_t per_file = size_t{12} << 20;  // a strip as floats, and as the file's values
    const bool in_memory = preset_of(node.params()).document == PresetDocument::glb;
    return per_file * (1 + material->maps().size()) + (in_memory ? size_t(material->size().area()) * 16 : 0);
  };
  t.check = check_export_preset;
  t.infer = infer_export_preset;
  t.compute = compute_export_preset;
  t.preflight = preflight_export_preset;
  t.lint = lint_of_export_preset;
  return t;
}

}  // namespace terrazzo
