#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/node/node.h"
#include "graphs/text/diagnostics.h"
#include "graphs/text/json.h"

/// Between JSON and parameter values, by a parameter's descriptor.
namespace terrazzo {

/// The value that `json` gives the parameter: type, range, choices and counts checked, a path made absolute (relative
/// ones lie in `base`, an absolute folder) and normal. Empty after problems, all of which have been added.
std::optional<ParamValue> read_param(const JsonValue& json, const Param& param, const std::filesystem::path& base,
                                     Diagnostics& diagnostics);

/// The default as a node gets it: paths absolute. The parameter must have one.
ParamValue default_of(const Param& param, const std::filesystem::path& base);

/// A value as a document would write it; has no place.
JsonValue json_of(const ParamValue& value);

/// A value as it reads inside a longer text: numbers in their shortest spelling, sizes as 512x256.
std::string text_of(const ParamValue& value);

/// A value from the command line for a parameter: what it means as JSON if that has the right kind, else the text
/// itself, which for a choice may be in upper or lower case.
JsonValue read_command_line(const std::string& text, const Param& param);

/// What a parameter takes, for messages and the reference: "a number from 0 to 1".
std::string expectation(const Param& param);

}  // namespace terrazzo
