#pragma once

#include <memory>
#include <vector>

#include "core/base/task.h"
#include "core/exemplar/features.h"
#include "core/exemplar/streaks.h"
#include "core/image/float_planes.h"
#include "core/image/image_facts.h"

namespace terrazzo {

/// The features' weighted channels. Images are first normalised to unit total variance, so that weights are comparable,
/// but nearly constant ones by no more than 8-bit noise allows. Masked-out pixels do not count there, and keep their
/// values. Throws Cancelled.
Planes unmasked_planes(const Features& features, const Task& task);

/// Gives masked-out pixels what the nearest allowed pixel has, so that they do not show through at coarse levels.
void fill_masked(Planes& planes, const Features& features);

/// Both. Shared with those who have asked for the same before and still hold them. Thread-safe.
std::shared_ptr<const Planes> weighted_planes(const Features& features, const Task& task);

/// The same for guidance images (signed feature distances, control maps), which share one weight. Throws Error about
/// "guidance" unless they have the features' size.
Planes guidance_planes(const Features& features, const std::vector<ImagePtr>& guidance, const Task& task);
/// Throws that for one image that certainly has another size.
void require_guidance(const ImageFacts& image, std::optional<Size> features);

/// A part of the planes; it clamps at its border, unless it is all of them.
Planes cropped(const Planes& planes, const Rect& part);

/// Half the size (rounded up), filtered with the binomial kernel 1 3 3 1 in each direction. Normals are not
/// renormalised: their length measures how much they agree.
Planes halved(const Planes& planes);

/// The mean of each so many pixels, along streaks. What is left over at the right or the bottom is left out.
Planes shortened(const Planes& planes, const Streaks& streaks);

/// The pixels' values along the first principal component of all channels. Throws Cancelled.
std::vector<float> leading_component(const Planes& planes, const Task& task);

}  // namespace terrazzo
