#include "core/analysis/repeats/regularity.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/analysis/repeats/part_lattices.h"
#include "core/node/node.h"

namespace terrazzo {

namespace {

constexpr double largest_side = 65536;  // of an exemplar
constexpr size_t most_described = 4;

/// `least`: the certainty asked for.
std::string described(const Lattice& l, double least) {
  if (l.rank == 0 && l.certainty >= least)
    return fmt::format("no lattice found: what repeats (certainty {:.2f}) is too seldom, or not alike enough, to tell",
                       l.certainty);
  if (l.rank == 0)
    return fmt::format("no lattice found (certainty {:.2f}, at least {:.2f} is asked for)", l.certainty, least);
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

/// What the parameters say of an exemplar that lies beside others, or of several that repeat alike.
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
        "; not all repeat alike, so that courses and tiles break where they meet: for one surface set \"alike\" to "
        "true, "
        "or \"mode\" to \"manual\" and give \"first\" and \"second\"; of copies take those that keep its grid";
  return text;
}

/// What the parameters say of all of an exemplar.
FoundLattice lattice_of_all(NodeContext& node, const Features& features) {
  if (node.text("mode") == "manual") return given_lattice(node);
  return find_lattice(features, node.number("least_certainty"), node.task());
}

void compute(NodeContext& node) {
  const auto features = node.input<Features>("features");
  const ImagePtr labels = node.optional_input<Image>("labels");
  const double least = node.number("least_certainty");
  Repeats repeats;
  bool too_few = false;
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
    node.note(described(found.lattice, least));
    too_few = found.too_few;
    repeats = found.lattice;
  }
  if (too_few)
    node.warn(
        "straight joints cross, but the exemplar shows too few tiles, or too unlike ones, to tell how they repeat, so "
        "that results may break them; crop it to whole tiles so that its borders fit, take one of more tiles, or give "
        "\"first\" and \"second\" with \"mode\": \"manual\"");
  node.output("features", features->with(repeats));
}

std::vector<std::string> check(const Params& params) {
  if (std::get<std::string>(params.at("mode")) != "manual") return {};
  const auto& first = std::get<Numbers>(params.at("first"));
  const auto& second = std::get<Numbers>(params.at("second"));
  if (first.size() != 2)
    return {"\"first\": expected [x, y], the pixels after which the exemplar repeats, since mode is \"manual\""};
  if (!second.empty() && second.size() != 2) return {"\"second\": expected [x, y], or nothing for courses or columns"};
  const auto is_short = [](const Numbers& v) { return std::max(std::abs(v[0]), std::abs(v[1])) < 1; };
  if (is_short(first) || (!second.empty() && is_short(second))) return {"expected repeats after a pixel or more"};
  if (manual_lattice(first, second).is_valid()) return {};
  if (second.empty())
    return {"\"first\": without \"second\", expected [0, height] for courses or [width, 0] for columns"};
  return {"\"second\": expected a direction other than that of \"first\""};
}

}  // namespace

NodeType regularity_node() {
  NodeType t;
  t.name = "regularity";
  t.version = 12;
  t.category = "analysis";
  t.summary = "Finds the lattice of a regular exemplar";
  t.help =
      "Bricks, tiles and weaves repeat. From the autocorrelation of all weighted channels this finds by what vectors, "
      "or in what "
      "courses or columns, and says how sure it is. Synthesis then keeps every pixel at its place within the lattice's "
      "cell, so "
      "that courses stay straight and tiles keep their size over any distance. Exemplars without a lattice pass "
      "through unchanged. Of several exemplars that lie side by side (\"combine\", \"variants\"; give their labels) "
      "each has its own lattice; where those are alike, joints of one go on in another.";
  t.inputs = {{.name = "features", .type = ValueType::features, .help = "the exemplar's weighted channels"},
              {.name = "labels",
               .type = ValueType::image,
               .help = "of several exemplars side by side, which one each pixel belongs to, 1 channel",
               .optional = true}};
  t.outputs = {{.name = "features", .type = ValueType::features, .help = "the same, with the lattice"}};
  t.params = {
      {.name = "mode",
       .type = ParamType::choice,
       .fallback = "auto",
       .help = "auto looks for a lattice, manual takes the given one, off uses none.",
       .choices = {"auto", "manual", "off"}},
      {.name = "least_certainty",
       .type = ParamType::number,
       .fallback = 0.08,
       .help = "A lattice found with less certainty is not used, nor one with less than 0.6 of which the exemplar "
               "holds at most six cells.",
       .min = 0,
       .max = 1},
      {.name = "alike",
       .type = ParamType::boolean,
       .fallback = false,
       .help = "With labels: the exemplars are of one surface and repeat alike. Where what is found of each does not "
               "agree, one lattice is looked for in all of them together."},
      {.name = "first",
       .type = ParamType::numbers,
       .fallback = Numbers{},
       .help = "For manual: [x, y] after which the exemplar repeats; alone, [0, height] of courses or [width, 0] of "
               "columns.",
       .min = -largest_side,
       .max = largest_side,
       .unit = "pixels",
       .max_count = 2},
      {.name = "second",
       .type = ParamType::numbers,
       .fallback = Numbers{},
       .help = "For manual: the other direction, [x, y].",
       .min = -largest_side,
       .max = largest_side,
       .unit = "pixels",
       .max_count = 2},
  };
  t.persist = Persist::digest;
  t.check = check;
  t.compute = compute;
  return t;
}

}  // namespace terrazzo
