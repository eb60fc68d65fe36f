#include "core/analysis/repeats/regularity.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/analysis/repeats/part_lattices.h"
#include "core/analysis/repeats/streaks.h"
#include "core/analysis/repeats/uneven_borders.h"
#include "core/analysis/space/planes.h"
#include "core/node/node.h"
#include "nodes/common/shape_rules.h"
#include "nodes/common/synthesis/analysis_memory.h"

namespace terrazzo {

namespace {

constexpr double largest_side = 65536;  // of an exemplar
constexpr size_t most_described = 4;

/// `least`: the certainty asked for.
std::string described(const Lattice& l, double least) {
  if (l.rank == 0 && l.certainty >= least)
    return fmt::format("no lattice found: too few repeats, or too unlike, to be sure (certainty {:.2f})", l.certainty);
  if (l.rank == 0)
    return fmt::format("no lattice found (certainty {:.2f}, below \"least_certainty\" {:.2f})", l.certainty, least);
  if (l.rank == 2)
    return fmt::format("repeats by ({:.2f}, {:.2f}) and ({:.2f}, {:.2f}) pixels, certainty {:.2f}", l.first.x(),
                       l.first.y(), l.second.x(), l.second.y(), l.certainty);
  const bool columns = l.first.x() != 0;
  return fmt::format("{} of {:.2f} pixels, certainty {:.2f}", columns ? "columns" : "courses",
                     columns ? l.first.x() : l.first.y(), l.certainty);
}

Lattice manual_lattice(const Numbers& first, const Numbers& second) {
  Lattice l{second.empty() ? 1 : 2, {first[0], first[1]}, {}, 1};
  if (!second.empty()) l.second = {second[0], second[1]};
  return l;
}

FoundLattice given_lattice(const NodeContext& node) {
  return {manual_lattice(node.numbers("first"), node.numbers("second"))};
}

/// The lattice set by the parameters for an exemplar among several, or for several with equal repeats.
FoundLattice lattice_of(NodeContext& node, const std::vector<ExemplarView>& views) {
  if (node.text("mode") == "manual") return given_lattice(node);
  return find_lattice(views, node.number("least_certainty"), node.task());
}

std::string described(const BroughtTogether& all, double least) {
  const size_t count = all.parts.size();
  std::string text;
  for (size_t i = 0; i < std::min(count, most_described); i++)
    text += fmt::format("{}exemplar {}: {}", i > 0 ? "; " : "", i + 1, described(all.parts[i].lattice, least));
  if (count > most_described) text += fmt::format("; and {} more", count - most_described);
  if (all.kinds > 1)
    text +=
        "; they repeat differently, so that courses and tiles break where they meet. If they show one surface, set "
        "\"alike\" to true, or \"mode\" to \"manual\" with \"first\" and \"second\"; if they are copies, use only "
        "those that keep the grid";
  return text;
}

/// The lattice set by the parameters for a whole exemplar.
FoundLattice lattice_of_all(NodeContext& node, const Features& features) {
  if (node.text("mode") == "manual") return given_lattice(node);
  FoundLattice found = find_lattice(features, node.number("least_certainty"), node.task());
  // The foot of a wall is rather left out than repeated half-way up.
  const bool by_one_line = found.lattice.rank == 1 && found.lattice == found.by_lines;
  if (by_one_line && !features.wraps() && node.text("borders") == "auto" &&
      evenness(features, node.task()).part != whole(features.size()))
    found.lattice = {};
  return found;
}

/// Adds the exemplar's streaks to its repeats.
void add_streaks(NodeContext& node, const Features& features, Repeats& repeats) {
  const Lattice before = repeats.lattice;
  repeats = with_streaks(*features.with(repeats), node.task());
  if (repeats.lattice.rank < before.rank)
    node.note(fmt::format("{}, but streaks make such by chance: not used", described(before, 0)));
  if (!repeats.streaks.any()) return;
  node.note(fmt::format("streaks along {}, of which synthesis sees one in {} pixels", repeats.streaks.x > 1 ? "x" : "y",
                        std::max(repeats.streaks.x, repeats.streaks.y)));
}

/// The exemplar of which only a part may be sampled; says what is left out.
FeaturesPtr without_borders(NodeContext& node, const Features& features, const Rect& even) {
  const Size size = features.size();
  std::vector<std::string> sides;
  for (const auto& [pixels, side] : {std::pair{even.x, "left"},
                                     {size.width - even.right(), "right"},
                                     {even.y, "top"},
                                     {size.height - even.bottom(), "bottom"}})
    if (pixels > 0) sides.push_back(fmt::format("{} pixels at the {}", pixels, side));
  node.note(
      fmt::format("{}: unlike all the rest of an exemplar that does not tile, and left out, as they would show in "
                  "patches anywhere; \"borders\" set to keep uses them",
                  fmt::join(sides, ", ")));
  std::vector<float> mask;
  mask.reserve(size_t(size.area()));
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) mask.push_back(contains(even, x, y) ? 1.0f : 0.0f);
  return features.with(Image::from_floats({.size = size, .channels = 1, .semantic = Semantic::mask}, std::move(mask)));
}

/// The exemplar without borders that are unlike the rest; warns of one that changes from side to side.
FeaturesPtr without_uneven_borders(NodeContext& node, const FeaturesPtr& features) {
  const Evenness found = evenness(*features, node.task());
  if (found.changes_down || found.changes_across)
    node.warn(fmt::format(
        "the exemplar changes from {} as a whole: a result shows what it has at either side in patches anywhere. Crop "
        "it to what is alike all over (crop), take light out (delight), or say where to show what (progression)",
        found.changes_down ? "top to bottom" : "left to right"));
  return found.part == whole(features->size()) ? features : without_borders(node, *features, found.part);
}

void compute_regularity(NodeContext& node) {
  const auto features = node.input<Features>("features");
  const ImagePtr labels = node.optional_input<Image>("labels");
  const double least = node.number("least_certainty");
  // Lattice, streaks and borders are looked for in the same planes.
  std::shared_ptr<const Planes> planes;
  if (node.text("mode") == "auto" || node.text("streaks") == "auto") planes = weighted_planes(*features, node.task());
  Repeats repeats;
  bool too_few = false;
  int courses = 0;
  if (node.text("mode") != "off" && labels) {
    BroughtTogether all = find_part_lattices(
        *features, label_places(labels, features->size(), node.task()),
        [&](const std::vector<ExemplarView>& views) { return lattice_of(node, views); }, node.flag("alike"),
        node.task());
    node.note(described(all, least));
    too_few = all.too_few;
    repeats = Repeats(std::move(all.parts));
  } else if (node.text("mode") != "off") {
    const FoundLattice found = lattice_of_all(node, *features);
    too_few = found.too_few;
    courses = found.courses;
    repeats = found.lattice;
  }
  const int found_rank = repeats.lattice.rank;
  if (!labels && node.text("streaks") == "auto") add_streaks(node, *features, repeats);
  if (!labels && node.text("mode") != "off" && repeats.lattice.rank == found_rank)
    node.note(described(repeats.lattice, least));
  if (too_few && repeats.lattice.rank < 2)
    node.warn(
        "there is a grid of joints, but with too few tiles, or too different ones, to find its lattice: results may "
        "break tiles. Crop the exemplar to whole tiles so that it tiles, use one with more tiles, or give \"first\" "
        "and \"second\" with \"mode\": \"manual\"");
  const bool single = repeats.lattice.is_single_cell(features->size());
  if (single && courses > 0)
    node.note(
        fmt::format("the exemplar is a single cell of its lattice, of {} courses with other joints each: what "
                    "lies between those is laid anew where elements are",
                    courses));
  else if (single)
    node.warn(fmt::format(
        "the exemplar is a single cell of its lattice: a result repeats it as it is, with few variations{}. An "
        "exemplar that shows several tiles or panels side by side helps",
        features->wraps() ? "" : ", and shows where its borders meet, as it does not tile"));
  else if (const Lattice& l = repeats.lattice; l.rank == 1 && l.comes_once(features->size()))
    node.note(fmt::format("the exemplar is a single {}: a result repeats it {}", l.first.x() != 0 ? "column" : "course",
                          l.first.x() != 0 ? "from left to right" : "downwards"));
  const FeaturesPtr known = features->with(repeats);
  // Where joints cross and nothing repeats, a border may be a frame. A mask would part streaks.
  const bool may_be_framed = repeats.lattice.rank == 0 && too_few;
  const bool looks = node.text("borders") == "auto" && !labels && !may_be_framed && !repeats.streaks.any();
  node.output("features", looks ? without_uneven_borders(node, known) : known);
}

std::vector<std::string> check_regularity(const Params& params) {
  if (std::get<std::string>(params.at("mode")) != "manual") return {};
  const auto& first = std::get<Numbers>(params.at("first"));
  const auto& second = std::get<Numbers>(params.at("second"));
  if (first.size() != 2) return {"\"first\": expected a lattice vector [x, y] in pixels, since \"mode\" is \"manual\""};
  if (!second.empty() && second.size() != 2)
    return {"\"second\": expected a lattice vector [x, y] in pixels, or nothing for courses or columns"};
  const auto is_short = [](const Numbers& v) { return std::max(std::abs(v[0]), std::abs(v[1])) < 1; };
  for (const auto& [name, v] : {std::pair{"first", &first}, {"second", &second}})
    if (!v->empty() && is_short(*v)) return {fmt::format("\"{}\": expected a vector at least one pixel long", name)};
  if (manual_lattice(first, second).is_valid()) return {};
  if (second.empty())
    return {"\"first\": without \"second\", expected [0, height] for courses or [width, 0] for columns"};
  return {"\"second\": expected a direction different from \"first\""};
}

}  // namespace

