#include "tests/golden/record.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "core/base/error.h"

namespace terrazzo::test {

namespace {

constexpr const char* recorded_with = "# Recorded with ";
// What another decoder's rounding and another converter's curve may change.
constexpr double pixel_tolerance = 0.02;
// What decisions may do on top of it.
constexpr double decision_tolerance = 0.2;

std::string header(const std::string& kind, const std::string& libraries) {
  return fmt::format(
      "# Golden results: {}. Not to be edited by hand; made anew by tests/golden/regenerate.sh.\n"
      "# {}\n"
      "# Case (document/node; the documents are tests/golden/cases/*.json and graphs/*.json), node type, version, "
      "output\n"
      "# or file, digest of all pixels and numbers; then, for comparing within a tolerance where libraries have other\n"
      "# versions: mean, deviation, samples.\n"
      "{}{}\n",
      kind, std::string("A change here means that a node gives other results: its version has to be raised with it."),
      recorded_with, libraries);
}

std::string line_of(const GoldenLine& line) {
  const Content& c = line.content;
  return fmt::format("{} {} v{} {} {} {:.6g} {:.6g} {:.6g}\n", line.name, line.type, line.version, line.port,
                     c.digest.hex(), c.mean, c.deviation, fmt::join(c.samples, " "));
}

bool parse(const std::string& text, GoldenLine& line) {
  std::istringstream in(text);
  std::string version, digest;
  if (!(in >> line.name >> line.type >> version >> line.port >> digest >> line.content.mean >> line.content.deviation))
    return false;
  for (double v; in >> v;) line.content.samples.push_back(v);
  if (version.size() < 2 || version[0] != 'v' || !Digest::parse(digest, line.content.digest)) return false;
  line.version = std::atoi(version.c_str() + 1);
  return line.version > 0;
}

}  // namespace

const GoldenLine* GoldenFile::find(const std::string& name, const std::string& port) const {
  for (const GoldenLine& l : lines)
    if (l.name == name && l.port == port) return &l;
  return nullptr;
}

GoldenFile read_golden(const std::filesystem::path& path) {
  GoldenFile out;
  std::ifstream in(path);
  std::string text;
  for (int number = 1; std::getline(in, text); number++) {
    if (text.starts_with(recorded_with)) out.libraries = text.substr(std::string(recorded_with).size());
    if (text.empty() || text[0] == '#') continue;
    GoldenLine line;
    if (!parse(text, line))
      throw Error("golden", fmt::format("{}:{}: not a line of a golden file; run tests/golden/regenerate.sh",
                                        path.string(), number));
    out.lines.push_back(std::move(line));
  }
  return out;
}

std::map<std::string, GoldenFile> read_golden_files(const std::filesystem::path& folder) {
  std::map<std::string, GoldenFile> out;
  for (const char* file : {"source", "image", "analysis", "synthesis", "sink", "graphs"})
    out[file] = read_golden(folder / (std::string(file) + ".txt"));
  return out;
}

void write_golden(const std::filesystem::path& path, const GoldenFile& file) {
  std::ofstream out(path);
  out << header(path.stem().string(), file.libraries);
  for (const GoldenLine& l : file.lines) out << line_of(l);
  if (!out.flush()) throw Error("golden", "cannot write " + path.string());
}

bool nearly_same(const Content& a, const Content& b, bool pixelwise) {
  if (a.samples.size() != b.samples.size()) return false;
  const double scale = std::max({std::abs(a.mean), a.deviation, std::abs(b.mean), b.deviation, 1e-9});
  const double tolerance = (pixelwise ? pixel_tolerance : decision_tolerance) * scale;
  const auto near = [&](double x, double y) { return std::abs(x - y) <= tolerance; };
  if (!near(a.mean, b.mean) || !near(a.deviation, b.deviation)) return false;
  return !pixelwise || std::equal(a.samples.begin(), a.samples.end(), b.samples.begin(), near);
}

}  // namespace terrazzo::test
