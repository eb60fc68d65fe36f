#include "core/analysis/repeats/through_lines.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/base/tuning.h"
#include "core/numeric/eigen.h"

namespace terrazzo {

namespace {

struct ThroughLinesTuning {
  double least_change = 2.5;
};
const Tunable<ThroughLinesTuning> through_lines_tuning(
    "through_lines",
    {{&ThroughLinesTuning::least_change, "least_change", "mean changes",
      "that each eighth of a line must differ from the one beside it by. Higher: thin joints are torn; "
      "lower: grain is laid in bands",
      "through_lines"}});

constexpr int parts = 8;

using Means = Eigen::MatrixXd;  // of one line: a column for each part, a row for each channel

Means means_of_line(const Planes& planes, bool rows, int line) {
  const int length = rows ? planes.size.width : planes.size.height;
  Means out = Means::Zero(planes.channels, parts);
  for (int part = 0; part < parts; part++) {
    const int from = length * part / parts, to = length * (part + 1) / parts;
    for (int i = from; i < to; i++) {
      const float* values = rows ? planes.at(i, line) : planes.at(line, i);
      for (int c = 0; c < planes.channels; c++) out(c, part) += values[c];
    }
    out.col(part) /= to - from;
  }
  return out;
}

}  // namespace

double strongest_line(const Planes& planes, bool rows) {
  const int lines = rows ? planes.size.height : planes.size.width;
  if (std::min(planes.size.width, planes.size.height) < parts) return 0;
  std::vector<Means> changes;
  const Means first = means_of_line(planes, rows, 0);
  Means before = first;
  for (int line = 1; line < lines; line++) {
    Means now = means_of_line(planes, rows, line);
    changes.push_back(now - before);
    before = std::move(now);
  }
  if (planes.wraps) changes.push_back(first - before);
  Eigen::RowVectorXd usual = Eigen::RowVectorXd::Zero(parts);
  for (const Means& change : changes) usual += change.colwise().norm() / double(changes.size());
  double strongest = 0;
  for (const Means& change : changes) {
    const VectorXd along = change.rowwise().sum().normalized();
    const Eigen::RowVectorXd each = (along.transpose() * change).cwiseQuotient(usual);
    if (each.allFinite()) strongest = std::max(strongest, each.minCoeff());
  }
  return strongest / through_lines_tuning->least_change;
}

}  // namespace terrazzo
