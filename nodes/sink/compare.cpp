#include "nodes/sink/compare.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/metrics/hybrids.h"
#include "core/metrics/layout.h"
#include "core/metrics/quality.h"
#include "core/metrics/wrap_seam.h"
#include "core/node/node.h"
#include "core/picture/contact_sheet.h"
#include "nodes/common/node_helpers.h"
#include "nodes/common/shape_rules.h"

namespace terrazzo {

namespace {

/// Six decimals: all significant digits, and the same text on every machine.
double rounded(double v) {
  return std::round(v * 1e6) / 1e6;
}

struct MeasuredResult {
  const QualityFigures& quality;
  const LayoutFigures* layout;     ///< null without a uv map
  const HybridElements* elements;  ///< null without labels
};

enum class FigureInput : uint8_t { maps, uv, labels };

struct FigureSpec {
  const char* name;
  FigureInput input;  ///< what the figure is measured from
  double (*value)(const MeasuredResult&);
  const char* help;
  std::string (*detail)(const MeasuredResult&) = nullptr;  ///< for the {} in `help`
  ComparedFigure::Better better = ComparedFigure::Better::lower;
};

/// All figures but those of the wrap seams, in the report's order.
constexpr FigureSpec figure_specs[] = {
    {"swd", FigureInput::maps, [](const MeasuredResult& m) { return m.quality.swd; },
     "distance of the patch distributions, all scales; lower is better, 0 = the same patches as often"},
    {"cooccurrence", FigureInput::maps, [](const MeasuredResult& m) { return m.quality.cooccurrence; },
     "difference in which values stand beside one another, 0 to 1; lower is better"},
    {"coherence", FigureInput::maps, [](const MeasuredResult& m) { return m.quality.coherence; },
     "how far output patches are from the exemplar's (broken features, seams); lower is better, 1 = as far as exemplar "
     "patches from one another"},
    {"completeness", FigureInput::maps, [](const MeasuredResult& m) { return m.quality.completeness; },
     "how far exemplar patches are from the output's (lost features); lower is better, 1 = as far as exemplar patches "
     "from one another"},
    {"broken", FigureInput::maps, [](const MeasuredResult& m) { return m.quality.broken; },
     "share of output patches unlike anything in the exemplar (cut features, hard seams); lower is better"},
    {"structure", FigureInput::maps, [](const MeasuredResult& m) { return m.quality.structure; },
     "share of windows, up to half an element wide, whose edges run as nowhere in the exemplar (joints that end in a "
     "stone, courses that jog); lower is better, another sample has about 0.05"},
    {"acf", FigureInput::maps, [](const MeasuredResult& m) { return m.quality.acf; },
     "difference of the autocorrelations (long-range structure: courses, weaves); lower is better"},
    {"verbatim", FigureInput::maps,
     [](const MeasuredResult& m) { return m.layout ? m.layout->verbatim : m.quality.verbatim; },
     "typical side of a region copied in one piece over the exemplar's side, {}; lower is more varied, plain tiling "
     "gives 0.7 to 1",
     [](const MeasuredResult& m) { return std::string(m.layout ? "from the uv map" : "found from the pixels"); }},
    {"repeat", FigureInput::maps, [](const MeasuredResult& m) { return m.quality.repeat; },
     "how much stronger the output repeats itself than the exemplar; lower is better"},
    {"largest_copy", FigureInput::uv, [](const MeasuredResult& m) { return m.layout->largest_copy; },
     "area of the largest region copied in one piece over the exemplar's area; lower is more varied"},
    {"usage_entropy", FigureInput::uv, [](const MeasuredResult& m) { return m.layout->usage_entropy; },
     "how evenly the exemplar is used, 0 to 1; higher is better, 1 = every part as often", nullptr,
     ComparedFigure::Better::higher},
    {"seam_share", FigureInput::uv, [](const MeasuredResult& m) { return m.layout->seam_share; },
     "share of neighbouring pixels that are not neighbours in the exemplar; lower is more coherent"},
    {"seam_difference", FigureInput::uv, [](const MeasuredResult& m) { return m.layout->seam_difference; },
     "mean difference across those seams in standard deviations; lower is better, 0 = invisible"},
    {"seam_energy", FigureInput::uv, [](const MeasuredResult& m) { return m.layout->seam_energy; },
     "seam_share times seam_difference: what the seams cost in all; lower is better"},
    {"hybrids", FigureInput::labels, [](const MeasuredResult& m) { return m.elements->by_area; },
     "share of the area in elements that are put together from several of the exemplar's, of {}; lower is better, 0 = "
     "all whole",
     [](const MeasuredResult& m) { return counted(m.elements->elements, "element"); }},
    {"hybrids_by_number", FigureInput::labels, [](const MeasuredResult& m) { return m.elements->by_number; },
     "share of the elements that are; lower is better"},
};

std::vector<Report::Figure> measured_figures(const MeasuredResult& m) {
  std::vector<Report::Figure> out;
  for (const FigureSpec& f : figure_specs) {
    if ((f.input == FigureInput::uv && !m.layout) || (f.input == FigureInput::labels && !m.elements)) continue;
    out.push_back({f.name, rounded(f.value(m)), f.detail ? fmt::format(fmt::runtime(f.help), f.detail(m)) : f.help});
  }
  return out;
}

std::string wrap_figure_name(std::string_view axis) {
  return fmt::format("wrap_seam_{}", axis);
}

/// The directions in which the output should wrap around.
UvWraps expected_wraps(const std::string& tileable, const UvMap* uv) {
  if (tileable == "auto") return uv ? uv->wraps() : UvWraps{};
  return {tileable == "x" || tileable == "xy", tileable == "y" || tileable == "xy", false};
}

void add_wrap_figures(const Material& output, const std::vector<std::string>& maps, const UvWraps& wraps,
                      std::vector<Report::Figure>& out) {
  if (!wraps.x && !wraps.y) return;
  struct Worst {
    double ratio = 0;
    std::string map;
  } x, y;
  for (const std::string& name : maps) {
    const WrapSeam seam = wrap_seam(*output.find(std::string_view(name)));
    if (seam.x > x.ratio) x = {seam.x, name};
    if (seam.y > y.ratio) y = {seam.y, name};
  }
  const auto help = [](const char* borders, const Worst& worst) {
    return fmt::format("gradient from {} border over the interior's, worst map ({}); about 1 is good, higher is a seam",
                       borders, worst.map);
  };
  if (wraps.x) out.push_back({wrap_figure_name("x"), rounded(x.ratio), help("right to left", x)});
  if (wraps.y) out.push_back({wrap_figure_name("y"), rounded(y.ratio), help("bottom to top", y)});
}

void check_layout(const Forecast& uv, std::optional<Size> exemplar, std::optional<Size> output) {
  if (!uv.size || !uv.exemplar || !exemplar || !output) return;
  const auto same_ratio = [](int a, int b, int c, int d) { return int64_t{a} * d == int64_t{b} * c; };
  const bool fits = same_ratio(exemplar->width, uv.exemplar->width, output->width, uv.size->width) &&
                    same_ratio(exemplar->height, uv.exemplar->height, output->height, uv.size->height);
  if (!fits)
    throw Error("uv", fmt::format("the uv map must be the one the output was resolved from; it makes {} out of {} "
                                  "pixels, but the exemplar has {} and the output {}",
                                  describe(*uv.size), describe(*uv.exemplar), describe(*exemplar), describe(*output)));
}

[[noreturn]] void throw_without_uv() {
  throw Error("labels", "labels of elements need the uv map too; connect \"uv\"");
}

OutputForecasts infer_compare(const Params& params, const InputForecasts& inputs) {
  const Forecast &exemplar = inputs.at("exemplar").front(), &output = inputs.at("output").front();
  for (const auto& [side, material] : {std::pair("exemplar", &exemplar), std::pair("output", &output)})
    preflight_maps("maps", std::get<Texts>(params.at("maps")), *material, fmt::format("the {}", side));
  if (const Forecast* uv = forecast_at(inputs, "uv")) check_layout(*uv, material_size(exemplar), material_size(output));
  if (wires_at(inputs, "labels") > 0 && wires_at(inputs, "uv") == 0) throw_without_uv();
  return {};
}

const UvMapPtr& require_uv(const UvMapPtr& uv) {
  if (!uv) throw_without_uv();
  return uv;
}

/// Empty unless the labels distinguish several elements.
std::optional<Elements> given_elements(NodeContext& node, const UvMapPtr& uv) {
  const ImagePtr labels = node.optional_input<Image>("labels");
  if (!labels) return std::nullopt;
  Elements elements = labelled_elements(labels, require_uv(uv)->exemplar(), node.task());
  if (elements.count <= 1) return std::nullopt;
  return elements;
}

void compute_compare(NodeContext& node) {
  const MaterialPtr exemplar = node.input<Material>("exemplar"), output = node.input<Material>("output");
  const UvMapPtr uv = node.optional_input<UvMap>("uv");
  const std::vector<std::string> maps = compared_maps(*exemplar, *output, node.texts("maps"));
  ComparedPlanes planes = compared_planes(*exemplar, *output, maps);
  for (const auto& [name, material] : {std::pair("exemplar", exemplar), std::pair("output", output)})
    if (std::max(material->size().width, material->size().height) > largest_measured)
      node.note(fmt::format("of the {}'s {}x{} pixels the {}x{} at the top left were measured", name,
                            material->size().width, material->size().height,
                            std::min(material->size().width, largest_measured),
                            std::min(material->size().height, largest_measured)));

  std::optional<LayoutFigures> layout;
  const bool wraps = node.flag("wraps") || (uv && uv->wraps().exemplar);
  if (uv) layout = layout_figures(*uv, planes.exemplar, wraps);
  const std::optional<Elements> elements = given_elements(node, uv);
  const bool is_whole = planes.exemplar.size == exemplar->size();
  const QualityParts parts{
      .verbatim = !layout,
      .element = elements ? typical_side(*elements) * exemplar->size().width / elements->size.width : 0};
  planes.exemplar.wraps = wraps && is_whole;
  const QualityFigures q = measure_quality(std::move(planes.exemplar), std::move(planes.output), parts, node.task());

  std::optional<HybridElements> hybrids;
  if (elements) hybrids = hybrid_elements(*uv, *elements, node.task());
  std::vector<Report::Figure> figures =
      measured_figures({q, layout ? &*layout : nullptr, hybrids ? &*hybrids : nullptr});
  add_wrap_figures(*output, maps, expected_wraps(node.text("tileable"), uv.get()), figures);

  const ImagePtr sheet = comparison_sheet(*exemplar, *output, maps, int(node.integer("sheet_size")));
  node.output("sheet", sheet);
  node.output("report", Report::make(fmt::format("{} against its exemplar: {}", output->name(), fmt::join(maps, ", ")),
                                     std::move(figures), {{"sheet", sheet}}));
}

size_t memory_of_compare(const NodeContext& node) {
  size_t pixels = 0;
  for (const char* port : {"exemplar", "output"}) {
    const MaterialPtr material = node.input<Material>(port);
    const Size size = material->size();
    const size_t measured = size_t(std::min(size.width, largest_measured)) * std::min(size.height, largest_measured);
    // Stacked and filtered channels as floats, and two complex grids of four times the area.
    pixels += measured * (3 * 4 * 4 * material->maps().size() + 2 * 16 * 4);
  }
  return pixels;
}

}  // namespace

std::vector<ComparedFigure> compared_figures(const Params& params, bool has_uv, bool has_labels) {
  std::vector<ComparedFigure> out;
  for (const FigureSpec& f : figure_specs)
    if (f.input == FigureInput::maps || (f.input == FigureInput::uv ? has_uv : has_labels))
      out.push_back({f.name, f.better});
  const std::string& tileable = std::get<std::string>(params.at("tileable"));
  for (const char* axis : {"x", "y"})
    if (tileable == axis || tileable == "xy" || (tileable == "auto" && has_uv))
      out.push_back({wrap_figure_name(axis), ComparedFigure::Better::neither});
  return out;
}

NodeType compare_node() {
  NodeType t;
  t.name = "compare";
  t.version = 8;
  t.category = "sink";
  t.summary = "Scores a result against its exemplar";
  t.help =
      "Measures how well an output reproduces its exemplar's texture, without learned weights: patch statistics over "
      "several scales (sliced Wasserstein distance), co-occurrence of values, bidirectional patch similarity (Simakov "
      "et al. 2008), structure at the scale of elements, autocorrelation, repetition and verbatim copies; with the uv "
      "map also seams, evenness of use and "
      "the exact size of copies. Read the figures together: plain tiling wins all of them except verbatim and repeat.";
  t.inputs = {
      {.name = "exemplar", .type = ValueType::material, .help = "what the output should look like"},
      {.name = "output", .type = ValueType::material, .help = "what was synthesized"},
      {.name = "uv",
       .type = ValueType::uv_map,
       .help = "the uv map that the output was resolved from: adds figures about its layout",
       .optional = true},
      {.name = "labels",
       .type = ValueType::image,
       .help = "the exemplar's elements, one value for each, as \"elements\" gives them: adds the figures hybrids and "
               "hybrids_by_number, and tells structure how large elements are; needs \"uv\"",
       .optional = true},
  };
  t.outputs = {
      {.name = "report", .type = ValueType::report, .help = "the figures, each with what it means"},
      {.name = "sheet", .type = ValueType::image, .help = "exemplar and output side by side, maps in columns"},
  };
  t.params = {
      {.name = "maps",
       .type = ParamType::texts,
       .fallback = Texts{},
       .help = "The maps to compare, by name. Empty: all that exemplar and output share."},
      {.name = "wraps",
       .type = ParamType::boolean,
       .fallback = false,
       .help = "The exemplar tiles: crossing its border is no seam, and what lies across it is also looked for in the "
               "output. Most uv maps say so themselves."},
      {.name = "tileable",
       .type = ParamType::choice,
       .fallback = "auto",
       .help = "Directions in which the output should wrap around, for the figures wrap_seam_x and wrap_seam_y. "
               "\"auto\": as the uv map does; none without one.",
       .choices = {"auto", "none", "x", "y", "xy"}},
      {.name = "sheet_size",
       .type = ParamType::integer,
       .fallback = int64_t{1536},
       .help = "Maximum width and height of the contact sheet.",
       .min = 256,
       .max = 16384,
       .unit = "pixels"},
  };
  t.memory_hint = memory_of_compare;
  t.compute = compute_compare;
  t.infer = infer_compare;
  return t;
}

}  // namespace terrazzo
