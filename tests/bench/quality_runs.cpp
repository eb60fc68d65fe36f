#include "tests/bench/quality_runs.h"

#include <algorithm>
#include <cstdlib>
#include <optional>

#include <fmt/format.h>
#include <sys/resource.h>

#include "core/analysis/repeats/wrap_detection.h"
#include "core/base/error.h"
#include "core/image_io/image_file.h"
#include "core/material/material.h"
#include "core/metrics/quality.h"
#include "nodes/common/registry.h"

namespace fs = std::filesystem;

namespace terrazzo::bench {

namespace {

constexpr int exemplar_side = 256;  ///< larger exemplars are reduced to this

std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

void run(const std::vector<std::string>& arguments) {
  std::string command;
  for (const std::string& a : arguments) command += quoted(a) + " ";
  if (std::system((command + ">&2").c_str()) != 0) throw Error(fmt::format("this failed: {}", command));
}

/// CPU seconds of the programs that have run so far.
double seconds_of_programs() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

std::vector<fs::path> sorted_entries(const fs::path& folder) {
  std::vector<fs::path> out;
  for (const auto& entry : fs::directory_iterator(folder)) out.push_back(entry.path());
  std::sort(out.begin(), out.end());
  return out;
}

/// The base colour in a folder of maps; nullopt if there is none.
std::optional<fs::path> base_color_of(const fs::path& folder) {
  for (const fs::path& path : sorted_entries(folder)) {
    std::string name = path.stem().string();
    name.erase(std::remove(name.begin(), name.end(), '_'), name.end());
    if (looks_like_image(path) && name == "basecolor") return path;
  }
  return std::nullopt;
}

/// The exemplar at the size that is compared: the peers' input if it is there, else the image, reduced if it is larger.
Case sized_case(const std::string& name, const fs::path& image, const fs::path& peers, const fs::path& out) {
  const fs::path given = peers / "exemplars256" / (name + ".png");
  if (fs::exists(given)) return {name, given};
  const ImagePtr picture = read(image);
  const int side = std::max(picture->width(), picture->height());
  if (side <= exemplar_side) return {name, image};
  const auto reduced = [&](int length) { return std::max(1, length * exemplar_side / side); };
  const Size size{reduced(picture->width()), reduced(picture->height())};
  const int channels = picture->channels() >= 3 ? 3 : 1;
  ImageInfo info = picture->info();
  info.size = size;
  info.channels = channels;
  const fs::path target = out / "exemplars" / (name + ".png");
  write(Image::from_floats(info, resampled(to_planes(*picture, whole(picture->size()), channels), size).values),
        target);
  return {name, target};
}

/// Every kind of surface that the pattern node knows.
std::vector<Case> procedural_cases(const fs::path& program, const fs::path& source, const fs::path& out) {
  std::vector<Case> cases;
  const NodeType* pattern = find_node_type("pattern");
  if (!pattern) throw Error("no folder of exemplars, and no pattern node to make some; set TERRAZZO_EXEMPLARS");
  const auto kinds = std::find_if(pattern->params.begin(), pattern->params.end(),
                                  [](const Param& p) { return p.type == ParamType::choice; });
  for (const std::string& kind : kinds->choices) {
    const fs::path folder = out / "exemplars" / kind;
    run({program, "run", source / "graphs/generate-exemplar.json", "--set", "type=" + kind, "--set",
         fmt::format("size={0}x{0}", exemplar_side), "--set", "out=" + folder.string()});
    if (const auto image = base_color_of(folder)) cases.push_back({kind, *image});
  }
  return cases;
}

std::vector<Case> photographed_cases(const fs::path& folder, const fs::path& peers, const fs::path& out) {
  std::vector<Case> cases;
  for (const fs::path& path : sorted_entries(folder)) {
    if (fs::is_directory(path)) {
      if (const auto image = base_color_of(path)) cases.push_back(sized_case(path.filename(), *image, peers, out));
    } else if (looks_like_image(path)) {
      cases.push_back(sized_case(path.stem(), path, peers, out));
    }
  }
  return cases;
}

/// The picture that a run wrote.
fs::path result_in(const fs::path& folder) {
  if (const auto image = base_color_of(folder)) return *image;
  for (const fs::path& path : sorted_entries(folder))
    if (looks_like_image(path)) return path;
  throw Error(fmt::format("graphs/texture.json wrote no image to {}", folder.string()));
}

}  // namespace

const std::vector<Column>& columns() {
  static const std::vector<Column> all = {{"swd", &QualityFigures::swd, 4},
                                          {"coherence", &QualityFigures::coherence, 3},
                                          {"complete", &QualityFigures::completeness, 3},
                                          {"acf", &QualityFigures::acf, 4},
                                          {"broken", &QualityFigures::broken, 4},
                                          {"verbatim", &QualityFigures::verbatim, 3},
                                          {"repeat", &QualityFigures::repeat, 3},
                                          {"structure", &QualityFigures::structure, 3},
                                          {"cooccur", &QualityFigures::cooccurrence, 4}};
  return all;
}

ImagePtr read(const fs::path& path) {
  return read_image(path, {.size = {}, .semantic = Semantic::base_color, .color_space = "srgb_texture"},
                    [&](const std::string& text) { fmt::print(stderr, "{}: {}\n", path.string(), text); });
}

void write(const ImagePtr& image, const fs::path& path) {
  fs::create_directories(path.parent_path());
  write_image(*image, path, {}, [](double) {});
}

std::vector<Case> find_cases(const Program& program, const fs::path& exemplars, const fs::path& peers,
                             const fs::path& out) {
  std::vector<Case> cases = fs::is_directory(exemplars) ? photographed_cases(exemplars, peers, out)
                                                        : procedural_cases(program.path, program.source, out);
  if (cases.empty()) throw Error(fmt::format("no exemplars in {}", exemplars.string()));
  return cases;
}

Row scored(const ImagePtr& exemplar, const ImagePtr& output) {
  const MaterialPtr material = Material::of(exemplar);
  ComparedPlanes planes = compared_planes(*material, *Material::of(output), {});
  planes.exemplar.wraps = seems_to_tile(*material, Task());
  const QualityFigures q = measure_quality(std::move(planes.exemplar), std::move(planes.output), {}, Task());
  Row row;
  for (const Column& column : columns()) row[column.name] = q.*column.figure;
  return row;
}

Result synthesize(const Case& c, const Program& program, int seed, const fs::path& folder) {
  Result result{.exemplar = read(c.image), .output = nullptr, .row = {}};
  const Size size{2 * result.exemplar->width(), 2 * result.exemplar->height()};
  std::vector<std::string> command = {program.path};
  command.insert(command.end(), program.arguments.begin(), program.arguments.end());
  for (const std::string& word :
       {std::string("run"), (program.source / "graphs/texture.json").string(), std::string("--no-cache"),
        std::string("--progress"), std::string("none"), std::string("--set"), "image=" + c.image.string(),
        std::string("--set"), fmt::format("size={}x{}", size.width, size.height), std::string("--set"),
        fmt::format("seed={}", seed), std::string("--set"), "out=" + folder.string()})
    command.push_back(word);
  const double before = seconds_of_programs();
  run(command);
  const double seconds = seconds_of_programs() - before;
  result.output = read(result_in(folder));
  result.row = scored(result.exemplar, result.output);
  result.row["seconds"] = seconds;
  return result;
}

}  // namespace terrazzo::bench
