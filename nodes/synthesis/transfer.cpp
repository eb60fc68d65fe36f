#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/material/map_names.h"
#include "core/synthesis/state/labels.h"
#include "core/synthesis/steps.h"
#include "nodes/common/shape_rules.h"
#include "nodes/common/synthesis/synthesis_memory.h"
#include "nodes/common/synthesis/synthesis_params.h"
#include "nodes/common/synthesis/synthesis_steps.h"

namespace terrazzo {

namespace {

void require_pairs(size_t exemplars, size_t targets, size_t strengths) {
  check_all(
      [&] {
        if (targets != exemplars)
          throw Error("target", fmt::format("expected as many images as \"exemplar_control\" has, {}; found {}",
                                            exemplars, targets));
      },
      [&] {
        if (strengths != 1 && strengths != exemplars)
          throw Error("strength",
                      fmt::format("expected one number, or one for each control, {}; found {}", exemplars, strengths));
      });
}

Control::Mode mode_of(const Params& params) {
  return std::get<std::string>(params.at("mode")) == "labels" ? Control::Mode::labels : Control::Mode::values;
}

std::vector<Control> controls_of(const NodeContext& node) {
  const auto exemplars = node.list<Image>("exemplar_control"), targets = node.list<Image>("target");
  const Numbers& strength = node.numbers("strength");
  const std::string& match = node.text("match");
  std::vector<Control> controls;
  for (size_t i = 0; i < targets.size(); i++) {
    Control control{.exemplar = exemplars[i], .target = targets[i], .strength = strength[i % strength.size()]};
    control.mode = mode_of(node.params());
    control.leeway = node.number("leeway");
    control.match = match == "none"    ? Control::Match::none
                    : match == "range" ? Control::Match::range
                                       : Control::Match::histogram;
    controls.push_back(control);
  }
  return controls;
}

/// Soft edges of brush strokes in a painted layout are intended.
constexpr double most_unknown = 0.05;

void warn_of_labels(NodeContext& node, const std::vector<Control>& controls, Size exemplar) {
  for (const Control& control : controls) {
    if (control.mode != Control::Mode::labels) continue;
    const PaintedLabels labels = painted_labels(control, exemplar, control.target->size(), node.task());
    if (labels.unknown > most_unknown)
      node.warn(fmt::format(
          "{:.0f} % of the target have values missing in \"exemplar_control\"; they count as the nearest it has",
          100 * labels.unknown));
    if (labels.count > 1 && labels.wanted == 1)
      node.warn(fmt::format("the target has only one of the {} labels of \"exemplar_control\"", labels.count));
  }
}

/// Targets may differ in size from the result, but a different aspect ratio is probably unintended.
void tell_of_stretched(NodeContext& node, const std::vector<Control>& controls, Size result) {
  for (const Control& control : controls)
    if (const Size target = control.target->size(); target.area() > 1 && !same_shape(target, result))
      node.note(fmt::format("the target of {} pixels is stretched to the result's {}, which has another aspect ratio",
                            describe(target), describe(result)));
}

void compute_transfer(NodeContext& node) {
  const auto index = node.input<Index>("index");
  SynthesisOptions options = synthesis_options(node, *index);
  options.controls = controls_of(node);
  tell_of_stretched(node, options.controls, options.size);
  warn_of_labels(node, options.controls, index->appearance()->size());
  warn_unless_repeats_fit(node, *index, options, "they are stretched to wrap around and joints may jog");
  const UvMapPtr uv = synthesize(*index, options, node.task());
  tell_of_parts(node, *index, *uv, false);
  node.output("uv", uv);
}

OutputForecasts infer_transfer(const Params& params, const InputForecasts& inputs) {
  const size_t controls = wires_at(inputs, "exemplar_control");
  require_pairs(controls, wires_at(inputs, "target"), std::get<Numbers>(params.at("strength")).size());
  const std::optional<Size> exemplar = inputs.at("index").front().size;
  for (size_t i = 0; i < controls; i++)
    require_control(mode_of(params), image_at(inputs, "exemplar_control", i), image_at(inputs, "target", i), exemplar);
  return {{"uv", {.size = std::get<Size>(params.at("size")), .exemplar = exemplar}}};
}

/// `values`: per pixel, of all targets together.
SynthesisMemory memory_of(const Params& params, int values) {
  const uint64_t distances = std::get<double>(params.at("leeway")) > 0 ? label_distances_memory : 0;
  return {new_pixels_memory.per_pixel + control_value_memory * uint64_t(values) + distances};
}

std::vector<Param> transfer_params() {
  return {
      result_size_param(),
      tileable_param(),
      {.name = "strength",
       .type = ParamType::numbers,
       .fallback = Numbers{1},
       .help =
           "How much the target counts against the texture's own structure; 0 ignores it. One number for all controls, "
           "or one for each. At 1 deviations as large as those within a feature (a sixteenth of the exemplar's longer "
           "side) are free, so that features stay whole; 4 shows a picture clearly but breaks features. Exemplars with "
           "little variation may need 4 and more, or a control with evenly spread values, such as that of progression.",
       .min = 0,
       .max = 100,
       .min_count = 1},
      {.name = "mode",
       .type = ParamType::choice,
       .fallback = "values",
       .help = "values: nearer values match better. labels: every value is a class, such as moss or stone; target "
               "values missing in the exemplar's control count as the nearest it has.",
       .choices = {"values", "labels"}},
      {.name = "leeway",
       .type = ParamType::number,
       .fallback = 0.0,
       .help = "Labels only: how far borders may deviate from where they are painted, so that bricks, tiles and stones "
               "stay whole; 0 follows them exactly. Painted areas thinner than twice that, and sharp corners, are "
               "always kept.",
       .min = 0,
       .max = 4096,
       .unit = "pixels of the result"},
      {.name = "match",
       .type = ParamType::choice,
       .fallback = "histogram",
       .help = "How the target's values are mapped to the exemplar control's, per channel. histogram: by rank, so that "
               "any grey image works and all of the exemplar is used; the darkest and the lightest twentieth each "
               "count as one value. range: darkest and lightest are matched. none: values are used as they are.",
       .choices = {"histogram", "range", "none"}},
  };
}

}  // namespace

NodeType transfer_node() {
  NodeType t;
  t.name = "transfer";
  t.version = synthesis_version;
  t.category = "synthesis";
  t.summary = "Synthesis steered by a target image";
  t.help =
      "Like synthesize, but a target decides what goes where. \"exemplar_control\" describes the exemplar (blurred "
      "luminance, a wear or moisture map, painted labels), \"target\" the wanted result in the same terms; it is "
      "stretched over the result. For showing a picture in a texture (texture transfer, Efros & Freeman 2001), "
      "following a mix map or progression (mode values) or a painted layout (mode labels). Several controls work "
      "together; the n-th target belongs to the n-th exemplar control.";
  t.inputs = {index_port(),
              {.name = "exemplar_control",
               .type = ValueType::image,
               .help = "what is where in the exemplar; its aspect ratio at any size",
               .list = true},
              {.name = "target",
               .type = ValueType::image,
               .help = "what is wanted where in the result; as many images, with as many channels each (labels may be "
                       "grey or coloured)",
               .list = true}};
  t.outputs = {uv_output()};
  t.params = with_synthesis_params(transfer_params());
  t.check = check_synthesis_params;
  t.steps = described_synthesis_steps();
  t.compute = compute_transfer;
  t.infer = infer_transfer;
  t.memory_hint = [](const NodeContext& node) {
    int values = 0;
    for (const ImagePtr& target : node.list<Image>("target")) values += target->channels();
    return size_t(memory_of(node.params(), values).of(node.size("size")));
  };
  t.memory_ahead = [](const Params& params, const InputForecasts& inputs) {
    int values = 0;
    for (size_t i = 0; i < wires_at(inputs, "target"); i++)
      values += image_at(inputs, "target", i).channels.value_or(1);
    return synthesis_ahead(inputs, memory_of(params, values), std::get<Size>(params.at("size")));
  };
  return t;
}

}  // namespace terrazzo
