#include "core/analysis/regularity.h"

#include <cmath>
#include <map>

#include <fmt/format.h>

#include "core/analysis/part_lattices.h"
#include "core/analysis/usable.h"
#include "core/image_ops.h"
#include "core/node.h"
#include "core/text.h"
#include "nodes/image_work.h"

namespace terrazzo {

namespace {

constexpr double largest_side = 65536;  // of an exemplar
constexpr size_t most_described = 4;

std::string described(const Lattice& l) {
  if (l.rank == 0) return fmt::format("no lattice found (certainty {:.2f})", l.certainty);
  if (l.rank == 2)
    return fmt::format("repeats by ({:.2f}, {:.2f}) and ({:.2f}, {:.2f}) pixels, certainty {:.2f}", l.first.x,
                       l.first.y, l.second.x, l.second.y, l.certainty);
  const bool columns = l.first.x != 0;
  return fmt::format("{} of {:.2f} pixels, certainty {:.2f}", columns ? "columns" : "courses",
                     columns ? l.first.x : l.first.y, l.certainty);
}

Lattice manual_lattice(const Numbers& first, const Numbers& second) {
  Lattice l{second.empty() ? 1 : 2, {first[0], first[1]}, {}, 1};
  if (!second.empty()) l.second = {second[0], second[1]};
  return l;
}

/// What the parameters say of an exemplar, or of several that repeat alike.
FoundLattice lattice_of(NodeContext& node, const std::vector<ExemplarView>& views) {
  const std::string& mode = node.text("mode");
  if (mode == "auto") return find_lattice(views, node.number("least_certainty"), node.task());
  return {manual_lattice(node.numbers("first"), node.numbers("second"))};
}

/// The rectangle of each label, in the order of their values.
std::vector<Rect> places_of(const ImagePtr& labels, Size exemplar, const Task& task) {
  require_one_channel("labels", *labels);
  if (labels->size() != exemplar)
    throw Error("labels", fmt::format("expected the size of the features' exemplar, {}, found {}", describe(exemplar),
                                      describe(labels->size())));
  struct Place {
    Rect bounds;
    int64_t pixels = 0;
  };
  std::map<float, Place> places;
  const std::vector<float>& values = materialized(labels, task)->pixels();
  for (int y = 0; y < exemplar.height; y++) {
    const float* row = &values[size_t(y) * size_t(exemplar.width)];
    for (int x = 0, next = 0; x < exemplar.width; x = next) {
      if (!std::isfinite(row[x])) throw Error("labels", "expected labels, found a value that is not a number");
      while (next < exemplar.width && row[next] == row[x]) next++;
      const Rect run{x, y, next - x, 1};
      Place& p = places[row[x]];
      p.bounds = p.pixels == 0 ? run : united(p.bounds, run);
      p.pixels += run.area();
      if (places.size() > most_lattice_parts)
        throw Error("labels", fmt::format("expected at most {} exemplars side by side, found more values: this "
                                          "looks like a picture, not like the labels of \"combine\" or \"variants\"",
                                          most_lattice_parts));
    }
  }
  std::vector<Rect> out;
  for (const auto& [label, place] : places) {
    if (place.bounds.area() != place.pixels)
      throw Error("labels",
                  "expected exemplars side by side, each a rectangle, as \"combine\" and \"variants\" lay them out");
    out.push_back(place.bounds);
  }
  return out;
}

std::string described(const BroughtTogether& all) {
  const size_t count = all.parts.size();
  std::string text;
  for (size_t i = 0; i < std::min(count, most_described); i++)
    text += fmt::format("{}exemplar {}: {}", i > 0 ? "; " : "", i + 1, described(all.parts[i].lattice));
  if (count > most_described) text += fmt::format("; and {} more", count - most_described);
  if (all.kinds > 1)
    text +=
        "; not all repeat alike, so that courses and tiles break where they meet: for one surface set \"alike\" to "
        "true, "
        "or \"mode\" to \"manual\" and give \"first\" and \"second\"; of copies take those that keep its grid";
  return text;
}

struct FoundParts {
  BroughtTogether all;
  bool too_few = false;
};

/// What is found of each exemplar by itself or, if those of one surface do not agree, of all of them together.
FoundParts found_parts(NodeContext& node, const Features& features, const std::vector<Rect>& places) {
  const ExemplarPlanes planes = weighted_planes(features, node.task());
  const std::vector<uint8_t> allowed = allowed_pixels(features);
  const auto brought = [&](std::vector<ExemplarView> views, const auto& lattice) {
    std::vector<ExemplarPart> parts;
    bool too_few = false;
    for (size_t i = 0; i < places.size(); i++) {
      const FoundLattice found = lattice(views[i]);
      parts.push_back({places[i], std::move(views[i]), found.lattice});
      too_few |= found.too_few;
    }
    return FoundParts{brought_together(parts, node.task()), too_few};
  };
  std::vector<ExemplarView> views;
  for (const Rect& place : places) views.push_back(view_of(planes, allowed, place));
  FoundParts apart = brought(std::move(views), [&](const ExemplarView& view) { return lattice_of(node, {view}); });
  if (!node.flag("alike") || apart.all.kinds < 2) return apart;
  views = views_at_one_scale(planes, allowed, places);
  const FoundLattice of_all = lattice_of(node, views);
  return of_all.lattice.rank > 0 ? brought(std::move(views), [&](const ExemplarView&) { return of_all; }) : apart;
}

void compute(NodeContext& node) {
  const auto features = node.input<Features>("features");
  const ImagePtr labels = node.optional_input<Image>("labels");
  if (node.text("mode") == "off") {
    node.output("features", features->with(Lattice{}));
    return;
  }
  FoundParts found =
      found_parts(node, *features,
                  labels ? places_of(labels, features->size(), node.task()) : std::vector{whole(features->size())});
  node.note(labels ? described(found.all) : described(found.all.parts.front().lattice));
  if (found.too_few)
    node.warn(
        "straight joints cross, but the exemplar shows too few tiles, or too unlike ones, to tell how they repeat, so "
        "that results may break them; crop it to whole tiles so that its borders fit, take one of more tiles, or give "
        "\"first\" and \"second\" with \"mode\": \"manual\"");
  node.output("features",
              features->with(labels ? Repeats(std::move(found.all.parts)) : Repeats(found.all.parts.front().lattice)));
}

std::vector<std::string> check(const Params& params) {
  if (std::get<std::string>(params.at("mode")) != "manual") return {};
  const auto& first = std::get<Numbers>(params.at("first"));
  const auto& second = std::get<Numbers>(params.at("second"));
  if (first.size() != 2)
    return {"\"first\": expected [x, y], the pixels after which the exemplar repeats, since mode is \"manual\""};
  if (!second.empty() && second.size() != 2) return {"\"second\": expected [x, y], or nothing for courses or columns"};
  if (manual_lattice(first, second).is_valid()) return {};
  if (second.empty())
    return {"\"first\": without \"second\", expected [0, height] for courses or [width, 0] for columns"};
  return {"\"second\": expected a direction other than that of \"first\""};
}

}  // namespace

NodeType regularity_node() {
  NodeType t;
  t.name = "regularity";
  t.version = 9;
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
       .help = "A lattice found with less certainty is not used.",
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
