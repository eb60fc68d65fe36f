#include "core/base/hash.h"
#include "core/base/tuning.h"
#include "core/exemplar/element_courses.h"
#include "core/exemplar/element_lattice.h"
#include "core/synthesis/state/lattice_origin.h"
#include "core/synthesis/state/purpose.h"
#include "core/synthesis/steps.h"
#include "core/synthesis/steps/band_layout.h"
#include "core/synthesis/steps/element_layout.h"

namespace terrazzo {

namespace {

struct SharedWorkTuning {
  double surer = 0.5;
};
const Tunable<SharedWorkTuning> shared_work_tuning(
    "shared_work", {{&SharedWorkTuning::surer, "surer", "certainty",
                     "by which elements exceed their lattice that are laid without it. Higher: stones that vary are "
                     "torn; lower: straight rows bend",
                     "element_layout", -1, 1}});

/// Parts that repeat each in its own way keep to where they lie in the exemplar, and so does what controls place.
Vector2d lattice_start(const Repeats& repeats, const SynthesisOptions& o) {
  if (!repeats.parts.empty()) return {double(o.origin[0]), double(o.origin[1])};
  if (!o.kept.empty()) return lattice_origin(repeats.lattice, o.kept, o.size);
  if (!o.controls.empty()) return {};
  return random_lattice_origin(repeats.lattice, random_bits(o.seed, Purpose::first_cell));
}

/// Those that are laid anew. What keeps to a lattice of cells is in its place already, unless the cell is all of it.
ElementCourses courses_laid_anew(const Appearance& appearance, const SynthesisOptions& options) {
  const Lattice& l = appearance.lattice();
  const bool laid = options.whole_bricks && options.quality != Quality::draft && options.controls.empty();
  if (!laid || l.rank == 0 || !appearance.elements()) return {};
  if (l.rank == 2 && !l.is_single_cell(appearance.size()) && are_in_step(*appearance.elements(), l, appearance.wraps()))
    return {};
  return element_courses(*appearance.elements(), appearance.wraps());
}

std::vector<ShownSpan> bands_in_result(const ElementCourses& courses, Size exemplar, const SynthesisOptions& o) {
  return bands_of(courses, exemplar, {o.size, o.tile_x, o.tile_y}, o.kept, random_bits(o.seed, Purpose::courses));
}

/// How the exemplar repeats. Where controls say what goes where, a band that comes once does not: it may be one of the
/// parts that they tell apart.
Repeats repeats_of(const Appearance& appearance, const ElementCourses& courses, const SynthesisOptions& options) {
  if (!courses.empty()) return courses.lattice(appearance.size());
  const Lattice& l = appearance.lattice();
  return l.rank == 1 && l.comes_once(appearance.size()) && !options.controls.empty() ? Repeats() : appearance.repeats();
}

/// Whether the elements are surer than the lattice that they should keep to.
bool are_surer(const Elements& elements, const Lattice& lattice, bool wraps) {
  return elements.certainty - lattice.certainty >= shared_work_tuning->surer && !are_in_step(elements, lattice, wraps);
}

/// What keeps to a lattice is in its place already.
WholeElements whole_elements_of(const Appearance& appearance, const Repeats& repeats, const ElementCourses& courses,
                                const SynthesisOptions& options) {
  if (!options.whole_bricks || !courses.empty() || !has_elements(appearance)) return WholeElements::none;
  const Lattice& lattice = repeats.lattice;
  if (lattice.rank > 0 && !are_surer(*appearance.elements(), lattice, appearance.wraps()))
    return WholeElements::completed;
  return are_heaped(appearance) ? WholeElements::heaped : WholeElements::laid;
}

}  // namespace

Repeats repeats_in_result(const Appearance& appearance, const SynthesisOptions& options) {
  return repeats_of(appearance, courses_laid_anew(appearance, options), options);
}

bool lays_courses(const Appearance& appearance, const SynthesisOptions& options) {
  return !courses_laid_anew(appearance, options).empty();
}

bool repeats_fit(const Appearance& appearance, const SynthesisOptions& options) {
  const ElementCourses courses = courses_laid_anew(appearance, options);
  const Repeats repeats = repeats_of(appearance, courses, options);
  const auto is_unseen = [&](const Lattice& l) {
    return l.bent(options.size, options.tile_x, options.tile_y, options.size) <= l.unseen_bend();
  };
  if (courses.empty())
    return is_unseen(repeats.lattice) &&
           std::ranges::all_of(repeats.parts, [&](const LatticePart& part) { return is_unseen(part.shown); });
  return std::ranges::all_of(bands_in_result(courses, appearance.size(), options), [](const ShownSpan& b) {
    return std::abs(b.too_much()) <= std::max(1.0, Lattice().unseen_bend() * b.shown.length());
  });
}

Size level_size(Size output, int level) {
  const int round_up = (1 << level) - 1;
  return {(output.width + round_up) >> level, (output.height + round_up) >> level};
}

SharedWork::SharedWork(const Index& i, const SynthesisOptions& o, const Task& t)
    : index(i),
      options(o),
      task(t),
      levels(int(index.levels().size())),
      courses(courses_laid_anew(*index.appearance(), options)),
      repeats(repeats_of(*index.appearance(), courses, options)),
      lattice(repeats.lattice),
      bands(bands_in_result(courses, index.appearance()->size(), options)),
      gaps(options.kept.gaps(options.size)),
      origin(lattice_start(repeats, options)),
      controls(options.controls, index.appearance()->size(), exemplar(0).size, options.size, levels, task),
      elements(whole_elements_of(*index.appearance(), repeats, courses, options)) {}

Plane SharedWork::plane(int level) const {
  return {level_size(options.size, level), options.tile_x, options.tile_y};
}

double SharedWork::jitter(int level) const {
  const size_t order = size_t(levels - 1 - level);  // counted from the coarsest
  return order < options.jitter.size() ? options.jitter[order] : 0;
}

/// Kept pixels have the lattice as it is: it bends where none are kept or, where they leave no room and it does not
/// fit, is cut where the result wraps.
LatticeSurface SharedWork::surface() const {
  const bool fits = options.kept.empty() || lattice.fits(options.size, options.tile_x, options.tile_y);
  return {options.size,
          options.tile_x && (fits || gaps.x.length > 0),
          options.tile_y && (fits || gaps.y.length > 0),
          origin,
          gaps,
          bands};
}

LevelFacts SharedWork::facts(int level) const {
  return {.level = level,
          .levels = levels,
          .quality = options.quality,
          .regular = lattice.rank > 0,
          .kept = !options.kept.empty(),
          .steered = !controls.empty(),
          .bands = !bands.empty(),
          .elements = elements};
}

}  // namespace terrazzo
