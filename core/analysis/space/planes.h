#pragma once

#include <vector>

#include "core/base/task.h"
#include "core/exemplar/features.h"
#include "core/image/float_planes.h"

namespace terrazzo {

/// Pulls the features' weighted channels. Every image is first brought to unit total variance, so that a weight of 1
/// means the same for each; nearly constant images are not blown up beyond what their 8-bit noise is worth. What the
/// features' mask forbids does not count; such pixels continue the nearest one that is allowed.
Planes weighted_planes(const Features& features, const Task& task);

/// The same for guidance images (signed feature distances, control maps), which come with one weight. They must have
/// the features' size.
Planes guidance_planes(const Features& features, const std::vector<ImagePtr>& guidance, const Task& task);

/// A part of the planes, whose borders continue unless it is all of them.
Planes cropped(const Planes& planes, const Rect& part);

/// Half the size (rounded up), filtered with the binomial kernel 1 3 3 1 in each direction. Normals are averaged as
/// vectors: their length then tells how much they agree.
Planes halved(const Planes& planes);

/// The planes' values along their first principal component: what all channels together vary in most. Throws Cancelled.
std::vector<float> leading_component(const Planes& planes, const Task& task);

}  // namespace terrazzo
