#pragma once

#include <map>
#include <string>
#include <vector>

#include "runner/engine/schedule.h"
#include "runner/report/pictures.h"
#include "runner/report/run_data.h"
#include "runner/report/shown_nodes.h"

namespace terrazzo {

/// The page of a run, section by section. Plan and result must outlive it.
class RunPage {
 public:
  RunPage(const Plan& plan, const RunResult& result);
  std::string html();

 private:
  std::string head() const;
  std::string warnings();
  std::string lit_view() const;
  std::string comparison();
  std::string graph_drawing() const;
  std::string settings() const;
  std::string figures();
  std::string uv_maps();
  std::string other_pictures();
  std::string files() const;

  void add_materials(const std::vector<ShownMaterial>& materials, const std::string& kind);
  void add_values();
  void add_value(const std::string& node, const std::string& caption, const Value& value);
  NamedPicture add_picture(const std::string& node, const std::string& caption, const ImagePtr& image, int longest);
  std::string map_picture(const ShownMaterial& shown, const std::string& map);
  std::string histogram(const std::string& map) const;

  const Plan& plan_;
  const RunResult& result_;
  const ShownMaterials materials_;
  PagePictures pictures_;
  int left_out_ = 0;  ///< nodes whose values the page does not show
  int side_ = 0;      ///< of pictures of exemplars and results
  std::map<std::string, std::vector<NamedPicture>> by_node_;
  std::vector<LitMaterial> lit_;
  std::vector<std::pair<std::string, ReportPtr>> reports_;
  std::vector<NamedPicture> uv_maps_, others_;
};

}  // namespace terrazzo
