#include "runner/report/charts.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/text.h"

namespace terrazzo {

namespace {

constexpr double chart_width = 256, chart_height = 80;
constexpr size_t most_lines = 80;

/// Heights are square roots: rare values still show.
std::string curve(const Histogram& h, double scale) {
  std::string out;
  for (size_t i = 0; i < h.size(); i++)
    out += fmt::format(" {:.1f},{:.1f}", chart_width * (double(i) + 0.5) / double(h.size()),
                       chart_height - 2 - (chart_height - 6) * std::sqrt(double(h[i]) / scale));
  return out;
}

std::string polyline(std::string_view kind, const Histogram& h, double scale) {
  return fmt::format("<polygon class=\"{}\" points=\"0,{} {} {},{}\"/>", kind, chart_height, curve(h, scale),
                     chart_width, chart_height);
}

struct Line {
  std::string node;
  double busy = 0, start = 0;
  std::vector<const Span*> spans;
};

std::vector<Line> lines_of(const RunResult& result) {
  std::vector<Line> all(result.stages.size());
  for (const Span& s : result.spans) {
    if (s.what == "begin" || s.stage < 0) continue;
    Line& line = all[static_cast<size_t>(s.stage)];
    line.start = line.spans.empty() ? s.start : std::min(line.start, s.start);
    line.busy += s.end - s.start;
    line.spans.push_back(&s);
  }
  for (size_t i = 0; i < all.size(); i++) all[i].node = result.stages[i].node;
  std::erase_if(all, [](const Line& l) { return l.spans.empty(); });
  std::ranges::stable_sort(all, std::greater(), &Line::busy);
  if (all.size() > most_lines) all.resize(most_lines);
  std::ranges::stable_sort(all, std::less(), &Line::start);
  return all;
}

/// 1, 2 or 5 times a power of ten, for about four to ten steps.
double step_for(double seconds) {
  const double power = std::pow(10, std::floor(std::log10(seconds / 4)));
  for (const double factor : {5.0, 2.0})
    if (seconds / (power * factor) >= 4) return power * factor;
  return power;
}

std::string axis(double seconds) {
  std::string out = "<div class=\"axis\"><span></span><div class=\"track\">";
  const double step = step_for(seconds);
  for (double t = 0; t < seconds * 0.97; t += step)
    out += fmt::format("<i style=\"left:{:.2f}%\">{:.4g} s</i>", 100 * t / seconds, t);
  return out + "</div><span></span></div>\n";
}

std::string line_html(const Line& line, double seconds) {
  std::string out = fmt::format("<div><span title=\"{0}\">{0}</span><div class=\"track\">", markup(line.node));
  for (const Span* s : line.spans)
    out += fmt::format("<b class=\"{}\" title=\"{}, {:.3f} s\" style=\"left:{:.3f}%;width:{:.3f}%\"></b>",
                       s->what == "look up" ? "load" : s->what, s->what, s->end - s->start, 100 * s->start / seconds,
                       100 * (s->end - s->start) / seconds);
  return out + fmt::format("</div><span class=\"number\">{:.2f} s</span></div>\n", line.busy);
}

}  // namespace

std::string histogram_svg(const Histogram* reference, const Histogram& values) {
  float most = *std::ranges::max_element(values);
  if (reference) most = std::max(most, *std::ranges::max_element(*reference));
  const double scale = std::max(1e-6, double(most));
  std::string out = fmt::format(
      "<svg class=\"histogram\" viewBox=\"0 0 {} {}\" role=\"img\"><title>how often values "
      "occur, from 0 to 1{}</title>",
      chart_width, chart_height, reference ? "; filled: the exemplar, line: the result" : "");
  if (reference) out += polyline("reference", *reference, scale);
  return out + polyline("values", values, scale) + "</svg>\n";
}

std::string times_html(const RunResult& result) {
  const std::vector<Line> lines = lines_of(result);
  double seconds = 0;
  for (const Span& s : result.spans) seconds = std::max(seconds, s.end);
  if (lines.empty() || seconds <= 0) return "";
  std::string out =
      "<p class=\"quiet legend\"><b class=\"run\"></b> run <b class=\"load\"></b> look up or load <b "
      "class=\"store\"></b> "
      "store <b class=\"wait\"></b> wait for another process</p>\n<div class=\"long times\">\n" +
      axis(seconds);
  for (const Line& l : lines) out += line_html(l, seconds);
  out += "</div>\n";
  if (lines.size() == most_lines)
    out += fmt::format("<p class=\"quiet\">Only the {} longest are shown.</p>\n", most_lines);
  return out;
}

}  // namespace terrazzo
