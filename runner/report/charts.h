#pragma once

#include <string>
#include <vector>

#include "runner/engine/schedule.h"
#include "runner/report/pictures.h"

/// Charts as HTML and SVG, styled by the page.
namespace terrazzo {

/// A histogram of values from dark to bright, drawn over that of `reference`, which may be null.
std::string histogram_svg(const Histogram* reference, const Histogram& values);

/// A timeline with one row per stage that a worker was busy with; only the longest if there are many. Empty if nothing
/// ran.
std::string times_html(const RunResult& result);

}  // namespace terrazzo
