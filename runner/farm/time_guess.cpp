#include "runner/farm/time_guess.h"

#include <algorithm>
#include <array>

namespace terrazzo {

namespace {

/// Seconds per megapixel. Measured with graphs/material.json on two busy cores: synthesis took 3.7 s at one megapixel,
/// an analysis 1 s at a quarter, writing five maps 0.5 s at one.
constexpr double of_slow = 4, of_quick = 0.5;

/// Factors for draft, normal and best, measured likewise.
constexpr std::array<double, 3> quality_factors = {0.25, 1, 1.25};

double quality_factor(const GraphNode& node) {
  const Param* param = node.type->find_param("quality");
  const auto value = node.params.find("quality");
  if (!param || param->choices.size() != quality_factors.size() || value == node.params.end()) return 1;
  const auto* name = std::get_if<std::string>(&value->second);
  const auto at = name ? std::ranges::find(param->choices, *name) : param->choices.end();
  return at == param->choices.end() ? 1 : quality_factors[size_t(at - param->choices.begin())];
}

double megapixels(const PlanShape& shape) {
  return shape.size ? double(shape.size->width) * double(shape.size->height) / 1e6 : 0;
}

}  // namespace

double guessed_seconds(const Plan& plan, const Stage& stage) {
  if (stage.expected_seconds <= 0) return 0;
  double pixels = megapixels(stage.shape);
  if (stage.type().is_sink())
    for (const int source : stage.sources) pixels = std::max(pixels, megapixels(plan.stages[size_t(source)].shape));
  const bool is_slow = stage.type().persist == Persist::payload && !stage.type().is_sink();
  return pixels * (is_slow ? of_slow * quality_factor(*stage.node) : of_quick);
}

}  // namespace terrazzo
