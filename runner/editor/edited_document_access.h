#pragma once

#include "runner/editor/document.h"
#include "runner/editor/document_access.h"

namespace terrazzo {

/// The requests of the protocol, on an EditedDocument.
class EditedDocumentAccess final : public DocumentAccess {
 public:
  /// Throws as EditedDocument.
  EditedDocumentAccess(const std::filesystem::path& file, bool read_only) : document_(file, read_only) {}

  int64_t revision() const override { return document_.revision(); }
  std::string text() const override { return document_.snapshot().text; }
  std::filesystem::path file() const override { return document_.snapshot().file; }
  bool is_read_only() const override { return document_.snapshot().read_only; }
  Json state(const RunFindings& findings) const override;

  Json edit(const Json& request) override;
  Json undo() override;
  Json redo() override;
  Json format() override;
  Json resolve(const Json& request) override;
  Json copy(const Json& request) const override;
  Json diff() const override;
  Json preset(const Json& request) const override;
  Json types() const override;
  bool look_at_disk() override { return document_.look_at_disk(); }

 private:
  EditedDocument document_;
};

}  // namespace terrazzo
