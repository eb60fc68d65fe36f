#include "nodes/sink/export_report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace terrazzo {

namespace {

struct ShowValue {
  std::string operator()(double v) const { return fmt::format("{}", v); }
  std::string operator()(const std::string& v) const { return v; }
};

}  // namespace

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

std::string report_as_json(const Report& report) {
  nlohmann::ordered_json figures = nlohmann::ordered_json::array();
  for (const Report::Figure& f : report.figures()) {
    nlohmann::ordered_json figure;
    figure["name"] = f.name;
    std::visit([&](const auto& v) { figure["value"] = v; }, f.value);
    figure["help"] = f.help;
    figures.push_back(std::move(figure));
  }
  nlohmann::ordered_json pictures = nlohmann::ordered_json::array();
  for (const Report::Picture& p : report.pictures()) pictures.push_back(p.name);
  const nlohmann::ordered_json all = {{"title", report.title()}, {"figures", figures}, {"pictures", pictures}};
  return all.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::string report_as_csv(const Report& report) {
  std::string out = "name,value,help\n";
  for (const Report::Figure& f : report.figures())
    out += fmt::format("{},{},{}\n", csv_field(f.name), csv_field(std::visit(ShowValue{}, f.value)), csv_field(f.help));
  return out;
}

}  // namespace terrazzo
