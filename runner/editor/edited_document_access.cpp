#include "runner/editor/edited_document_access.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "runner/editor/state.h"
#include "runner/editor/types_json.h"

namespace terrazzo {

namespace {

using Json = nlohmann::ordered_json;

Json answer_of(const EditAnswer& answer) {
  Json out = {{"revision", answer.revision}};
  if (!answer.names.empty()) out["names"] = answer.names;
  if (!answer.taken.empty()) out["taken"] = answer.taken;
  return out;
}

}  // namespace

Json EditedDocumentAccess::state(const RunFindings& findings) const {
  return state_json(document_.snapshot(), {.errors = findings.errors, .warnings = findings.warnings, .notes = {}});
}

Json EditedDocumentAccess::edit(const Json& request) {
  return answer_of(document_.edit(request));
}

Json EditedDocumentAccess::undo() {
  return answer_of(document_.undo());
}

Json EditedDocumentAccess::redo() {
  return answer_of(document_.redo());
}

Json EditedDocumentAccess::format() {
  return answer_of(document_.format());
}

Json EditedDocumentAccess::resolve(const Json& request) {
  const std::string keep = request.value("keep", "");
  if (keep != "mine" && keep != "disk") throw Error("expected \"mine\" or \"disk\" as \"keep\"");
  return answer_of(document_.resolve(keep == "mine"));
}

Json EditedDocumentAccess::copy(const Json& request) const {
  return {{"text", document_.copy(request.value("level", ""), request.at("nodes").get<std::vector<std::string>>())}};
}

Json EditedDocumentAccess::diff() const {
  return changed_since_commit(document_.snapshot());
}

Json EditedDocumentAccess::preset(const Json& request) const {
  const std::string level = request.value("level", "");
  if (!level.empty()) throw Error(fmt::format("presets of \"{}\" are set where it is used", level));
  return preset_json(document_.snapshot(), request.at("name").get<std::string>());
}

Json EditedDocumentAccess::types() const {
  return types_json();
}

}  // namespace terrazzo
