#pragma once

#include <cstdint>
#include <vector>

#include "core/exemplar/appearance.h"
#include "core/synthesis/state/correction_level.h"
#include "core/synthesis/state/field.h"
#include "core/synthesis/steps/element_shapes.h"

namespace terrazzo {

/// An element that a field shows somewhere, and how many of its blocks do.
struct ShownElement {
  PlacedElement placed;
  int64_t blocks = 0;
  int64_t kept = 0;  ///< of them, those that are kept
};

/// Which elements a field shows, and where. Borrows the field, which may change meanwhile, and the level. Thread-safe.
class ElementPlaces {
 public:
  ElementPlaces(const Field& field, const CorrectionLevel& level, const Appearance& appearance);

  const ElementShapes& shapes() const { return shapes_; }

  /// The element that a block of the field shows, shifted by as much as that shows it; it comes out in one piece where
  /// the exemplar tiles.
  PlacedElement element_at(int column, int row) const;
  /// Of each element the places where the field shows it. Those next to one another are one: that of the most blocks.
  std::vector<std::vector<ShownElement>> shown() const;
  /// Of the places of an element the one that a block which shows it there belongs to; null: none.
  const ShownElement* find(const std::vector<ShownElement>& places, const PlacedElement& at) const;
  /// What a block of the field shows if it begins with exemplar pixel (x, y), which may lie outside.
  ExemplarPixel inside(int x, int y) const;

 private:
  const Field& field_;
  const CorrectionLevel& level_;
  const Elements& elements_;
  bool wraps_;
  ElementShapes shapes_;
};

}  // namespace terrazzo
