#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/node/value.h"

namespace terrazzo::test {

/// What an output holds: every bit of it as a digest, and a few figures that say roughly what it looks like.
struct Content {
  Digest digest;
  double mean = 0, deviation = 0;
  std::vector<double> samples;  ///< at places that depend on nothing but how many numbers there are
};

/// Of every pixel and number in the value. Computed images are pulled: their own digest is that of their recipe and
/// says nothing about pixels.
Content content_of(const Value& value);

/// Of what a sink wrote: images are decoded and analyses read, since the libraries that compress them may change; of
/// other files the bytes count.
Content content_of_file(const std::filesystem::path& path);

/// The versions of the libraries that decode, encode and convert pixels, on one line.
std::string library_versions();

}  // namespace terrazzo::test
