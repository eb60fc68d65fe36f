#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/image/image.h"

/// Image files as the program reads them.
namespace terrazzo::test {

struct ReadImage {
  ImagePtr image;
  std::string warnings;  ///< a line each
  std::vector<float> pixels() const { return image->pixels(); }
};

ReadImage read_with_warnings(const std::filesystem::path& path, Semantic semantic = Semantic::data);

/// The message of the Error that reading the file throws; empty if it throws none.
std::string read_error(const std::filesystem::path& path, Semantic semantic = Semantic::data);

}  // namespace terrazzo::test
