#pragma once

#include "core/analysis/repeats/seen_map.h"

/// Joints that run along a border: what they part need not fit together there.
namespace terrazzo {

/// Whether a line along one of the borders differs more from the map's means, by channel, than along itself.
bool has_joint_along_border(const SeenMap& map);

/// Whether the lines on both sides of the border, rows or columns, are a joint like another one inside: unlike most
/// lines, and like one.
bool is_joint_that_recurs(const SeenMap& map, bool rows);

}  // namespace terrazzo