NodeType regularity_node() {
  NodeType t;
  t.name = "regularity";
  t.version = 26;
  t.category = "analysis";
  t.summary = "Finds the lattice of a regular exemplar";
  t.help =
      "Bricks, tiles and weaves repeat. The autocorrelation of all weighted channels gives the lattice vectors, or the "
      "period of courses or columns, and how certain they are; of an exemplar that tiles, also the lines between its "
      "tiles and, of up to twelve, the joints around them. Where nothing repeats, a line from border to border makes "
      "one course or column. Synthesis then keeps every pixel at its phase in the "
      "lattice's cell, so that courses stay straight and tiles keep their size over any distance. Exemplars without a "
      "lattice pass through unchanged. If several exemplars lie side by side (\"combine\", \"variants\"; give their "
      "labels) each gets its own lattice; where lattices are alike, joints continue from one to the other.";
  t.inputs = {{.name = "features", .type = ValueType::features, .help = "the exemplar's weighted channels"},
              {.name = "labels",
               .type = ValueType::image,
               .help = "for several exemplars side by side: which one each pixel belongs to, 1 channel",
               .optional = true}};
  t.outputs = {{.name = "features", .type = ValueType::features, .help = "the same, with their lattice"}};
  t.params = {
      {.name = "mode",
       .type = ParamType::choice,
       .fallback = "auto",
       .help = "auto looks for a lattice, manual takes the one in \"first\" and \"second\", off uses none.",
       .choices = {"auto", "manual", "off"}},
      {.name = "least_certainty",
       .type = ParamType::number,
       .fallback = least_lattice_certainty,
       .help = "Lattices found with less certainty are not used. Higher accepts fewer. If the exemplar holds at most "
               "six cells, 0.6 is needed.",
       .min = 0,
       .max = 1},
      {.name = "streaks",
       .type = ParamType::choice,
       .fallback = "auto",
       .help = "auto looks for streaks that go on along x or y, as of brushed metal, wood grain and pipes, where there "
               "are no cells. Synthesis then sees more of each streak, and lets streaks end one by one rather than "
               "along seams across them. off sees them as anything else.",
       .choices = {"auto", "off"}},
      {.name = "borders",
       .type = ParamType::choice,
       .fallback = "keep",
       .help = "auto leaves out borders that are unlike all the rest of an exemplar that neither tiles nor has cells, "
               "such as a vignette or the dirty foot of a wall: a result would show them in patches anywhere. keep "
               "uses them, as results must that go on beside the exemplar's own pixels, or show its tones on demand.",
       .choices = {"keep", "auto"}},
      {.name = "alike",
       .type = ParamType::boolean,
       .fallback = false,
       .help = "With labels: the exemplars show one surface and repeat alike. If their lattices disagree, one is "
               "searched in all of them together."},
      {.name = "first",
       .type = ParamType::numbers,
       .fallback = Numbers{},
       .help = "For manual: the first lattice vector, [x, y]. Without \"second\": [0, height] of courses, or [width, "
               "0] of columns.",
       .min = -largest_side,
       .max = largest_side,
       .unit = "pixels",
       .max_count = 2},
      {.name = "second",
       .type = ParamType::numbers,
       .fallback = Numbers{},
       .help = "For manual: the second lattice vector, [x, y].",
       .min = -largest_side,
       .max = largest_side,
       .unit = "pixels",
       .max_count = 2},
  };
  t.persist = Persist::payload;
  t.check = check_regularity;
  set_analysis_memory(t, "features", lattice_memory);
  t.infer = [](const Params& params, const InputForecasts& inputs) {
    const Forecast& features = inputs.at("features").front();
    if (std::get<std::string>(params.at("mode")) != "off" && wires_at(inputs, "labels") > 0)
      require_labels(image_at(inputs, "labels"), features.size);
    return OutputForecasts{{"features", {.size = features.size, .values = features.values}}};
  };
  t.compute = compute_regularity;
  return t;
}

}  // namespace terrazzo
