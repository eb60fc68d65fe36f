#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "core/exemplar/uv_image.h"
#include "core/file/file_io.h"
#include "core/image/normal.h"
#include "core/image_io/color.h"
#include "core/image_io/image_file.h"
#include "core/material/map_description.h"
#include "core/material/map_names.h"
#include "core/node/node.h"
#include "nodes/common/color_space.h"
#include "nodes/sink/export_paths.h"
#include "nodes/sink/export_report.h"
#include "nodes/sink/map_files.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

ImagePtr with_normals(const ImagePtr& image, const std::string& wish) {
  return wish == "keep" ? image : with_normal_y(image, wish == "down" ? NormalY::down : NormalY::up);
}

std::vector<Map> chosen_maps(const NodeContext& node, const Material& material) {
  const Texts& only = node.texts("maps");
  if (only.empty()) return material.maps();
  require_maps("maps", only, names_of(material.maps()));
  std::vector<Map> chosen;
  for (const std::string& name : only)
    if (std::none_of(chosen.begin(), chosen.end(), [&](const Map& m) { return m.name == name; }))
      chosen.push_back({name, material.find(name)});
  return chosen;
}

/// Converts colours to the requested space. "keep" writes linear colours to float files and sRGB to others, as
/// applications assume; other spaces must be set in the application anyway.
ImagePtr with_colors(const ImagePtr& image, const std::string& wish, Depth written) {
  const ImageInfo& info = image->info();
  if (!is_color(info.semantic)) return image;
  if (wish != "keep") return convert_color(image, wish);
  const bool usual = info.color_space == "srgb_texture" || info.color_space == "lin_rec709";
  return usual ? convert_color(image, assumed_color_space(info.semantic, written)) : image;
}

/// The image prepared for the file, with the file's depth.
MapFileJob job_for(NodeContext& node, const Map& map, const Material& material, const fs::path& target) {
  MapFileJob job{.name = map.name, .image = with_normals(map.image, node.text("normal_y")), .target = target};
  job.has_levels = node.flag("mips");
  job.options.format = required_format("path", target);
  require_depth(job.options.format, node.text("depth"));
  job.options.jpeg_quality = int(node.integer("jpeg_quality"));
  job.options.depth = written_depth(job.options.format, node.text("depth"), map.image->info().depth);
  job.image = with_colors(job.image, node.text("color_space"), job.options.depth);
  weigh_levels(node, job, material.find(Semantic::opacity));
  tell_of_losses(node, job, node.text("depth") != "keep");
  return job;
}

void add_material(NodeContext& node, const Material& material, std::vector<MapFileJob>& jobs) {
  const std::string& pattern = node.text("path");
  const std::vector<Map> maps = chosen_maps(node, material);
  const auto target_of = [&](const Map& m) {
    return filled("path", pattern, {m.name, material.name(), m.image->size()});
  };
  target_of(maps.front());  // throws if the pattern itself is invalid
  std::vector<std::string> names;
  for (const Map& m : maps) names.push_back(m.name);
  require_pattern_for(pattern, names);
  for (const Map& m : maps) {
    MapFileJob& job = jobs.emplace_back(job_for(node, m, material, target_of(m)));
    job.options.description = description_line(description_of(m.name, job.image->info(), material.metres()));
  }
}

fs::path uv_target(const NodeContext& node, const UvMap& uv, const std::string& material) {
  const char* param = param_of_uv(node.params());
  fs::path target = filled(param, node.text(param), {"uv", material, uv.size()});
  require_exact_format(target);
  return target;
}

void add_uv(NodeContext& node, const UvMapPtr& uv, const std::string& material, std::vector<MapFileJob>& jobs) {
  MapFileJob job{.name = "uv", .image = nullptr, .target = uv_target(node, *uv, material)};
  job.options.format = *format_from(job.target);
  const bool fractions = job.options.format == FileFormat::exr;
  job.image = fractions ? uv_as_fractions(uv) : uv_as_integers(uv);
  job.options.depth = fractions ? Depth::f32 : Depth::u16;
  job.options.description =
      fmt::format("uv map into an exemplar of {}x{} pixels: {}", uv->exemplar().width, uv->exemplar().height,
                  fractions ? "u = (x + 0.5) / width, v = (y + 0.5) / height, from the top left"
                            : "red = x, green = y, from the top left");
  jobs.push_back(std::move(job));
}

void add_pictures(const Report& report, const fs::path& path, std::vector<MapFileJob>& jobs) {
  for (const Report::Picture& p : report.pictures()) {
    MapFileJob job{.name = p.name, .image = p.image, .target = path};
    job.target.replace_filename(fmt::format("{}_{}.png", path.stem().string(), p.name));
    jobs.push_back(std::move(job));
  }
}

