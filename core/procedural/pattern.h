#pragma once

#include <string_view>
#include <vector>

#include "core/base/task.h"
#include "core/material/material.h"
#include "core/procedural/pattern_type.h"

/// Procedural exemplars: materials whose maps are derived from one surface and therefore agree.
namespace terrazzo {

/// All types, in a fixed order. Thread-safe.
const std::vector<PatternType>& pattern_types();
/// Null if there is no such type.
const PatternType* find_pattern_type(std::string_view name);
/// Null if the type has no such palette; the first for an empty name.
const Palette* find_palette(const PatternType& type, std::string_view name);

/// Makes base_color (8 bit, srgb_texture), normal (8 bit, green up), height (16 bit), roughness and ambient_occlusion
/// (8 bit), all of `spec.size`, with values that a file of their depth stores exactly. The same on every machine.
/// Throws Error naming the known types or palettes if the spec names an unknown one.
MaterialPtr make_pattern(const PatternSpec& spec, const Task& task);
/// The element labels of that material, see element_labels().
ImagePtr pattern_labels(const PatternSpec& spec, const Task& task);

}  // namespace terrazzo
