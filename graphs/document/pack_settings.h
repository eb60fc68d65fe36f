#pragma once

#include <filesystem>
#include <vector>

#include "graphs/document/nodes.h"

namespace terrazzo {

/// An unpacked pack's settings for its inputs, except those replaced by `others`: overriding a parameter also drops the
/// inputs derived from it.
std::vector<Override> pack_settings(const std::filesystem::path& pack, const std::vector<Override>& others,
                                    std::vector<Problem>& problems);

/// Problems for files that a pack's nodes would write outside `folder` and outside the paths set by `given`, the
/// overrides that do not come from the pack.
std::vector<Problem> writes_elsewhere(const Drafts& drafts, const std::filesystem::path& folder,
                                      const std::vector<Override>& given);

}  // namespace terrazzo
