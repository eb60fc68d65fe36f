#pragma once

#include "core/material.h"
#include "core/uv_map.h"

namespace terrazzo {

/// The maps an output shows: each pixel is exactly the exemplar pixel that the uv map names. Lazy: a map is nothing but
/// uv map and exemplar until pixels are pulled. Maps whose size differs from the analysed exemplar's are sampled at the
/// same relative place. Throws Error if the uv map was made for an exemplar of another shape.
ImagePtr resolved(const ImagePtr& exemplar, const UvMapPtr& uv);
MaterialPtr resolved(const Material& exemplar, const UvMapPtr& uv);

}  // namespace terrazzo
