#include "nodes/sink/map_files.h"

#include <algorithm>
#include <map>
#include <mutex>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/parallel_for.h>

#include "core/base/paths.h"
#include "core/filter/mip_levels.h"
#include "core/filter/opacity_weights.h"

namespace terrazzo {

namespace fs = std::filesystem;

namespace {

std::optional<Depth> depth_from(const std::string& name) {
  for (const Depth d : {Depth::u8, Depth::u16, Depth::f16, Depth::f32})
    if (name == name_of(d)) return d;
  return std::nullopt;
}

std::string depths_of(FileFormat format) {
  std::vector<std::string_view> names;
  for (const Depth d : {Depth::u8, Depth::u16, Depth::f16, Depth::f32})
    if (holds(format, d)) names.push_back(name_of(d));
  return fmt::format("{}", fmt::join(names, ", "));
}

/// The format's depth nearest to the map's, lossless if there is one. Half floats in TIFF are written only on request:
/// many programs, including Blender, read them as noise or not at all.
Depth nearest_depth(FileFormat format, Depth have) {
  if (format == FileFormat::tiff && have == Depth::f16) return Depth::f32;
  if (holds(format, have)) return have;
  switch (format) {
    case FileFormat::png:
      return Depth::u16;
    case FileFormat::jpeg:
    case FileFormat::tga:
      return Depth::u8;
    case FileFormat::exr:
      return have == Depth::u8 ? Depth::f16 : Depth::f32;
    case FileFormat::tiff:
    case FileFormat::tx:
      break;
  }
  return have;
}

bool loses(Depth have, Depth written) {
  return have != written && !(have == Depth::u8) && written != Depth::f32;
}

/// A warning, or a note if it may be just filter overshoot.
void tell_of_clipping(NodeContext& node, const MapFileJob& job) {
  constexpr float overshoot = 0.01f;
  const Clipping& c = job.clipped;
  if (c.values == 0) return;
  const std::string what = fmt::format(
      "{}: {:.3g} % of its values lie outside 0..1 (from {:.4g} to {:.4g}) and were "
      "clipped by {}",
      job.name, 100.0 * double(c.values) / double(c.all), c.least, c.most, name_of(job.options.depth));
  if (c.least >= -overshoot && c.most <= 1 + overshoot)
    node.note(what);
  else
    node.warn(what +
              "; write it as .exr, which keeps them, or bring them into 0..1 before, with \"normalize\" or "
              "\"levels\"");
}

}  // namespace

Param depth_param() {
  return {.name = "depth",
          .type = ParamType::choice,
          .fallback = "keep",
          .help =
              "Bit depth. \"keep\": each map's own, or the nearest that the format holds; half maps become "
              "float in TIFF files, as few programs read halfs there.",
          .choices = {"keep", "uint8", "uint16", "half", "float"}};
}

void require_depth(FileFormat format, const std::string& depth) {
  const std::optional<Depth> wanted = depth_from(depth);
  if (wanted && !holds(format, *wanted))
    throw Error("depth", fmt::format("{} files hold {}, not {}; TIFF holds all depths", name_of(format),
                                     depths_of(format), depth));
}

Depth written_depth(FileFormat format, const std::string& wanted, Depth have) {
  return depth_from(wanted).value_or(nearest_depth(format, have));
}

Param mips_param() {
  return {.name = "mips",
          .type = ParamType::boolean,
          .fallback = false,
          .help =
              "Also writes the levels of a mip chain, as files that end in .mip1, .mip2 and so on before the "
              "extension. Colours are averaged in linear light and by the material's opacity, normals are made unit "
              "length again, masks and labels are sampled. TX files hold them in any case."};
}

fs::path mip_file(fs::path file, int level) {
  const std::string extension = file.extension().string();
  return file.replace_extension(fmt::format(".mip{}{}", level, extension));
}

void stage_job(NodeContext& node, MapFileJob& job) {
  job.temporary = node.stage(job.target);
  if (!job.has_levels || job.options.format == FileFormat::tx) return;
  for (int level = 1; level < mip_level_count(job.image->size()); level++)
    job.level_temporaries.push_back(node.stage(mip_file(job.target, level)));
}

void weigh_levels(NodeContext& node, MapFileJob& job, const ImagePtr& opacity) {
  if (!job.has_levels && job.options.format != FileFormat::tx) return;
  job.weights = opacity_weights(job.image, opacity);
  if (job.weights) node.note(fmt::format("{}: colours count by their opacity in mip levels", job.name));
}

void tell_of_losses(NodeContext& node, const MapFileJob& job, bool depth_was_asked_for) {
  const Depth have = job.image->info().depth;
  if (loses(have, job.options.depth))
    node.note(fmt::format(
        "{}: {} values are written as {}{}", job.name, name_of(have), name_of(job.options.depth),
        depth_was_asked_for ? "" : fmt::format(", the nearest that {} holds", name_of(job.options.format))));
  if (job.options.format == FileFormat::jpeg && job.image->channels() % 2 == 0)
    node.note(fmt::format("{}: alpha is left out, as JPEG has no alpha channel", job.name));
}

void require_distinct(const std::vector<MapFileJob>& jobs) {
  std::map<fs::path, std::string> names;
  for (const MapFileJob& job : jobs) {
    const auto [at, is_new] = names.emplace(place_of_file(job.target), job.name);
    if (!is_new)
      throw Error("path",
                  fmt::format("{} and {} would both be written to {}", at->second, job.name, job.target.string()));
  }
}

namespace {

/// Writes the file, and its mip levels into it or into files of their own.
void write_job(MapFileJob& job, const std::function<void(double)>& progress) {
  const bool has_levels = job.options.format == FileFormat::tx || !job.level_temporaries.empty();
  std::vector<ImagePtr> levels = has_levels ? mip_levels(job.image, job.weights) : std::vector{job.image};
  const ImagePtr image = levels.front();
  levels.erase(levels.begin());
  if (job.options.format == FileFormat::tx) job.options.levels = levels;
  job.clipped = write_image(*image, job.temporary, job.options, progress);
  for (size_t i = 0; i < job.level_temporaries.size(); i++)
    write_image(*levels[i], job.level_temporaries[i], job.options, [](double) {});
  job.options.levels.clear();
}

}  // namespace

void write_all(NodeContext& node, std::vector<MapFileJob>& jobs) {
  std::mutex mutex;
  std::vector<double> done(jobs.size());
  tbb::parallel_for(size_t{0}, jobs.size(), [&](size_t i) {
    write_job(jobs[i], [&](double fraction) {
      double sum = 0;
      {
        const std::lock_guard lock(mutex);
        done[i] = fraction;
        for (const double d : done) sum += d;
      }
      node.task().progress(sum / double(jobs.size()));
    });
  });
  for (const MapFileJob& job : jobs) tell_of_clipping(node, job);
}

}  // namespace terrazzo
