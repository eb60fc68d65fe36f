#pragma once

#include <optional>
#include <string>
#include <string_view>

/// The envelope of the files in history/, whose content is defined in runner/plan/history.h: a first line with the
/// format, and a last line with a checksum for `cache verify`.
namespace terrazzo {

std::string sealed_history(std::string_view lines);
/// The lines in between; nullopt for another version of the format. Throws DamagedFile if the checksum is wrong.
/// Accepts versions without a checksum.
std::optional<std::string> unsealed_history(std::string_view bytes);

}  // namespace terrazzo
