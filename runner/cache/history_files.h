#pragma once

#include <optional>
#include <string>
#include <string_view>

/// The frame of the files in history/, which runner/plan/history.h fills: a first line that names the format, and a
/// last one with a checksum, so that `cache verify` can tell whether they are sound.
namespace terrazzo {

std::string sealed_history(std::string_view lines);
/// The lines in between. None of another version of the format; throws DamagedFile if the bytes are not as they were
/// written. Versions without a checksum are believed.
std::optional<std::string> unsealed_history(std::string_view bytes);

}  // namespace terrazzo
