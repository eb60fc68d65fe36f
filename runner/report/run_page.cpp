#include "runner/report/run_page.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/text.h"
#include "core/picture/render/preview.h"
#include "graphs/tools/draw.h"
#include "graphs/values/convert.h"
#include "runner/report/charts.h"
#include "runner/report/page.h"
#include "runner/report/stage_table.h"
#include "runner/report/torn_pictures.h"

namespace terrazzo {

namespace {

constexpr int material_side = 1024, other_side = 512, report_side = 1600;
/// The limit per kind; a sweep may have hundreds.
constexpr size_t most_materials = 4;
constexpr size_t most_nodes = 24;

size_t image_count(const RunResult& result) {
  size_t count = 0;
  for (const auto& [node, ports] : result.kept)
    for (const auto& [port, value] : ports) {
      const MaterialPtr* material = std::get_if<MaterialPtr>(&value);
      count += material ? (*material)->maps().size() : 1;
    }
  return count;
}

std::vector<ShownMaterial> first_of(std::vector<ShownMaterial> all) {
  if (all.size() > most_materials) all.resize(most_materials);
  return all;
}

ShownMaterials first_of(ShownMaterials all) {
  return {first_of(std::move(all.results)), first_of(std::move(all.exemplars))};
}

/// Only surfaces can be lit: materials with colour or shape.
bool can_be_lit(const Material& material) {
  return material.find(Semantic::base_color) || material.find(Semantic::normal) || material.find(Semantic::height);
}

/// Names of maps of all materials, each once.
std::vector<std::string> map_names(const ShownMaterials& materials) {
  std::vector<std::string> out;
  for (const auto* list : {&materials.results, &materials.exemplars})
    for (const ShownMaterial& m : *list)
      for (const Map& map : m.material->maps())
        if (std::ranges::find(out, map.name) == out.end()) out.push_back(map.name);
  return out;
}

}  // namespace

RunPage::RunPage(const Plan& plan, const RunResult& result)
    : plan_(plan), result_(result), materials_(first_of(materials_of(*plan.graph, result))) {
  side_ = side_for(image_count(result), material_side);
  add_materials(materials_.results, "result");
  add_materials(materials_.exemplars, "exemplar");
  add_values();
}

std::string RunPage::html() {
  std::string out = head() + warnings();
  out += section("lit", "The material, lit", lit_view());
  out += section("maps", materials_.exemplars.empty() ? "Result" : "Exemplar and result", comparison());
  out += section("graph", "Graph", graph_drawing());
  out += section("settings", "How it was run", settings());
  out += section("figures", "Figures", figures());
  out += section("uv", "Where pixels are from", uv_maps());
  out += section("pictures", "Other pictures", other_pictures());
  out += section("times", "Times", times_html(result_));
  out += section("stages", "Nodes", stage_table(plan_, result_));
  out += section("files", "Files", files());
  out += section("notes", "Notes", list_html(notes_html(result_, false), "note"));
  return out + page_foot(run_as_json(plan_, result_, by_node_, lit_), !lit_.empty());
}

std::string RunPage::head() const {
  const Graph& graph = *plan_.graph;
  const std::string title = graph.summary.empty() ? graph.file.filename().string() : graph.summary;
  std::string state = result_.ok() ? "" : result_.cancelled ? "Cancelled: " : "Failed: ";
  return page_head(title, fmt::format("<p class=\"{}\">{}{}<br><span class=\"quiet\">{}, terrazzo {}</span></p>\n",
                                      result_.ok() ? "" : "failed", state, markup(result_.summary()),
                                      markup(graph.file.string()), TERRAZZO_VERSION));
}

std::string RunPage::warnings() {
  std::string out;
  for (const Failure& f : result_.failures) out += fmt::format("<p class=\"failed\">{}</p>\n", markup(f.message));
  out += list_html(notes_html(result_, true), "warning");
  for (const TornPicture& torn : torn_pictures(*plan_.graph, result_, materials_.results, CurrentTask::task()))
    out += pictures_.figure(pictures_.add(torn.picture, std::min(side_, other_side)),
                            torn.node + ": elements that are torn or melted together are bright");
  if (left_out_ > 0)
    out += fmt::format(
        "<p class=\"quiet\">This page shows the results of the first nodes; those of {} are left out.</p>\n",
        counted(left_out_, "more node"));
  return out;
}

NamedPicture RunPage::add_picture(const std::string& node, const std::string& caption, const ImagePtr& image,
                                  int longest) {
  NamedPicture picture{pictures_.add(image, longest), caption};
  std::vector<NamedPicture>& all = by_node_[node];
  if (std::ranges::find(all, picture.id, &NamedPicture::id) == all.end()) all.push_back(picture);
  return picture;
}

void RunPage::add_materials(const std::vector<ShownMaterial>& materials, const std::string& kind) {
  for (const ShownMaterial& shown : materials) {
    LitMaterial lit{shown.node == kind ? kind : fmt::format("{} ({})", shown.node, kind), shown.material, {}};
    for (const Map& m : shown.material->maps()) {
      const NamedPicture picture = add_picture(shown.node, m.name, m.image, side_);
      lit.maps.try_emplace(std::string(name_of(m.image->info().semantic)), picture.id);
    }
    if (can_be_lit(*shown.material)) lit_.push_back(std::move(lit));
  }
}

/// Other kept values, in the graph's order; for a sweep only the first.
void RunPage::add_values() {
  for (const StageOutcome& s : result_.stages) {
    const auto kept = result_.kept.find(s.node);
    if (kept == result_.kept.end() || by_node_.contains(s.node)) continue;
    if (by_node_.size() >= most_nodes) {
      left_out_++;
      continue;
    }
    for (const auto& [port, value] : kept->second)
      add_value(s.node, kept->second.size() > 1 ? s.node + "." + port : s.node, value);
  }
}

void RunPage::add_value(const std::string& node, const std::string& caption, const Value& value) {
  const int side = std::min(side_, other_side);
  if (const ImagePtr* image = std::get_if<ImagePtr>(&value)) {
    others_.push_back(add_picture(node, caption, *image, side));
  } else if (const MaterialPtr* material = std::get_if<MaterialPtr>(&value)) {
    for (const Map& m : (*material)->maps())
      others_.push_back(add_picture(node, caption + ": " + m.name, m.image, side));
  } else if (const UvMapPtr* uv = std::get_if<UvMapPtr>(&value)) {
    uv_maps_.push_back(add_picture(node, caption, uv_in_colours(**uv, side), side));
  } else if (const ReportPtr* report = std::get_if<ReportPtr>(&value)) {
    reports_.emplace_back(node, *report);
    for (const Report::Picture& p : (*report)->pictures()) add_picture(node, p.name, p.image, report_side);
  }
}

/// The placeholder of the viewer: a picture until its script has run.
std::string RunPage::lit_view() const {
  if (lit_.empty()) return "";
  std::vector<Map> maps;
  for (const auto& [meaning, id] : lit_.front().maps) maps.push_back({meaning, pictures_[id].shrunk});
  const MaterialPtr material = Material::make("still", std::move(maps));
  PreviewSpec spec;
  const Size shape = material->size();
  spec.size = completed(shape.width < shape.height ? Size{0, 512} : Size{512, 0}, spec.shape, shape);
  const ImagePtr still = render_preview(*material, spec, CurrentTask::task());
  return fmt::format(
      "<div id=\"viewer\"><img class=\"still\" src=\"{}\" alt=\"the material lit from the upper left\" width=\"{}\" "
      "height=\"{}\"></div>\n<p class=\"quiet\" id=\"viewer-state\">A still picture: moving the light needs "
      "JavaScript "
      "and WebGL.</p>\n",
      page_picture(still, 512).uri, spec.size.width, spec.size.height);
}

std::string RunPage::map_picture(const ShownMaterial& shown, const std::string& map) {
  const ImagePtr image = shown.material->find(std::string_view(map));
  return image ? pictures_.figure(pictures_.add(image, side_), shown.node) : "";
}

/// Compares the first result with the first exemplar.
std::string RunPage::histogram(const std::string& map) const {
  const auto of = [&](const std::vector<ShownMaterial>& list) -> const Histogram* {
    if (list.empty() || !list.front().material->find(std::string_view(map))) return nullptr;
    for (const NamedPicture& p : by_node_.at(list.front().node))
      if (p.caption == map) return &pictures_[p.id].histogram;
    return nullptr;
  };
  const Histogram *exemplar = of(materials_.exemplars), *result = of(materials_.results);
  return result ? histogram_svg(exemplar, *result) : "";
}

std::string RunPage::comparison() {
  if (materials_.results.empty() && materials_.exemplars.empty()) return "";
  std::string out;
  for (const std::string& map : map_names(materials_)) {
    out += fmt::format("<h3>{}</h3>\n<div class=\"gallery\">\n", markup(map));
    for (const auto* list : {&materials_.exemplars, &materials_.results})
      for (const ShownMaterial& m : *list) out += map_picture(m, map);
    if (const std::string chart = histogram(map); !chart.empty())
      out += fmt::format("<figure class=\"chart\">{}<figcaption>values, dark to bright{}</figcaption></figure>\n",
                         chart, materials_.exemplars.empty() ? "" : "; filled: exemplar, line: result");
    out += "</div>\n";
  }
  return out;
}

std::string RunPage::graph_drawing() const {
  std::vector<NodeMark> marks;
  for (size_t i = 0; i < plan_.stages.size(); i++) {
    const StageOutcome& s = result_.stages[i];
    NodeMark mark{std::string(what_it_did(plan_.stages[i], s)), "", ""};
    mark.line = s.kind == StageOutcome::Kind::run ? fmt::format("{}, {:.2f} s", mark.state, s.seconds) : mark.state;
    if (const auto at = by_node_.find(s.node); at != by_node_.end())
      mark.picture = pictures_[at->second.front().id].small;
    marks.push_back(std::move(mark));
  }
  return fmt::format(
      "<div id=\"drawing\">{}</div>\n<div id=\"node\"></div>\n"
      "<p class=\"quiet legend\"><b style=\"background:{}\"></b> run <b style=\"background:{}\"></b> cached or up to "
      "date "
      "<b style=\"background:{}\"></b> failed <b style=\"background:{}\"></b> not needed</p>\n",
      draw_svg(*plan_.graph, marks), state_colour("run"), state_colour("cached"), state_colour("failed"),
      state_colour(""));
}

std::string RunPage::settings() const {
  std::string out, seeds;
  for (const GraphSetting& s : plan_.graph->settings)
    out += fmt::format("<tr><td>{}</td><td{}>{}</td><td class=\"quiet\">{}</td></tr>\n", markup(s.name),
                       s.given ? " class=\"given\"" : "", markup(text_of(s.value)), markup(s.help));
  if (!out.empty())
    out =
        "<p class=\"quiet\">The graph's parameters; those that were set are bold.</p>\n<div "
        "class=\"scroll\"><table>\n" +
        out + "</table></div>\n";
  for (const GraphNode& n : plan_.graph->nodes)
    if (const auto seed = n.params.find("seed"); seed != n.params.end())
      seeds += fmt::format("<tr><td>{}</td><td class=\"number\">{}</td></tr>\n", markup(n.name),
                           markup(text_of(seed->second)));
  if (!seeds.empty())
    out +=
        fmt::format("<h3>Seeds</h3>\n<div class=\"long\"><table class=\"narrow searched\">\n{}</table></div>\n", seeds);
  return out;
}

std::string RunPage::figures() {
  std::string out;
  for (const auto& [node, report] : reports_)
    out += fold(fmt::format("<b>{}</b> <span class=\"quiet\">{}</span>", markup(report->title()), markup(node)),
                report_html(*report, pictures_, report_side), out.empty());
  return out;
}

std::string RunPage::uv_maps() {
  if (uv_maps_.empty()) return "";
  std::string out =
      "<p class=\"quiet\">Of each pixel, the place in the exemplar that it shows: more red is further right, more "
      "green "
      "further down. Areas without an edge were copied in one piece.</p>\n<div class=\"gallery\">\n";
  for (const NamedPicture& p : uv_maps_) out += pictures_.figure(p.id, p.caption);
  return out + "</div>\n";
}

std::string RunPage::other_pictures() {
  constexpr int64_t most_open = 24;
  std::string out;
  int64_t count = 0;
  for (const NamedPicture& p : others_) {
    if (pictures_.is_shown(p.id)) continue;
    out += pictures_.figure(p.id, p.caption);
    count++;
  }
  if (out.empty()) return "";
  out = "<div class=\"gallery searched\">\n" + out + "</div>\n";
  return count > most_open ? fold(counted(count, "picture"), out, false) : out;
}

std::string RunPage::files() const {
  std::vector<std::string> items;
  for (const StageOutcome& s : result_.stages)
    for (const OutputFile& f : s.files) items.push_back(markup(f.path.string()));
  return list_html(items, "file");
}

}  // namespace terrazzo
