#pragma once

#include "core/analysis/repeats/seen_map.h"

/// Joints that run along a border: what they part need not fit together there.
namespace terrazzo {

/// Whether a line along one of the borders differs more from the map's means, by channel, than along itself.
bool has_joint_along_border(const SeenMap& map);

/// Whether the lines on both sides of the border, rows or columns, are a joint like another one inside: unlike most
/// lines, and like one.
bool is_joint_that_recurs(const SeenMap& map, bool rows);

/// Whether what changes across the border, from a few lines before it to a few after it, is as much as across some
/// line inside, and far more than across most: chequered tiles, whose means tell nothing.
bool is_step_that_recurs(const SeenMap& map, bool rows);

/// Whether the lines on both sides of the border differ more from the map's means than along themselves.
bool is_joint(const SeenMap& map, bool rows);

/// The same of a joint that comes nowhere else, as of panels in a single row.
bool is_joint_by_itself(const SeenMap& map, bool rows);

}  // namespace terrazzo
