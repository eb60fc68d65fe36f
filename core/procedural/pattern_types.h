#pragma once

#include <memory>

#include "core/procedural/pattern_type.h"

/// One function per pattern type, each defined in the file of its name.
namespace terrazzo {

template <typename T>
std::unique_ptr<Surface> make_surface(const Canvas& canvas, const PatternSpec& spec, const Palette& palette) {
  return std::make_unique<T>(canvas, spec, palette);
}

PatternType bricks_pattern();
PatternType cobbles_pattern();
PatternType weave_pattern();
PatternType gravel_pattern();
PatternType tiles_pattern();
PatternType planks_pattern();
PatternType herringbone_pattern();
PatternType rubble_pattern();
PatternType coursed_rubble_pattern();
PatternType ashlar_pattern();
PatternType crazy_paving_pattern();
PatternType slates_pattern();
PatternType chevron_pattern();
PatternType plates_pattern();
PatternType panels_pattern();
PatternType flagstones_pattern();
PatternType sheet_metal_pattern();

}  // namespace terrazzo
