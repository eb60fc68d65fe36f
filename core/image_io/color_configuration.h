#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/base/hash.h"
#include "core/image_io/image_libraries.h"

namespace terrazzo {

/// A loaded OpenColorIO configuration.
struct Configuration {
  std::shared_ptr<const ColorConfiguration> config;
  std::string where;  ///< for messages
  Digest identity;    ///< of everything that defines its spaces: its text, the files it names, the environment
};

/// `given`: path of an OpenColorIO configuration; empty for $OCIO, or the built-in one if that is not set. Reloads the
/// configuration when anything it depends on has changed. Throws Error if it cannot be read, or if it or a file it
/// names is not a regular file (OpenColorIO would wait on a pipe forever) or ReadGuard forbids it. Thread-safe.
Configuration color_configuration(const std::string& given);

/// See color_config_files in core/image_io/color.h. Records the environment variables it depends on (VariablesRead).
std::vector<std::filesystem::path> files_of_configuration(const std::string& given);

/// The conversion in that configuration. Throws Error.
ColorConfiguration::Conversion color_conversion(const Configuration& c, const std::string& from, const std::string& to);

}  // namespace terrazzo