void compute_export(NodeContext& node) {
  const auto material = node.optional_input<Material>("material");
  const auto uv = node.optional_input<UvMap>("uv");
  const auto report = node.optional_input<Report>("report");
  require_some_input(material || uv || report);
  std::vector<MapFileJob> jobs;
  if (material) add_material(node, *material, jobs);
  if (uv) add_uv(node, uv, material ? material->name() : "", jobs);
  const fs::path report_path = node.text("report_path");
  if (report) {
    require_report_path(report_path);
    add_pictures(*report, report_path, jobs);
  }
  require_distinct(jobs);
  for (MapFileJob& job : jobs) stage_job(node, job);
  if (report)
    write_file(node.stage(report_path), is_csv(report_path) ? report_as_csv(*report) : report_as_json(*report));
  write_all(node, jobs);
}

/// Checks of the parameters before anything runs.
std::vector<std::string> check_export(const Params& params) {
  const auto text = [&](const char* name) { return std::get<std::string>(params.at(name)); };
  std::vector<std::string> problems;
  const auto attempt = [&](const auto& test) {
    try {
      test();
    } catch (const Error& e) {
      problems.push_back(fmt::format("\"{}\": {}", e.about(), e.what()));
    }
  };
  for (const char* param : {"path", "uv_path"}) {
    if (text(param).empty()) continue;
    attempt([&] {
      const FileFormat format = required_format(param, filled(param, text(param), {"map", "material.1001", {1, 1}}));
      if (std::string_view(param) == "path") require_depth(format, text("depth"));
    });
  }
  if (!text("report_path").empty()) attempt([&] { is_csv(text("report_path")); });
  for (std::string& p : color_space_problems(params, "color_space", "keep")) problems.push_back(std::move(p));
  return problems;
}

std::vector<Param> export_params() {
  return {
      {.name = "path",
       .type = ParamType::path,
       .fallback = "",
       .help = "File name pattern for the maps, with {map} for the map's name, and optionally {material}, {width} and "
               "{height}, and <UDIM> for the tile that a material such as wall.1002 is; {material} is then wall. The "
               "extension decides the format: png, tif or tiff, exr, jpg or jpeg, tga, tx (tiles and mip levels, for "
               "renderers). Needed if a material "
               "is connected."},
      depth_param(),
      mips_param(),
      {.name = "color_space",
       .type = ParamType::text,
       .fallback = "keep",
       .help = "The colour space that colour maps are converted to; data maps never are. \"keep\" writes sRGB and "
               "linear Rec.709 colours as applications expect them: linear in half and float, sRGB in 8 and 16 bit."},
      {.name = "normal_y",
       .type = ParamType::choice,
       .fallback = "keep",
       .help = "Green channel of normal maps: as it is (keep), up as in OpenGL, or down as in DirectX.",
       .choices = {"keep", "up", "down"}},
      {.name = "jpeg_quality",
       .type = ParamType::integer,
       .fallback = int64_t{95},
       .help = "Quality of JPEG files; lower makes smaller files with more artefacts.",
       .min = 1,
       .max = 100},
      {.name = "maps", .type = ParamType::texts, .fallback = Texts{}, .help = "The maps to write; empty for all."},
      {.name = "uv_path",
       .type = ParamType::path,
       .fallback = "",
       .help = "File name for the uv map. EXR holds float fractions u = (x + 0.5) / exemplar width and v likewise from "
               "the top; 16-bit PNG and TIFF hold the integer coordinates, x in red and y in green. Empty: `path`, "
               "with \"uv\" for the map's name."},
      {.name = "report_path",
       .type = ParamType::path,
       .fallback = "",
       .help = "File name for the report's figures, .json or .csv; its pictures are written beside it."},
  };
}

}  // namespace

NodeType export_node() {
  NodeType t;
  t.name = "export";
  t.version = 6;
  t.category = "sink";
  t.summary = "Writes maps, a uv map and a report to files";
  t.help =
      "Writes PNG (8 and 16 bit), TIFF, EXR (half and float), JPEG and TGA, strip by strip, so that results need not "
      "fit in "
      "memory. Every map keeps its depth, colour space and normal convention unless the parameters change them; values "
      "at the depth they were read are written back exactly. The description of PNG, TIFF and EXR files says which map "
      "it is, its convention, colour space and physical size, from which load_material reads it right again. Files "
      "appear complete or not at all. At least one input "
      "must be connected.";
  t.inputs = {
      {.name = "material", .type = ValueType::material, .help = "the maps to write", .optional = true},
      {.name = "uv", .type = ValueType::uv_map, .help = "a uv map to write", .optional = true},
      {.name = "report", .type = ValueType::report, .help = "a report to write", .optional = true},
  };
  t.params = export_params();
  t.persist = Persist::digest;
  t.compute = compute_export;
  t.files_read = [](const Params& p) {
    return std::get<std::string>(p.at("color_space")) == "keep" ? std::vector<fs::path>() : color_config_files();
  };
  t.memory_hint = [](const NodeContext& node) {
    const auto material = node.optional_input<Material>("material");
    constexpr size_t per_file = size_t{12} << 20;  // a strip as floats, and as the file's values
    return per_file * (1 + (material ? material->maps().size() : 0));
  };
  t.check = check_export;
  t.preflight = foresee_export;
  return t;
}

}  // namespace terrazzo
