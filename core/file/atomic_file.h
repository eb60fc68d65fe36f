#pragma once

#include <filesystem>
#include <string>

/// Files on their way to their place: written under a temporary name beside the target, then renamed.
namespace terrazzo {

/// Why `name` could not be written into `folder` (which need not exist yet), as a sentence; empty if nothing speaks
/// against it. An empty name stands for one that is not known yet. Tries it out, and leaves nothing behind.
std::string why_not_writable(const std::filesystem::path& folder, const std::string& name);

/// A name beside `target` that nobody else uses, with the target's extension: image libraries choose the format by it.
std::filesystem::path temporary_beside(const std::filesystem::path& target);

/// Removes what processes that were killed have left under names of `temporary_beside`: files of processes of this
/// host that no longer run, and of others if nothing has been written to them for a day. What cannot be removed stays.
void remove_abandoned(const std::filesystem::path& folder);

}  // namespace terrazzo
