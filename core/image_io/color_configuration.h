#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/base/hash.h"
#include "core/image_io/image_libraries.h"

namespace terrazzo {

/// A configuration in which names of colour spaces mean something.
struct Configuration {
  std::shared_ptr<const ColorConfiguration> config;
  std::string where;  ///< for messages
  Digest identity;    ///< of all that decides what its names mean: its text, the files it names, the environment
};

/// `given`: path of an OpenColorIO configuration; empty for $OCIO, or the built-in one if that is not set. It is read
/// again when something has changed that it depends on. Throws Error if it cannot be read, or if it or a file it names
/// is no regular file or may not be read (ReadGuard): OpenColorIO would wait for a pipe without end. Thread-safe.
Configuration color_configuration(const std::string& given);

/// See color_config_files in core/image_io/color.h. Notes the variables that count (VariablesRead).
std::vector<std::filesystem::path> files_of_configuration(const std::string& given);

/// The conversion in that configuration. Throws Error.
ColorConfiguration::Conversion color_conversion(const Configuration& c, const std::string& from, const std::string& to);

}  // namespace terrazzo
