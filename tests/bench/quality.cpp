// Scores graphs/texture.json on many exemplars; tests/bench/quality builds and starts this.

#include "core/metrics/quality.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>

#include <fmt/format.h>

#include "core/image/image_file.h"
#include "core/picture/contact_sheet.h"
#include "nodes/common/registry.h"

namespace fs = std::filesystem;
using namespace terrazzo;

namespace {

constexpr int exemplar_side = 256;  ///< larger exemplars are reduced to this
constexpr int sheet_side = 1600;

/// A figure, and its column in a peer's table.
struct Column {
  std::string name;
  double Quality::*figure;
  int decimals;
};
const std::vector<Column> columns = {
    {"swd", &Quality::swd, 4},       {"coherence", &Quality::coherence, 3}, {"complete", &Quality::completeness, 3},
    {"acf", &Quality::acf, 4},       {"broken", &Quality::broken, 4},       {"verbatim", &Quality::verbatim, 3},
    {"repeat", &Quality::repeat, 3}, {"cooccur", &Quality::cooccurrence, 4}};

/// One row of the table; figures that are not known are left out.
using Row = std::map<std::string, double>;
/// Rows by exemplar, then by tool.
using Scores = std::map<std::string, std::map<std::string, Row>>;

struct Case {
  std::string name;
  fs::path image;
};

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

ImagePtr read(const fs::path& path) {
  return read_image(path, {.size = {}, .semantic = Semantic::base_color, .color_space = "srgb_texture"},
                    [&](const std::string& text) { fmt::print(stderr, "{}: {}\n", path.string(), text); });
}

void write(const ImagePtr& image, const fs::path& path) {
  fs::create_directories(path.parent_path());
  write_image(*image, path, {}, [](double) {});
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

std::vector<Case> find_cases(const fs::path& folder, const fs::path& peers, const fs::path& out) {
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

/// A table "exemplar,tool,figure...", if there is one.
Scores read_peers(const fs::path& file) {
  Scores scores;
  std::ifstream in(file);
  std::vector<std::string> names;
  for (std::string line; std::getline(in, line);) {
    std::vector<std::string> cells;
    std::istringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
    if (names.empty()) {
      names = cells;
      continue;
    }
    for (size_t i = 2; i < std::min(cells.size(), names.size()); i++)
      scores[cells[0]][cells[1]][names[i]] = std::strtod(cells[i].c_str(), nullptr);
  }
  return scores;
}

/// The picture that a run wrote.
fs::path result_in(const fs::path& folder) {
  if (const auto image = base_color_of(folder)) return *image;
  for (const fs::path& path : sorted_entries(folder))
    if (looks_like_image(path)) return path;
  throw Error(fmt::format("graphs/texture.json wrote no image to {}", folder.string()));
}

struct Result {
  ImagePtr exemplar, output;
  Row row;
};

Result synthesize(const Case& c, const fs::path& program, const fs::path& source, const fs::path& out) {
  Result result{.exemplar = read(c.image), .output = nullptr, .row = {}};
  const Size size{2 * result.exemplar->width(), 2 * result.exemplar->height()};
  const fs::path folder = out / "results" / c.name;
  const auto start = std::chrono::steady_clock::now();
  run({program, "run", source / "graphs/texture.json", "--no-cache", "--progress", "none", "--set",
       "image=" + c.image.string(), "--set", fmt::format("size={}x{}", size.width, size.height), "--set",
       "out=" + folder.string()});
  result.row["seconds"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  result.output = read(result_in(folder));
  ComparedPlanes planes = compared_planes(*Material::of(result.exemplar), *Material::of(result.output), {});
  const Quality q = measure_quality(std::move(planes.exemplar), std::move(planes.output), {}, Task());
  for (const Column& column : columns) result.row[column.name] = q.*column.figure;
  return result;
}

void print_row(const std::string& name, const std::string& tool, const Row& row) {
  fmt::print("{:<38} {:<11}", name, tool);
  for (const Column& c : columns) {
    const auto at = row.find(c.name);
    fmt::print(" {:>9}", at == row.end() ? "-" : fmt::format("{:.{}f}", at->second, c.decimals));
  }
  const auto seconds = row.find("seconds");
  fmt::print(" {:>7}\n", seconds == row.end() ? "-" : fmt::format("{:.2f}", seconds->second));
}

void print_means(const Scores& scores) {
  std::map<std::string, std::vector<const Row*>> by_tool;
  for (const auto& [name, tools] : scores)
    for (const auto& [tool, row] : tools) by_tool[tool].push_back(&row);
  for (const auto& [tool, rows] : by_tool) {
    Row mean;
    for (const Row* row : rows)
      for (const auto& [figure, value] : *row) mean[figure] += value / double(rows.size());
    print_row(fmt::format("mean of {}", rows.size()), tool, mean);
  }
}

/// The exemplar, what each peer made of it, and our result.
std::vector<ImagePtr> sheet_row(const Case& c, const Result& result, const fs::path& peers,
                                const std::vector<std::string>& tools) {
  std::vector<ImagePtr> row = {result.exemplar};
  for (const std::string& tool : tools) {
    const fs::path path = peers / tool / (c.name + ".png");
    row.push_back(fs::exists(path) ? read(path) : nullptr);
  }
  row.push_back(result.output);
  return row;
}

int score_all(const fs::path& program, const fs::path& source, const fs::path& exemplars, const fs::path& out,
              const std::vector<std::string>& only) {
  const fs::path peers = exemplars / "../peers";
  const Scores peer_scores = read_peers(peers / "scores.csv");
  std::vector<Case> cases =
      fs::is_directory(exemplars) ? find_cases(exemplars, peers, out) : procedural_cases(program, source, out);
  if (!only.empty())
    std::erase_if(cases, [&](const Case& c) { return std::find(only.begin(), only.end(), c.name) == only.end(); });
  if (cases.empty()) throw Error(fmt::format("no exemplars in {}", exemplars.string()));
  std::map<std::string, bool> tool_names;
  for (const Case& c : cases)
    if (const auto at = peer_scores.find(c.name); at != peer_scores.end())
      for (const auto& [tool, row] : at->second) tool_names[tool] = true;
  std::vector<std::string> tools;
  for (const auto& [tool, present] : tool_names) tools.push_back(tool);

  fmt::print("{:<38} {:<11}", "exemplar", "tool");
  for (const Column& c : columns) fmt::print(" {:>9}", c.name);
  fmt::print(" {:>7}\n", "seconds");
  Scores scores;
  std::vector<std::vector<ImagePtr>> sheet;
  int failures = 0;
  for (const Case& c : cases) {
    try {
      const Result result = synthesize(c, program, source, out);
      if (const auto at = peer_scores.find(c.name); at != peer_scores.end()) scores[c.name] = at->second;
      scores[c.name]["terrazzo"] = result.row;
      for (const auto& [tool, row] : scores[c.name]) print_row(c.name, tool, row);
      std::fflush(stdout);
      sheet.push_back(sheet_row(c, result, peers, tools));
      write(contact_sheet({sheet.back()}, 2 * sheet_side), out / "sheets" / (c.name + ".png"));
    } catch (const Error& e) {
      fmt::print(stderr, "{}: {}\n", c.name, e.what());
      failures++;
    }
  }
  print_means(scores);
  constexpr size_t rows_per_sheet = 6;
  for (size_t first = 0; first < sheet.size(); first += rows_per_sheet) {
    const std::vector<std::vector<ImagePtr>> rows(
        sheet.begin() + std::ptrdiff_t(first),
        sheet.begin() + std::ptrdiff_t(std::min(sheet.size(), first + rows_per_sheet)));
    write(contact_sheet(rows, sheet_side), out / fmt::format("sheet{}.png", first / rows_per_sheet + 1));
  }
  fmt::print(stderr, "contact sheets are in {}\n", out.string());
  return failures > 0 ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5) {
    fmt::print(stderr, "usage: terrazzo_quality PROGRAM SOURCE EXEMPLARS OUT [NAME]...\n");
    return 2;
  }
  try {
    return score_all(fs::absolute(argv[1]), argv[2], argv[3], argv[4], {argv + 5, argv + argc});
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 1;
  }
}
