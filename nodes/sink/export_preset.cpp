#include "nodes/exchange/export_preset.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/text.h"
#include "core/file/file_io.h"
#include "core/image/color.h"
#include "core/material/file_stems.h"
#include "core/node/node.h"
#include "nodes/common/node_helpers.h"
#include "nodes/exchange/scene.h"
#include "nodes/sink/export_paths.h"
#include "nodes/sink/map_files.h"
#include "nodes/source/material_sidecar.h"

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

/// What files are named after, without the UDIM tile.
std::string name_of_files(const std::string& given, const Material& material) {
  std::string out;
  for (const char c : without_udim_tile(given.empty() ? material.name() : given))
    out += is_word(c) || c == '-' ? c : '_';
  return out.empty() ? "material" : out;
}

/// The surface's size: as the parameter says, else as the material knows it; not known if neither does.
PhysicalSize metres_of(const NodeContext& node, const Material& material) {
  const Numbers& given = node.numbers("metres");
  return given.empty() ? material.metres() : metres_of(given, material.size());
}

fs::path folder_for(const NodeContext& node, const Material& material) {
  return filled("path", node.text("path"), {"", material.name(), material.size()});
}

MapFileJob job_for(NodeContext& node, FileContent& content, const fs::path& folder) {
  const std::string& extension = node.text("format");
  MapFileJob job{.name = content.name, .image = content.image, .target = folder / (content.name + "." + extension)};
  job.has_levels = node.flag("mips");
  job.options.format = *format_from(job.target);
  job.options.jpeg_quality = int(node.integer("jpeg_quality"));
  const bool needs_alpha = job.image->channels() == 4;
  if (needs_alpha && job.options.format == FileFormat::jpeg)
    throw Error("format", fmt::format("{} needs an alpha channel ({}), which JPEG does not have; take png",
                                      content.name, described(content)));
  job.options.depth = written_depth(job.options.format, node.text("depth"), job.image->info().depth);
  // Float files hold linear colours, whoever reads them.
  if (is_color(job.image->info().semantic))
    job.image = convert_color(job.image, assumed_color_space(job.image->info().semantic, job.options.depth));
  content.image = job.image;
  tell_of_losses(node, job, node.text("depth") != "keep");
  return job;
}

/// A file that is written as it is.
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

/// Of one binary file, only what is not in it is written beside it.
void leave_rest(const MaterialScene& scene, std::vector<MapFileJob>& jobs,
                std::vector<std::pair<std::string, const FileContent*>>& listed) {
  const auto is_inside = [&](const std::string& file) {
    return std::ranges::find(scene.files, file, &SceneFile::name) != scene.files.end();
  };
  std::erase_if(jobs, [&](const MapFileJob& job) { return is_inside(job.target.filename().string()); });
  std::erase_if(listed, [&](const auto& entry) { return is_inside(entry.first); });
}

void compute(NodeContext& node) {
  const auto material = node.input<Material>("material");
  const ExportPreset& preset = preset_of(node.params());
  const std::string name = name_of_files(node.text("name"), *material);
  const std::string tile = udim_tile_of(material->name()), tiled_name = tile.empty() ? name : name + "." + tile;
  const PhysicalSize metres = metres_of(node, *material);
  const fs::path folder = folder_for(node, *material);
  std::vector<std::string> notes;
  std::vector<FileContent> contents = preset_files(preset, *material, name, notes);
  for (FileContent& c : contents) c.name += tiled_name.substr(name.size());
  MaterialScene scene = has_document(preset) ? scene_of(node, tiled_name, metres, *material) : MaterialScene();
  std::vector<MapFileJob> jobs;
  for (FileContent& c : contents) jobs.push_back(job_for(node, c, folder));
  require_distinct(jobs);
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
    const TextFile document = document_for(preset, scene, jobs);
    write_file(node.stage(folder / document.name), document.bytes);
  }
  if (preset.document == PresetDocument::glb) leave_rest(scene, jobs, listed);
  if (jobs.empty()) return;
  write_file(node.stage(folder / sidecar_name(tiled_name)), sidecar_text(preset, tiled_name, metres, listed));
  for (MapFileJob& job : jobs) stage_job(node, job);
  write_all(node, jobs);
}

Texts check(const Params& params) {
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

Forecast preflight(const Params& params, const InputForecasts&) {
  const std::string& path = std::get<std::string>(params.at("path"));
  const fs::path folder = path.substr(0, path.find('{'));
  const bool is_known = folder == path;
  return {.files = {{"path", is_known ? folder : folder.parent_path(), "", "the maps"}}};
}

std::vector<Param> params() {
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
  t.params = params();
  t.version = 3;
  t.persist = Persist::digest;
  t.files_read = [](const Params&) { return color_config_files(); };
  t.memory_hint = [](const NodeContext& node) {
    const auto material = node.input<Material>("material");
    constexpr size_t per_file = size_t{12} << 20;  // a strip as floats, and as the file's values
    const bool in_memory = preset_of(node.params()).document == PresetDocument::glb;
    return per_file * (1 + material->maps().size()) + (in_memory ? size_t(material->size().area()) * 16 : 0);
  };
  t.check = check;
  t.compute = compute;
  t.preflight = preflight;
  return t;
}

}  // namespace terrazzo
