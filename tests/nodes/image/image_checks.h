#pragma once

#include <functional>
#include <string>

#include "tests/run_node.h"

/// What every node that makes images must keep.
namespace terrazzo::test {

/// Values that look random, in [0, 1), in steps of 1/255.
ImagePtr noise_image(Size size, int channels, Semantic semantic = Semantic::data,
                     const std::string& color_space = "raw", unsigned seed = 1);
/// Every pixel the same.
ImagePtr flat_image(Size size, const std::vector<float>& pixel, Semantic semantic = Semantic::data,
                    const std::string& color_space = "raw");
/// The image under another depth.
ImagePtr with_depth(const ImagePtr& image, Depth depth);

/// Runs a node of one image or material output on named images.
ImagePtr run_image(const std::string& type, const Params& params, const std::map<std::string, ImagePtr>& inputs);

/// The message of the Error that a node must throw; fails the test if it throws none. `about` must name the port or
/// parameter to blame.
std::string error_of(const std::string& type, const Params& params, const std::map<std::string, ImagePtr>& inputs,
                     const std::string& about);

/// Fails unless the image is the same bit for bit when read whole and in small odd tiles.
void check_tiles_agree(const Image& image);

/// Makes images of 1x1, 3x5 and 37x23 pixels; each must be finite, the same in tiles and as a whole, and the same on
/// one thread and on four. Tiles of `make`'s inputs are whatever it chooses for the size it is given.
void check_every_size(const std::function<ImagePtr(Size)>& make);

/// The largest difference between two images of the same size and channels.
double greatest_difference(const Image& a, const Image& b);

}  // namespace terrazzo::test
