#include "runner/report/html_report.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/text.h"
#include "core/file/atomic_file.h"
#include "core/image/color.h"
#include "core/image/image_file.h"

namespace terrazzo {

namespace {

constexpr int thumbnail_side = 256;
constexpr int sheet_side = 2048;

constexpr std::string_view style = R"(
  body { font: 15px/1.45 system-ui, sans-serif; margin: 2em auto; max-width: 72em; padding: 0 1em; color: #222; background: #fafafa }
  h1 { font-size: 1.5em } h2 { font-size: 1.15em; margin-top: 2em }
  table { border-collapse: collapse; width: 100% } td, th { text-align: left; padding: .25em .8em .25em 0; vertical-align: top; border-bottom: 1px solid #e2e2e2 }
  td.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap }
  .bar { background: #7a9cc6; height: .7em; min-width: 1px; display: inline-block } .failed { color: #b00020 } .quiet { color: #777 }
  figure { display: inline-block; margin: 0 1em 1em 0 } figcaption { font-size: .85em; color: #555 } img { display: block; image-rendering: auto; border: 1px solid #ddd }
  @media (prefers-color-scheme: dark) { body { color: #ddd; background: #1b1b1b } td, th { border-color: #383838 } img { border-color: #444 } .quiet, figcaption { color: #999 } }
)";

std::string_view shown(StageOutcome::Kind kind, bool sink) {
  constexpr std::array<std::string_view, 5> names = {"not asked for", "cached", "run", "failed", "not run"};
  return kind == StageOutcome::Kind::reused && sink ? "up to date" : names[static_cast<size_t>(kind)];
}

/// Each pixel of the result is the mean of the pixels it stands for.
ImagePtr shrunk(const ImagePtr& image, Size size, int channels) {
  const int from = image->channels(), common = std::min(from, channels);
  const auto to_small = [](int at, int all, int few) { return static_cast<int>(int64_t{at} * few / all); };
  std::vector<double> sums(static_cast<size_t>(size.area()) * channels, 0.0);
  std::vector<int> counts(static_cast<size_t>(size.area()), 0);
  for_each_strip(*image, [&](const Rect& region, const float* pixels) {
    for (int y = region.y; y < region.bottom(); y++)
      for (int x = 0; x < region.width; x++, pixels += from) {
        const size_t at = static_cast<size_t>(to_small(y, image->height(), size.height)) * size.width +
                          static_cast<size_t>(to_small(x, image->width(), size.width));
        counts[at]++;
        for (int c = 0; c < common; c++) sums[at * channels + c] += pixels[c];
      }
  });
  std::vector<float> out(sums.size());
  for (size_t i = 0; i < sums.size(); i++)
    out[i] = static_cast<float>(std::clamp(sums[i] / counts[i / channels], 0.0, 1.0));
  ImageInfo info{.size = size, .channels = channels, .semantic = image->info().semantic};
  info.color_space = image->info().color_space;
  return Image::from_floats(info, std::move(out));
}

std::string base64(const std::vector<uint8_t>& bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](size_t at) -> uint32_t { return at < bytes.size() ? bytes[at] : 0; };
    const uint32_t bits = byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2);
    for (size_t d = 0; d < 4; d++) out += i + d > bytes.size() ? '=' : digits[bits >> (18 - 6 * d) & 63];
  }
  return out;
}

/// The image as people see it, at most `longest` pixels a side: a PNG as a data URI. Colours are shown in sRGB; values
/// outside [0, 1] are clipped; two channels are shown as red and green. Pulls every pixel once.
std::string thumbnail_uri(const ImagePtr& image, int longest) {
  const Size full = image->size();
  const double scale = std::min(1.0, static_cast<double>(longest) / std::max(full.width, full.height));
  const Size size = {std::max(1, static_cast<int>(full.width * scale)),
                     std::max(1, static_cast<int>(full.height * scale))};
  ImagePtr small = shrunk(image, size, image->channels() == 1 ? 1 : 3);
  if (small->info().color_space != "raw") small = convert_color(small, "srgb_texture");
  return "data:image/png;base64," + base64(png_of(*small));
}

std::string picture(const std::string& caption, const ImagePtr& image, int longest = thumbnail_side) {
  return fmt::format("<figure><img src=\"{}\" alt=\"{}\"><figcaption>{}, {}&times;{}</figcaption></figure>\n",
                     thumbnail_uri(image, longest), markup(caption), markup(caption), image->width(), image->height());
}

std::string report_html(const Report& report, int longest = thumbnail_side) {
  std::string out = fmt::format("<h3>{}</h3>\n<table>\n", markup(report.title()));
  for (const Report::Figure& f : report.figures()) {
    const std::string value = std::holds_alternative<double>(f.value) ? fmt::format("{:.4g}", std::get<double>(f.value))
                                                                      : std::get<std::string>(f.value);
    out += fmt::format("<tr><td>{}</td><td class=number>{}</td><td class=quiet>{}</td></tr>\n", markup(f.name),
                       markup(value), markup(f.help));
  }
  out += "</table>\n";
  for (const Report::Picture& p : report.pictures()) out += picture(p.name, p.image, longest);
  return out;
}

std::string page_head(const std::string& title) {
  return fmt::format(
      "<!doctype html>\n<html lang=en><meta charset=utf-8><meta name=viewport content=\"width=device-width\">\n"
      "<title>{0}</title>\n<style>{1}</style>\n<h1>{0}</h1>\n",
      markup(title), style);
}

struct ShowValue {
  const std::string& name;
  std::string operator()(const ImagePtr& image) const { return picture(name, image); }
  std::string operator()(const MaterialPtr& material) const {
    std::string out;
    for (const Map& m : material->maps()) out += picture(m.name, m.image);
    return out;
  }
  std::string operator()(const ReportPtr& report) const { return report_html(*report); }
  template <typename Other>
  std::string operator()(const Other&) const {
    return "";
  }
};

std::string values_html(const RunResult& result) {
  std::string out;
  for (const StageOutcome& s : result.stages) {
    const auto kept = result.kept.find(s.node);
    if (kept == result.kept.end()) continue;
    for (const auto& [port, value] : kept->second) {
      const std::string name = kept->second.size() > 1 ? s.node + "." + port : s.node;
      const std::string shown = std::visit(ShowValue{name}, value);
      if (!shown.empty()) out += fmt::format("<h2>{}</h2>\n{}", markup(name), shown);
    }
  }
  return out;
}

std::string stages_html(const Plan& plan, const RunResult& result) {
  double longest = 1e-6;
  for (const StageOutcome& s : result.stages) longest = std::max(longest, s.seconds);
  std::string out = "<table>\n<tr><th>node<th>type<th>what it did<th>seconds<th><th>why</tr>\n";
  for (size_t i = 0; i < plan.stages.size(); i++) {
    const Stage& stage = plan.stages[i];
    const StageOutcome& s = result.stages[i];
    const bool ran = s.kind == StageOutcome::Kind::run;
    out += fmt::format(
        "<tr{}><td>{}</td><td>{}</td><td>{}</td><td class=number>{}</td><td style=\"width:12em\"><span class=bar "
        "style=\"width:{:.1f}em\"></span></td><td class=quiet>{}</td></tr>\n",
        s.kind == StageOutcome::Kind::failed ? " class=failed" : "", markup(s.node), markup(stage.type().name),
        stage.needed ? shown(s.kind, stage.type().is_sink()) : "not needed",
        ran ? fmt::format("{:.2f}", s.seconds) : "", 12 * s.seconds / longest, markup(stage.reason));
  }
  return out + "</table>\n";
}

std::string lists_html(const RunResult& result) {
  std::string notes, files;
  for (const StageOutcome& s : result.stages) {
    for (const std::string& n : s.notes)
      notes += fmt::format("<li{}>{}: {}</li>\n", is_warning(n) ? " class=failed" : "", markup(s.node), markup(n));
    for (const OutputFile& f : s.files) files += fmt::format("<li>{}</li>\n", markup(f.path.string()));
  }
  std::string out;
  if (!notes.empty()) out += "<h2>Notes</h2>\n<ul>\n" + notes + "</ul>\n";
  if (!files.empty()) out += "<h2>Files</h2>\n<ul>\n" + files + "</ul>\n";
  return out;
}

}  // namespace

std::vector<std::string> nodes_for_report(const Graph& graph, const std::vector<std::string>& only) {
  std::vector<std::string> names;
  const auto add = [&](const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  for (const GraphNode& n : graph.nodes) {
    const auto is_meant = [&](const std::string& name) { return stands_for(name, n.name); };
    const bool target = only.empty() ? n.type->is_sink() : std::ranges::any_of(only, is_meant);
    if (!target) continue;
    if (n.type->is_sink())
      for (const auto& [port, wires] : n.inputs)
        for (const Wire& w : wires) add(w.node);
    if (!n.type->outputs.empty()) add(n.name);
  }
  return names;
}

void write_html_report(const Plan& plan, const RunResult& result, const std::filesystem::path& path) {
  const std::string title = plan.graph->summary.empty() ? plan.graph->file.filename().string() : plan.graph->summary;
  std::string page = page_head(title);
  page += fmt::format("<p>{}<br><span class=quiet>{}</span></p>\n", markup(result.summary()),
                      markup(plan.graph->file.string()));
  for (const Failure& f : result.failures) page += fmt::format("<p class=failed>{}</p>\n", markup(f.message));
  for (const StageOutcome& s : result.stages)
    for (const std::string& n : s.notes)
      if (is_warning(n)) page += fmt::format("<p class=failed>{}: {}</p>\n", markup(s.node), markup(n));
  page += values_html(result);
  page += "<h2>Stages</h2>\n" + stages_html(plan, result);
  page += lists_html(result);
  write_whole_file(path, page);
}

void write_report_page(const Report& report, const std::filesystem::path& path) {
  write_whole_file(path, page_head("terrazzo: " + report.title()) + report_html(report, sheet_side));
}

}  // namespace terrazzo
