#include "core/node/report.h"

namespace terrazzo {

ReportPtr Report::make(std::string title, std::vector<Figure> figures, std::vector<Picture> pictures) {
  Hasher h;
  h.add("report").add(title).add(int64_t(figures.size())).add(int64_t(pictures.size()));
  for (const Figure& f : figures) {
    h.add(f.name).add(f.help).add(int(f.value.index()));
    std::visit([&h](const auto& v) { h.add(v); }, f.value);
  }
  for (const Picture& p : pictures) h.add(p.name).add(p.image->digest());
  auto report = std::shared_ptr<Report>(new Report);
  report->title_ = std::move(title);
  report->figures_ = std::move(figures);
  report->pictures_ = std::move(pictures);
  report->digest_ = h.digest();
  return report;
}

}  // namespace terrazzo
