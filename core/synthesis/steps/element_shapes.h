#pragma once

#include <cstdint>
#include <vector>

#include "core/base/geometry.h"
#include "core/exemplar/elements.h"

namespace terrazzo {

/// What a place of an element offers to look at when only a few are compared.
struct ElementSample {
  int16_t x = 0, y = 0;  ///< from the element's centre, in blocks
  float depth = 0;
};

/// An element as a shape on a grid of blocks of `block` x `block` pixels of the exemplar.
struct ElementShape {
  int centre_x = 0, centre_y = 0;  ///< a block of the exemplar
  /// The blocks for which depths are known: those of the element and of a margin around it. From its centre.
  Rect box;
  /// For each of them the distance to the element's outline, in blocks: positive inside, the middle of the joint is 0.
  std::vector<float> depths;
  std::vector<ElementSample> samples;  ///< some of its blocks, evenly
  std::vector<ElementSample> outline;  ///< some of the blocks along its outline, on both sides
  int64_t area = 0;                    ///< blocks
  float inner_radius = 0;              ///< the greatest depth
  bool cut = false;                    ///< touched by the border of an exemplar that does not tile
  /// Cut by the exemplar's border or by a mask, or so much longer or more ragged than the others that it must be
  /// several whose joints were missed.
  bool unusable = false;

  /// (x, y) from the centre; far outside if it is not in the box.
  float depth(int x, int y) const {
    x -= box.x;
    y -= box.y;
    return x < 0 || y < 0 || x >= box.width || y >= box.height ? unknown_depth
                                                               : depths[size_t(y) * size_t(box.width) + size_t(x)];
  }
  /// The same between blocks.
  double depth_between(double x, double y) const;
  static constexpr float unknown_depth = -1e6f;
};

/// An element of the exemplar somewhere in the result: position + shift is the exemplar pixel that is shown there, in
/// pixels of the finest level.
struct PlacedElement {
  int element = 0;
  int shift_x = 0, shift_y = 0;
  double clear = 1;    ///< the share of it that lies on no other
  bool stays = false;  ///< part of it is kept: it is not taken away
  bool operator==(const PlacedElement&) const = default;
};

struct ElementShapes {
  int block = 1;
  std::vector<ElementShape> all;
  double typical_side = 0;  ///< of the element that a random block lies in, in blocks
  int whole = 0;            ///< elements that are usable

  const ElementShape& operator[](int element) const { return all[size_t(element)]; }
  /// Where the centre of an element lies in the result, in blocks.
  int column_of(const PlacedElement& p) const { return all[size_t(p.element)].centre_x - block_shift(p.shift_x); }
  int row_of(const PlacedElement& p) const { return all[size_t(p.element)].centre_y - block_shift(p.shift_y); }

 private:
  int block_shift(int shift) const { return shift >= 0 ? shift / block : -((-shift + block - 1) / block); }
};

/// `usable`: per pixel of the exemplar whether it may be shown; empty: all may.
ElementShapes element_shapes(const Elements& elements, const std::vector<uint8_t>& usable, int block, bool wraps);

}  // namespace terrazzo
