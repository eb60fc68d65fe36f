#include "runner/report/page.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/text.h"
#include "nodes/sink/export_report.h"

namespace terrazzo {

namespace {

/// A bar from 0 to the value, on a scale to 1, which is marked, or to the value if that is larger. Negative figures
/// have no bar.
std::string bar(double value) {
  if (!std::isfinite(value) || value < 0) return "";
  const double scale = std::max(1.0, value);
  return fmt::format("<span class=\"bar\"><span style=\"width:{:.1f}%\"></span><i style=\"left:{:.1f}%\"></i></span>",
                     100 * value / scale, 100 / scale);
}

std::string figure_row(const Report::Figure& f) {
  const double* number = std::get_if<double>(&f.value);
  return fmt::format(
      "<tr><td>{}</td><td class=\"number\">{}</td><td class=\"bars\">{}</td><td class=\"quiet\">{}</td></tr>\n",
      markup(f.name), number ? fmt::format("{:.4g}", *number) : markup(value_text(f)), number ? bar(*number) : "",
      markup(f.help));
}

}  // namespace

std::string page_head(const std::string& title, const std::string& below) {
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n{3}\n"
      "<meta name=\"viewport\" content=\"width=device-width\">\n<meta name=\"color-scheme\" content=\"light dark\">\n"
      "<title>{0}</title>\n<style>\n{1}</style>\n</head>\n<body>\n<h1>{0}</h1>\n{2}",
      markup(title), page_style, below, page_mark);
}

std::string page_foot(const std::string& data, bool has_viewer) {
  std::string out = fmt::format("<script type=\"application/json\" id=\"data\">{}</script>\n", json_in_script(data));
  if (has_viewer) out += fmt::format("<script>\n{}</script>\n", viewer_script);
  return out + fmt::format("<script>\n{}</script>\n</body>\n</html>\n", page_script);
}

std::string section(const std::string& id, const std::string& heading, const std::string& content) {
  if (content.empty()) return "";
  return fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n{}</section>\n", id, markup(heading), content);
}

std::string fold(const std::string& line, const std::string& content, bool open) {
  return fmt::format("<details{}><summary>{}</summary>\n{}</details>\n", open ? " open" : "", line, content);
}

std::string list_html(const std::vector<std::string>& items, const std::string& kind) {
  constexpr size_t most_open = 30;
  if (items.empty()) return "";
  std::string out = "<ul class=\"searched\">\n";
  for (const std::string& item : items) out += fmt::format("<li>{}</li>\n", item);
  out += "</ul>\n";
  return items.size() > most_open ? fold(counted(int64_t(items.size()), kind), out, false) : out;
}

std::string json_in_script(const std::string& json) {
  std::string out;
  out.reserve(json.size());
  for (const char c : json)
    if (c == '<')
      out += "\\u003c";
    else
      out += c;
  return out;
}

std::string sortable_table(const std::vector<std::vector<std::string>>& rows) {
  if (rows.empty()) return "";
  std::string out = "<div class=\"scroll long\"><table class=\"sortable\">\n<thead><tr>";
  for (const std::string& name : rows.front()) out += fmt::format("<th>{}</th>", markup(name));
  out += "</tr></thead>\n<tbody>\n";
  for (size_t i = 1; i < rows.size(); i++) {
    out += fmt::format("<tr data-row=\"{}\">", i - 1);
    for (const std::string& cell : rows[i]) out += fmt::format("<td>{}</td>", markup(cell));
    out += "</tr>\n";
  }
  return out + "</tbody></table></div>\n";
}

std::string report_html(const Report& report, PagePictures& pictures, int longest) {
  std::string out;
  if (!report.figures().empty()) {
    out += "<div class=\"scroll\"><table class=\"figures\">\n";
    for (const Report::Figure& f : report.figures()) out += figure_row(f);
    out += "</table></div>\n";
  }
  for (const Report::Picture& p : report.pictures()) out += pictures.figure(pictures.add(p.image, longest), p.name);
  return out;
}

}  // namespace terrazzo
