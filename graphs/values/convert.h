#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/node/node.h"
#include "graphs/text/diagnostics.h"
#include "graphs/text/json.h"

/// Converts between JSON and parameter values, according to a parameter's descriptor.
namespace terrazzo {

/// Reads a parameter's value: checks type, range, choices and counts, and makes paths absolute (relative ones start at
/// `base`, an absolute folder) and lexically normal. Nullopt if there are problems, all of which are reported.
std::optional<ParamValue> read_param(const JsonValue& json, const Param& param, const std::filesystem::path& base,
                                     Diagnostics& diagnostics);

/// The default for a node, with absolute paths. The parameter must have one.
ParamValue default_of(const Param& param, const std::filesystem::path& base);

/// A value as JSON for a document, without a place.
JsonValue json_of(const ParamValue& value);

/// A value formatted for use inside a text: numbers in their shortest spelling, sizes as 512x256.
std::string text_of(const ParamValue& value);

/// Reads a parameter's value from the command line: as JSON if that has the right kind, else as plain text. Choices are
/// case-insensitive.
JsonValue read_command_line(const std::string& text, const Param& param);

/// Describes a parameter's valid values, for messages and the reference: "a number from 0 to 1".
std::string expectation(const Param& param);

}  // namespace terrazzo
