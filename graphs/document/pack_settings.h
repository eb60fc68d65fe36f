#pragma once

#include <filesystem>
#include <vector>

#include "graphs/document/nodes.h"

namespace terrazzo {

/// What an unpacked pack says about its inputs, but for what one of `others` replaces: an input that is made from a
/// parameter goes with it.
std::vector<Override> pack_settings(const std::filesystem::path& pack, const std::vector<Override>& others,
                                    std::vector<Problem>& problems);

/// What the nodes of a pack would write outside of `folder` and of the paths that `given`, which does not come from the
/// pack, sets.
std::vector<Problem> writes_elsewhere(const Drafts& drafts, const std::filesystem::path& folder,
                                      const std::vector<Override>& given);

}  // namespace terrazzo
