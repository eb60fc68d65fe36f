#include "core/analysis/repeats/part_lattices.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "core/analysis/repeats/cell_phase.h"
#include "core/analysis/space/mask_pyramid.h"
#include "core/base/error.h"
#include "core/image/image_facts.h"
#include "core/material/map_names.h"

namespace terrazzo {

namespace {

// By what share steps of two parts may differ; courses of one wall do not all have the same height.
constexpr double most_unlike_cells = 0.04, most_unlike_bands = 0.06;
constexpr int most_joined_cells = 4;  // of one lattice in a cell of another

bool are_alike(const Vector2d& a, const Vector2d& b, double unlike) {
  return (a - b).norm() <= unlike * b.norm();
}

/// The lattice that is part of `l` (of all its steps, or of some) and whose steps are like those of `model`.
std::optional<Lattice> stepping_like(const Lattice& model, const Lattice& l) {
  if (model.rank != l.rank || l.rank == 0) return {};
  const auto whole = [](double v) { return std::floor(v + 0.5); };
  Lattice out = l;
  if (l.rank == 1) {
    if ((l.first.x() != 0) != (model.first.x() != 0)) return {};
    const double steps = whole(l.cells(model.first).x());
    out.first = l.at({steps, 0});
    return std::abs(steps) >= 1 && std::abs(steps) <= most_joined_cells &&
                   are_alike(out.first, model.first, most_unlike_bands)
               ? std::optional(out)
               : std::nullopt;
  }
  const auto nearest = [&](const Vector2d& v) {
    const Vector2d cells = l.cells(v);
    return l.at({whole(cells.x()), whole(cells.y())});
  };
  out.first = nearest(model.first);
  out.second = nearest(model.second);
  const double cells = out.cell_area() / l.cell_area();
  if (cells < 0.5 || cells > most_joined_cells + 0.5) return {};
  const double unlike = most_unlike_cells;
  return are_alike(out.first, model.first, unlike) && are_alike(out.second, model.second, unlike) ? std::optional(out)
                                                                                                  : std::nullopt;
}

/// What two parts have in common, in the steps of each.
struct Common {
  Lattice of_model, of_part;
};

std::optional<Common> common(const Lattice& model, const Lattice& part) {
  if (const auto like = stepping_like(model, part)) return Common{model, *like};
  if (const auto like = stepping_like(part, model)) return Common{*like, part};
  return {};
}

/// A part that repeats and what it is shown as.
struct Joined {
  LatticePart& part;
  const ExemplarView& view;
};

Vector2d phase(const ExemplarPart& model, const Joined& joined, const Common& steps, const Task& task) {
  return steps.of_part.at(phase_between({model.view, steps.of_model}, {joined.view, steps.of_part}, task));
}

/// Shows a part as its model, if their cells are alike.
bool join_cells(const ExemplarPart& model, const Joined& joined, const Task& task) {
  LatticePart& part = joined.part;
  const auto steps = common(model.lattice, part.lattice);
  if (!steps) return false;
  part.lattice = steps->of_part;
  part.shown = steps->of_model;
  part.start = phase(model, joined, *steps, task);
  return true;
}

/// Gives a part its model's courses or columns, if they are alike.
bool join_bands(const ExemplarPart& model, const Joined& joined, const Task& task) {
  for (const bool courses : {true, false}) {
    LatticePart& part = joined.part;
    const auto steps = common(model.lattice.level_bands(courses), part.lattice.level_bands(courses));
    if (!steps) continue;
    part.start = phase(model, joined, *steps, task);
    const Vector2d &to = steps->of_model.first, &from = steps->of_part.first;
    for (Vector2d* v : {&part.shown.first, &part.shown.second})
      (courses ? v->y() : v->x()) *= courses ? to.y() / from.y() : to.x() / from.x();
    return true;
  }
  return false;
}

}  // namespace

BroughtTogether brought_together(const std::vector<ExemplarPart>& parts, const Task& task) {
  BroughtTogether out;
  std::vector<size_t> models;
  for (size_t i = 0; i < parts.size(); i++) {
    task.check();
    const Lattice& l = parts[i].lattice;
    out.parts.push_back({parts[i].place, l, l, {}});
    if (l.rank == 0) continue;
    const Joined joined{out.parts.back(), parts[i].view};
    const auto joins = [&](const auto& join) {
      return std::ranges::any_of(models, [&](size_t m) { return join(parts[m], joined, task); });
    };
    if (!joins(join_cells) && !joins(join_bands)) models.push_back(i);
  }
  out.kinds = models.size();
  return out;
}

void require_labels(const ImageFacts& labels, std::optional<Size> exemplar) {
  require_one_channel("labels", labels);
  if (labels.size && exemplar && *labels.size != *exemplar)
    throw Error("labels", fmt::format("expected the size of the exemplar in \"features\", {}, found {}",
                                      describe(*exemplar), describe(*labels.size)));
}

std::vector<Rect> label_places(const ImagePtr& labels, Size exemplar, const Task& task) {
  require_labels(facts_of(labels->info()), exemplar);
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

BroughtTogether find_part_lattices(const Features& features, const std::vector<Rect>& places,
                                   const LatticeFinder& finder, bool alike, const Task& task) {
  const std::shared_ptr<const Planes> held = weighted_planes(features, task);
  const Planes& planes = *held;
  const std::vector<uint8_t> allowed = allowed_pixels(features);
  const auto brought = [&](std::vector<ExemplarView> views, const auto& lattice) {
    std::vector<ExemplarPart> parts;
    bool too_few = false;
    for (size_t i = 0; i < places.size(); i++) {
      const FoundLattice found = lattice(views[i]);
      parts.push_back({places[i], std::move(views[i]), found.lattice});
      too_few |= found.too_few;
    }
    BroughtTogether all = brought_together(parts, task);
    all.too_few = too_few;
    return all;
  };
  std::vector<ExemplarView> views;
  for (const Rect& place : places) views.push_back(view_of(planes, allowed, place));
  BroughtTogether apart = brought(std::move(views), [&](const ExemplarView& view) { return finder({view}); });
  if (!alike || apart.kinds < 2) return apart;
  views = views_at_one_scale(planes, allowed, places);
  FoundLattice of_all = finder(views);
  return of_all.lattice.rank > 0 ? brought(std::move(views), [&](const ExemplarView&) { return of_all; }) : apart;
}

}  // namespace terrazzo
