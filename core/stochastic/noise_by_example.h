#pragma once

#include <array>
#include <cstdint>

#include "core/material/material.h"
#include "core/stochastic/triangle_grid.h"

namespace terrazzo {

/// Which part of which surface is made, and how.
struct NoiseByExample {
  Size size;                        ///< of the result, in pixels
  std::array<int64_t, 2> origin{};  ///< the position of its top left pixel on the surface, within 2^39 pixels of 0
  GridSurface surface{};            ///< after how many pixels the result repeats, and in which directions
  int cell = 1;                     ///< edge of the triangles, in pixels: 1..largest_cell()
  uint64_t seed = 1;
  bool exemplar_tiles = false;
};

/// The largest cell whose samples do not reach beyond the borders of an exemplar, or around it if it tiles; at least 1.
int largest_cell(Size exemplar, bool tiles);

/// A surface of an exemplar without structure, by tiling and blending (Heitz & Neyret, High-performance by-example
/// noise using a histogram-preserving blending operator, 2018; Deliot & Heitz, Procedural stochastic textures by tiling
/// and blending, 2019): samples of the exemplar at random places, one for each vertex of a triangle grid, are blended
/// in the Gaussianised, decorrelated space of all its maps (StochasticExemplar), and histograms are restored.
///
/// All maps show the same samples with the same weights, so they stay in agreement. Values stay within those that the
/// exemplar's channel has; normals have the lengths that the exemplar's have, mostly 1. Maps that hold labels (see
/// blends_samples) show the sample of the greatest weight. All maps get the result's size. Pixels are computed on
/// demand, and a pixel depends on its place on the surface alone: parts fit together to the bit, made on any machine
/// and in any order.
///
/// Throws Error if the maps differ in aspect ratio or hold values that are not finite; Cancelled.
MaterialPtr noise_by_example(const Material& exemplar, const NoiseByExample& options, const Task& task = {});

}  // namespace terrazzo
