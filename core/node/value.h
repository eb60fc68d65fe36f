#pragma once

#include <array>
#include <string_view>
#include <variant>

#include "core/exemplar/uv_map.h"
#include "core/image/image.h"
#include "core/material/material.h"
#include "core/node/report.h"

namespace terrazzo {

// Forward declared, as their headers include Eigen.
class Features;
class Appearance;
class Index;
using FeaturesPtr = std::shared_ptr<const Features>;
using AppearancePtr = std::shared_ptr<const Appearance>;
using IndexPtr = std::shared_ptr<const Index>;

/// What travels on a wire; shared, never copied.
using Value = std::variant<ImagePtr, MaterialPtr, FeaturesPtr, AppearancePtr, IndexPtr, UvMapPtr, ReportPtr>;

/// In the order of Value's alternatives.
enum class ValueType : uint8_t { image, material, features, appearance, index, uv_map, report };

inline constexpr auto value_type_names =
    std::to_array<std::string_view>({"image", "material", "features", "appearance", "index", "uv_map", "report"});
static_assert(value_type_names.size() == std::variant_size_v<Value>, "each type of value has a name");
inline std::string_view name_of(ValueType type) {
  return value_type_names[static_cast<size_t>(type)];
}
inline ValueType type_of(const Value& value) {
  return static_cast<ValueType>(value.index());
}
const Digest& digest_of(const Value& value);

/// Whether a wire may connect the two: the same type, or the lossless image -> material of one map.
inline bool converts(ValueType from, ValueType to) {
  return from == to || (from == ValueType::image && to == ValueType::material);
}
/// `value` converted to the type `to`; `converts` must hold.
inline Value converted(const Value& value, ValueType to) {
  if (type_of(value) == to) return value;
  return Material::of(std::get<ImagePtr>(value));
}

}  // namespace terrazzo
