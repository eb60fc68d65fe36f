#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/node/report.h"
#include "runner/report/pictures.h"

/// The parts common to all pages. A page is one HTML file with embedded style and scripts. It needs no network, and
/// without scripts shows everything but the lit material.
namespace terrazzo {

/// The files of runner/report/page.
extern const std::string_view page_style;
extern const std::string_view page_script;
extern const std::string_view viewer_script;

/// Identifies a page; part of its head.
inline constexpr std::string_view page_mark = "<meta name=\"generator\" content=\"terrazzo\">";

/// The page up to the heading and the line below it.
std::string page_head(const std::string& title, const std::string& below);
/// The scripts and their data. `data`: JSON. `has_viewer`: the page shows lit materials.
std::string page_foot(const std::string& data, bool has_viewer);

/// A heading with content; empty if the content is empty. `id`: for links.
std::string section(const std::string& id, const std::string& heading, const std::string& content);

/// A collapsible section: `content` shows while `line` is open.
std::string fold(const std::string& line, const std::string& content, bool open);

/// A list of HTML items, collapsed if there are many. `kind`: the kind of item, for the line above them.
std::string list_html(const std::vector<std::string>& items, const std::string& kind);

/// Escapes JSON for a script element: without "<" it cannot end the element.
std::string json_in_script(const std::string& json);

/// A table of texts with a header row; a click on a header sorts by that column. Rows are numbered in `data-row`.
std::string sortable_table(const std::vector<std::vector<std::string>>& rows);

/// A report's figures with bars, then its pictures, without its title.
std::string report_html(const Report& report, PagePictures& pictures, int longest);

}  // namespace terrazzo
