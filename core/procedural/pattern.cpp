#include "core/procedural/pattern.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/procedural/finish.h"
#include "core/procedural/labels.h"
#include "core/procedural/pattern_types.h"

namespace terrazzo {

const std::vector<PatternType>& pattern_types() {
  static const std::vector<PatternType> types = {
      bricks_pattern(),       cobbles_pattern(),     weave_pattern(),   gravel_pattern(),         tiles_pattern(),
      planks_pattern(),       herringbone_pattern(), rubble_pattern(),  coursed_rubble_pattern(), ashlar_pattern(),
      crazy_paving_pattern(), slates_pattern(),      chevron_pattern(), plates_pattern(),         panels_pattern(),
      flagstones_pattern(),   sheet_metal_pattern()};
  return types;
}

const PatternType* find_pattern_type(std::string_view name) {
  for (const PatternType& t : pattern_types())
    if (t.name == name) return &t;
  return nullptr;
}

const Palette* find_palette(const PatternType& type, std::string_view name) {
  if (name.empty()) return &type.palettes.front();
  for (const Palette& p : type.palettes)
    if (p.name == name) return &p;
  return nullptr;
}

namespace {

/// A type and its specification, defaults filled in.
struct Chosen {
  const PatternType& type;
  const Palette& palette;
  PatternSpec spec;

  std::unique_ptr<Surface> surface() const {
    return type.make(Canvas(spec.size, spec.tileable, spec.seed), spec, palette);
  }
};

Chosen chosen(const PatternSpec& given) {
  const PatternType* type = find_pattern_type(given.type);
  if (!type) {
    std::string names;
    for (const PatternType& t : pattern_types()) names += (names.empty() ? "" : ", ") + t.name;
    throw Error("kind", fmt::format("there is no pattern \"{}\"; there are {}", given.type, names));
  }
  const Palette* palette = find_palette(*type, given.palette);
  if (!palette) {
    std::string names;
    for (const Palette& p : type->palettes) names += (names.empty() ? "" : ", ") + p.name;
    throw Error("palette", fmt::format("{} have no palette \"{}\"; there are {}", type->name, given.palette, names));
  }
  PatternSpec spec = given;
  if (spec.scale <= 0) spec.scale = type->scale;
  return {*type, *palette, spec};
}

}  // namespace

MaterialPtr make_pattern(const PatternSpec& given, const Task& task) {
  const Chosen pattern = chosen(given);
  const PatternSpec& spec = pattern.spec;
  const Finish finish{
      .size = spec.size,
      .wraps = spec.tileable,
      .relief = spec.relief * pattern.type.depth * spec.size.width / spec.scale,
      .reach = 0.35 * spec.size.width / spec.scale,
      .cavity = pattern.type.cavity,
  };
  return finished_material(pattern.type.name, *pattern.surface(), finish, task);
}

ImagePtr pattern_labels(const PatternSpec& given, const Task& task) {
  const Chosen pattern = chosen(given);
  return element_labels(*pattern.surface(), pattern.spec.size, pattern.spec.tileable, task);
}

}  // namespace terrazzo
