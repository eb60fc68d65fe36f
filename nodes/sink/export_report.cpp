#include "nodes/sink/export_report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace terrazzo {

std::string value_text(const Report::Figure& figure) {
  const double* number = std::get_if<double>(&figure.value);
  return number ? fmt::format("{}", *number) : std::get<std::string>(figure.value);
}

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
    out += fmt::format("{},{},{}\n", csv_field(f.name), csv_field(value_text(f)), csv_field(f.help));
  return out;
}

}  // namespace terrazzo
