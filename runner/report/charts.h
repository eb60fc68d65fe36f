#pragma once

#include <string>
#include <vector>

#include "runner/engine/schedule.h"
#include "runner/report/pictures.h"

/// Charts as HTML and SVG, coloured by the page's style.
namespace terrazzo {

/// One curve filled behind another: how often values from dark to bright occur. `reference` may be null.
std::string histogram_svg(const Histogram* reference, const Histogram& values);

/// A line for each stage that a worker was busy with, bars over a time axis; only the longest if there are very many.
/// Empty if nothing ran.
std::string times_html(const RunResult& result);

}  // namespace terrazzo
