#include "nodes/common/synthesis/synthesis_params.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/image/image_facts.h"
#include "core/synthesis/state/jitter.h"
#include "core/synthesis/steps.h"
#include "nodes/common/shape_rules.h"
#include "nodes/common/synthesis/wrapping_size.h"

namespace terrazzo {

namespace {

/// In the order of JitterSpec::Shape.
const std::vector<std::string> shape_names = {"automatic", "list", "constant", "peak", "rising", "falling"};

JitterSpec jitter_spec(const NodeContext& node) {
  const auto shape = std::find(shape_names.begin(), shape_names.end(), node.text("jitter_shape"));
  return {static_cast<JitterSpec::Shape>(shape - shape_names.begin()), node.numbers("jitter"),
          node.number("jitter_peak"), node.number("jitter_spread")};
}

const std::vector<Param>& shared_params() {
  static const std::vector<Param> params = {
      {.name = "seed",
       .type = ParamType::integer,
       .fallback = 1,
       .help = "Another number gives another arrangement of the same material.",
       .min = 0},
      {.name = "quality",
       .type = ParamType::choice,
       .fallback = "normal",
       .help = "Passes and candidates per level. draft takes about half the time of normal; best takes nearly twice as "
               "long, with more passes at the finest levels.",
       .choices = {quality_names.begin(), quality_names.end()}},
      {.name = "coherence",
       .type = ParamType::number,
       .fallback = 0.7,
       .help = "Cost of continuing a neighbouring piece of the exemplar. Lower values copy larger pieces: more "
               "faithful, less varied.",
       .min = 0.05,
       .max = 1},
      {.name = "evenness",
       .type = ParamType::number,
       .fallback = 0.7,
       .help = "Penalty on parts of the exemplar that are used too often or already appear nearby. Higher values "
               "repeat less; 0 lets the best-fitting parts repeat.",
       .min = 0,
       .max = 10},
      {.name = "jitter",
       .type = ParamType::numbers,
       .fallback = Numbers{},
       .help = "Random displacement per level, coarsest level first. More gives more variety and less structure. One "
               "number applies to every level; levels not listed get none.",
       .min = 0,
       .max = 1024,
       .unit = "pixels of the level"},
      {.name = "jitter_shape",
       .type = ParamType::choice,
       .fallback = "automatic",
       .help = "How \"jitter\" is spread over the levels. automatic and list are the same: as given, and none if it is "
               "empty. The others take one number: constant at every level, peak as a Gaussian around "
               "\"jitter_peak\", rising only up to the peak, falling only from it on.",
       .choices = shape_names},
      {.name = "jitter_peak",
       .type = ParamType::number,
       .fallback = 0.0,
       .help = "For peak, rising and falling: the level with the full jitter; 0 is the coarsest.",
       .min = 0,
       .max = 16,
       .unit = "levels"},
      {.name = "jitter_spread",
       .type = ParamType::number,
       .fallback = 1.0,
       .help = "For peak, rising and falling: the Gaussian's standard deviation. Higher values spread jitter over more "
               "levels.",
       .min = 0.1,
       .max = 16,
       .unit = "levels"},
  };
  return params;
}

}  // namespace

Port index_port() {
  return {.name = "index", .type = ValueType::index, .help = "the analysed exemplar"};
}

Port uv_output() {
  return {.name = "uv", .type = ValueType::uv_map, .help = "the exemplar pixel of every output pixel"};
}

Param result_size_param() {
  return {.name = "size",
          .type = ParamType::size,
          .fallback = Size{1024, 1024},
          .help = "Size of the result.",
          .min = 1,
          .max = 32768,
          .unit = "pixels"};
}

Param surface_param(std::string name, std::string help, int least) {
  return {.name = std::move(name),
          .type = ParamType::size,
          .fallback = least > 0 ? Size{8192, 8192} : Size{0, 0},
          .help = std::move(help),
          .min = least,
          .max = largest_surface,
          .unit = "pixels"};
}

Param tileable_param() {
  return {.name = "tileable",
          .type = ParamType::choice,
          .fallback = "none",
          .help = "Directions in which the result wraps around without a seam.",
          .choices = {"none", "x", "y", "xy"}};
}

Param whole_bricks_param() {
  return {.name = "whole_bricks",
          .type = ParamType::boolean,
          .fallback = true,
          .help =
              "For walls and floors of which the analysis knows the elements (node `elements`): lays whole bricks, "
              "boards, stones, slates and tiles. Not in drafts. false gives fewer new combinations and cuts some of "
              "them."};
}

Param whole_bricks_between_kept_param() {
  Param p = whole_bricks_param();
  p.help =
      "For walls and floors of which the analysis knows the elements (node `elements`): lays whole bricks, boards, "
      "stones, slates and tiles; those that are kept in part go on beyond. Not in drafts. false cuts some of them.";
  return p;
}

std::vector<Param> with_synthesis_params(std::vector<Param> own) {
  own.insert(own.end(), shared_params().begin(), shared_params().end());
  return own;
}

std::vector<std::string> check_synthesis_params(const Params& params) {
  const std::string& shape = std::get<std::string>(params.at("jitter_shape"));
  const size_t given = std::get<Numbers>(params.at("jitter")).size();
  if (shape == "automatic" || shape == "list" || given == 1) return {};
  return {
      fmt::format("\"jitter\": expected one number to spread over the levels, since jitter_shape is \"{}\"; found {}",
                  shape, given)};
}

SynthesisOptions synthesis_options(const NodeContext& node, const Index& index) {
  SynthesisOptions options;
  options.size = node.type().find_param("size") ? node.size("size") : index.appearance()->size();
  if (node.type().find_param("tileable")) {
    const std::string& tileable = node.text("tileable");
    options.tile_x = tileable == "x" || tileable == "xy";
    options.tile_y = tileable == "y" || tileable == "xy";
  }
  if (node.type().find_param("whole_bricks")) options.whole_bricks = node.flag("whole_bricks");
  options.seed = uint64_t(node.integer("seed"));
  const auto quality = std::find(quality_names.begin(), quality_names.end(), node.text("quality"));
  options.quality = static_cast<Quality>(quality - quality_names.begin());
  options.coherence = node.number("coherence");
  options.evenness = node.number("evenness");
  options.jitter = jitter_amplitudes(jitter_spec(node), *index.appearance());
  return options;
}

void require_same_exemplar(const InputForecasts& inputs) {
  const Forecast *uv = forecast_at(inputs, "uv"), *index = forecast_at(inputs, "index");
  if (!uv || !index || !uv->exemplar || !index->size || *uv->exemplar == *index->size) return;
  throw Error("uv", fmt::format("expected a uv map for the exemplar of \"index\", {}, found one for an exemplar of {}",
                                describe(*index->size), describe(*uv->exemplar)));
}

void warn_unless_repeats_fit(NodeContext& node, const Index& index, const SynthesisOptions& options,
                             std::string_view consequence) {
  if (!options.tile_x && !options.tile_y) return;
  if (repeats_fit(*index.appearance(), options)) return;
  const Lattice lattice = repeats_in_result(*index.appearance(), options).lattice;
  SynthesisOptions other = options;
  other.kept = {};
  const auto fits = [&](Size size) {
    other.size = size;
    return repeats_fit(*index.appearance(), other);
  };
  std::string advice = "no size near it would";
  // The smaller the allowed distortion, the closer the size must be to whole repeats.
  for (const int part : {1, 4, 16}) {
    const Size slack{std::max(1, options.size.width / part), std::max(1, options.size.height / part)};
    const Size would = best_wrapping_size(lattice, options.size, options.tile_x, options.tile_y, slack);
    if (!fits(would)) continue;
    advice = fmt::format("{} would", describe(would));
    break;
  }
  node.warn(fmt::format("{} does not hold a whole number of the exemplar's repeats, so that {}; {}",
                        describe(options.size), consequence, advice));
}

void warn_of_less_surface(NodeContext& node, const Index& index, Size result) {
  const Size exemplar = index.appearance()->size();
  const bool is_one_part = index.appearance()->repeats().parts.size() < 2;
  if (is_one_part && result.width < exemplar.width && result.height < exemplar.height)
    node.warn(fmt::format("the result, {}, shows less surface than the exemplar, {}; give it a larger size",
                          describe(result), describe(exemplar)));
}

void tell_of_parts(NodeContext& node, const Index& index, const UvMap& result, bool all_expected) {
  constexpr size_t most_listed = 8;
  const std::vector<LatticePart>& parts = index.appearance()->repeats().parts;
  if (parts.size() < 2) return;
  std::vector<int64_t> counts(parts.size(), 0);
  size_t part = 0;  // neighbouring pixels mostly show the same part
  for (const ExemplarPixel& p : result.pixels()) {
    const auto shows = [&](const LatticePart& l) { return contains(l.place, p.x, p.y); };
    if (!shows(parts[part]))
      part = std::min(parts.size() - 1, size_t(std::ranges::find_if(parts, shows) - parts.begin()));
    counts[part]++;
  }
  std::string shares, unused;
  int64_t area = 0;
  for (size_t i = 0; i < parts.size(); i++) {
    area += parts[i].place.area();
    if (counts[i] == 0) unused += fmt::format("{}{}", unused.empty() ? "" : ", ", i + 1);
    if (i < most_listed)
      shares += fmt::format("{}exemplar {} in {:.0f} %", i > 0 ? ", " : "", i + 1,
                            100.0 * double(counts[i]) / double(result.size().area()));
  }
  node.note(fmt::format("the result shows {}{}", shares, parts.size() > most_listed ? ", and others" : ""));
  if (!all_expected || unused.empty() || result.size().area() < area)
    return;  // a small result has no room for all parts
  node.warn(
      fmt::format("the result shows nothing of exemplar {}, which does not fit the others; try another seed, or place "
                  "it with a mix map (graphs/mix.json)",
                  unused));
}

ImagePtr new_pixels_mask(const UvMap& result, const ExistingPixels& kept) {
  std::vector<float> mask;
  mask.reserve(kept.keep.size());
  for (size_t i = 0; i < kept.keep.size(); i++)
    mask.push_back(kept.keep[i] == Keep::never || result.pixels()[i] != kept.pixels[i] ? 1.0f : 0.0f);
  return Image::from_floats({.size = result.size(), .semantic = Semantic::mask, .depth = Depth::u8}, std::move(mask));
}

}  // namespace terrazzo
