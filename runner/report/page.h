#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/node/report.h"
#include "runner/report/pictures.h"

/// What all pages have in common: one HTML file with style and script inside, which shows everything without a
/// network, and all but the lit material without the script.
namespace terrazzo {

/// The files of runner/report/page.
extern const std::string_view page_style;
extern const std::string_view page_script;
extern const std::string_view viewer_script;

/// By which a page is known to be one; it stands in its head.
inline constexpr std::string_view page_mark = "<meta name=\"generator\" content=\"terrazzo\">";

/// Up to the heading and the line below it.
std::string page_head(const std::string& title, const std::string& below);
/// What the scripts read, and the scripts. `data` is JSON. `has_viewer`: the page lights materials.
std::string page_foot(const std::string& data, bool has_viewer);

/// A heading with something below it; nothing if that is empty. `id`: for links to it.
std::string section(const std::string& id, const std::string& heading, const std::string& content);

/// What is shown while the line above it is open.
std::string fold(const std::string& line, const std::string& content, bool open);

/// A list of HTML items, folded if they are many. `kind`: what one is, for the line above them.
std::string list_html(const std::vector<std::string>& items, const std::string& kind);

/// JSON as it stands in a script element: no "<", so nothing in it can end the element.
std::string json_in_script(const std::string& json);

/// A table of texts, the first row its head; a click on a head sorts by it. Rows are numbered in `data-row`.
std::string sortable_table(const std::vector<std::vector<std::string>>& rows);

/// A report's figures with bars, then its pictures; its title is left to the caller.
std::string report_html(const Report& report, PagePictures& pictures, int longest);

}  // namespace terrazzo
