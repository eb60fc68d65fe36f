#pragma once

#include <filesystem>

namespace terrazzo::test {

/// Writes the images that golden documents read into the folder. They are drawn here, by whole numbers and plain
/// arithmetic, so that no change of a node changes what others are given:
///   wall, wall2/      bricks: base_color, normal, height (16 bit), roughness, ambient_occlusion
///   blend/            ground that goes from dark to light: base_color and height
///   photo/            base_color: a corner of a picture in examples/pictures
///   mask, holes, labels, layout, ramp .png   for wall and results made of it
///   uv.png            a uv map of an exemplar of wall's size
///   odd/              files that our own writer never makes, and awkward values
void write_golden_inputs(const std::filesystem::path& folder);

}  // namespace terrazzo::test
