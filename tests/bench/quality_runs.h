#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/image/image.h"
#include "core/metrics/quality.h"

/// What the benchmarks of quality share: exemplars to try, and runs of graphs/texture.json that are scored.
namespace terrazzo::bench {

/// A figure, and its column in a table.
struct Column {
  std::string name;
  double QualityFigures::*figure;
  int decimals;
};
const std::vector<Column>& columns();

/// One row of a table: figures by the names of columns, and the "seconds" of CPU time that the run took, if it is
/// known.
using Row = std::map<std::string, double>;

struct Case {
  std::string name;
  std::filesystem::path image;
};

/// A program with terrazzo's command line.
struct Program {
  std::filesystem::path path;
  std::filesystem::path source;             ///< the project's folder, for its graphs
  std::vector<std::string> arguments = {};  ///< that come first
};

/// Reads a picture as a base colour. Throws Error.
ImagePtr read(const std::filesystem::path& path);
void write(const ImagePtr& image, const std::filesystem::path& path);

/// The exemplars of a folder, images or folders of maps, at 256 pixels or less: as they are in `peers`, or reduced into
/// `out`. If there is no such folder, every pattern that the program generates. Throws Error if there are none.
std::vector<Case> find_cases(const Program& program, const std::filesystem::path& exemplars,
                             const std::filesystem::path& peers, const std::filesystem::path& out);

/// All columns of a result.
Row scored(const ImagePtr& exemplar, const ImagePtr& output);

struct Result {
  ImagePtr exemplar, output;
  Row row;
};

/// Makes twice as much of an exemplar in both directions, writes it to a folder and scores it. Throws Error.
Result synthesize(const Case& c, const Program& program, int seed, const std::filesystem::path& folder);

}  // namespace terrazzo::bench
