#include "runner/report/html_report.h"

#include "core/file/atomic_file.h"
#include "runner/report/page.h"
#include "runner/report/run_page.h"

namespace terrazzo {

namespace {

constexpr int sheet_side = 2048, variation_side = 512;

}  // namespace

void write_html_report(const Plan& plan, const RunResult& result, const std::filesystem::path& path) {
  write_whole_file(path, RunPage(plan, result).html());
}

void write_report_page(const Report& report, const std::filesystem::path& path) {
  PagePictures pictures;
  write_whole_file(path, page_head("terrazzo: " + report.title(), "") + report_html(report, pictures, sheet_side) +
                             page_foot("{}", false));
}

void write_variations_page(const std::string& title, const std::vector<std::vector<std::string>>& table,
                           const std::vector<Report::Picture>& pictures, const std::filesystem::path& path) {
  const int side = side_for(pictures.size(), variation_side);
  PagePictures shown;
  std::string gallery = "<div class=\"gallery variations\">\n";
  for (const Report::Picture& p : pictures) gallery += shown.figure(shown.add(p.image, side), p.name);
  write_whole_file(path, page_head(title,
                                   "<p class=\"quiet\">A click on a head of the table sorts table and "
                                   "pictures by it, a click on a row shows its picture.</p>\n") +
                             section("table", "All", sortable_table(table)) +
                             section("pictures", "Pictures", gallery + "</div>\n") + page_foot("{}", false));
}

}  // namespace terrazzo
